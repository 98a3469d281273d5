// SPDX-License-Identifier: Apache-2.0
// Any bytes as the service's TOML file, as its tokens, and as a configuration over REST.
#include "adapters/codecs/config_json.hpp"
#include "core/bad_input.hpp"
#include "service/settings.hpp"
#include "service/token_file.hpp"
#include "tests/fuzz/input.hpp"

using namespace kidnapwatch;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto text = test::text_of(data, size);
  const auto file = test::file_with(text, ".toml");
  try {
    (void)service::load_settings(
        {.file = file,
         .environment = [](const std::string&) { return std::optional<std::string>(); },
         .flags = {}});
  } catch (const core::BadInput&) {
  }
  try {
    (void)service::TokenFile(file).tokens();
  } catch (const core::BadInput&) {
  }
  std::filesystem::remove(file);
  try {
    core::check(adapters::codecs::detection_config(adapters::codecs::parsed(text, "body")));
  } catch (const core::BadInput&) {
  }
  return 0;
}
