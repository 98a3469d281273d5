// SPDX-License-Identifier: Apache-2.0
// A fuzzer's input, as the parsers take it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace kidnapwatch::test {

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {static_cast<const char*>(static_cast<const void*>(data)), size};
}

/// In a file with this suffix; the same one for each call of this process.
inline std::filesystem::path file_with(const std::string& content, const std::string& suffix) {
  static const auto kFolder = std::filesystem::temp_directory_path();
  auto file = kFolder / ("kidnapwatch-fuzz-" + std::to_string(::getpid()) + suffix);
  std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
  return file;
}

}  // namespace kidnapwatch::test

/// What libFuzzer calls: never returns but with 0, and ends the process for a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
