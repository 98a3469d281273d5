// SPDX-License-Identifier: Apache-2.0
// Any bytes as a map; what follows a first 0 byte is the image beside it, which it names map.pgm.
#include <algorithm>

#include "adapters/logs/grid_map.hpp"
#include "core/bad_input.hpp"
#include "tests/fuzz/input.hpp"

using namespace kidnapwatch;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::string_view kImage = "map.pgm";
  const std::string bytes = test::text_of(data, size);
  const std::size_t end = std::min(bytes.find('\0'), bytes.size());
  const auto image = test::file_with(bytes.substr(std::min(end + 1, bytes.size())), ".pgm");
  std::string text = bytes.substr(0, end);
  if (const std::size_t at = text.find(kImage); at != std::string::npos)
    text.replace(at, kImage.size(), image.filename().string());
  const auto map = test::file_with(text, ".yaml");
  try {
    (void)adapters::logs::read_grid_map(map);
  } catch (const core::BadInput&) {
  }
  std::filesystem::remove(image);
  std::filesystem::remove(map);
  return 0;
}
