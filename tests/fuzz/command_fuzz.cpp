// SPDX-License-Identifier: Apache-2.0
// Any bytes as a command by MQTT: it is one that passes core::check, or BadInput.
#include "adapters/codecs/command_json.hpp"
#include "core/bad_input.hpp"
#include "tests/fuzz/input.hpp"

using namespace kidnapwatch;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto command = adapters::codecs::robot_command(test::text_of(data, size), "r1");
    if (command.change) {
      core::check(*command.change);
    }
  } catch (const core::BadInput&) {
  }
  return 0;
}
