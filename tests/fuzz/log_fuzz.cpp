// SPDX-License-Identifier: Apache-2.0
// Any bytes as a recorded log; its format is told by its content.
#include "adapters/logs/log.hpp"
#include "core/bad_input.hpp"
#include "tests/fuzz/input.hpp"

using namespace kidnapwatch;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = test::file_with(test::text_of(data, size), ".log");
  try {
    (void)adapters::logs::read_log(file);
  } catch (const core::BadInput&) {
  }
  std::filesystem::remove(file);
  return 0;
}
