// SPDX-License-Identifier: Apache-2.0
// Any REST request: method, target, a header and body, each up to the next line feed.
#include <cassert>

#include "tests/api/memory_ports.hpp"
#include "tests/fuzz/input.hpp"

using namespace kidnapwatch;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static api::MemoryFleet fleet;
  static api::MemoryHistory history;
  static api::LiveRobots live(fleet, [] { return 0.0; });
  static api::Guard guard(nullptr, {.per_s = 0.0}, [] { return 0.0; });  // needs no token
  const std::string text = test::text_of(data, size);
  std::string_view rest = text;
  api::Request request;
  request.method = api::take_until(rest, '\n');
  request.target = api::take_until(rest, '\n');
  for (const char* name :
       {"content-type", "accept", "if-match", "if-none-match", "last-event-id"}) {
    request.headers.push_back({name, std::string(api::take_until(rest, '\n'))});
  }
  request.body = rest;
  const auto response = api::answer({fleet, history, guard, live}, request, [](const std::string&) {
    assert(false && "a request made the service fail");
  });
  if (response.feed) (void)response.feed->next();
  assert(response.status >= 200 && response.status < 600);
  return 0;
}
