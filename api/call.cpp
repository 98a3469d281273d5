// SPDX-License-Identifier: Apache-2.0
// Query parameters that several routes take, and what their answers share.
#include "api/call.hpp"

#include <charconv>

#include "adapters/codecs/rfc3339.hpp"
#include "api/problem.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::api {

Response no_such_robot(const Call& call) { return problem(404, "no robot is named " + call.id); }

std::optional<std::string> parameter(const Call& call, const std::string& name) {
  const auto found = call.target.query.find(name);
  return found == call.target.query.end() ? std::nullopt : std::optional(found->second);
}

std::size_t page_limit(const Call& call, std::size_t otherwise) {
  const auto text = parameter(call, "limit");
  if (!text) {
    return otherwise;
  }
  std::size_t limit = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), limit);
  if (error != std::errc() || end != text->data() + text->size() || limit < 1 || limit > kMaxPage) {
    throw core::BadInput("limit", "must be an integer from 1 to " + std::to_string(kMaxPage));
  }
  return limit;
}

TimeRange time_range(const Call& call) {
  TimeRange range;
  if (const auto from = parameter(call, "from")) {
    range.from = adapters::codecs::stamp_from_rfc3339(*from, "from");
  }
  if (const auto to = parameter(call, "to")) {
    range.to = adapters::codecs::stamp_from_rfc3339(*to, "to");
  }
  if (range.to < range.from) {
    throw core::BadInput("to", "must not be before from");
  }
  return range;
}

std::string link_with(const Call& call, const std::string& parameter, const std::string& value) {
  auto query = call.target.query;
  query[parameter] = value;
  std::string link;
  for (const auto& segment : call.target.segments) {
    link += "/" + percent_encoded(segment);
  }
  char separator = '?';
  for (const auto& [name, text] : query) {
    link += separator + name + "=" + percent_encoded(text);
    separator = '&';
  }
  return link;
}

Response ok_text(std::string json) { return {200, "application/json", std::move(json)}; }

Response ok(const adapters::codecs::Json& body) { return ok_text(adapters::codecs::text(body)); }

void link_next(Response& response, const std::string& link) {
  response.headers.push_back({"Link", "<" + link + ">; rel=\"next\""});
}

}  // namespace kidnapwatch::api
