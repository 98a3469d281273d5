// SPDX-License-Identifier: Apache-2.0
// Recorded runs, whatever format they were recorded in.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/recording.hpp"

namespace kidnapwatch::adapters::logs {

struct Log {
  core::Recording recording;      ///< every scan passed core::check, stamps strictly increase
  std::size_t skipped_lines = 0;  ///< broken lines or messages, left out
  std::string first_skipped;      ///< "file:line: field: reason" of the first of them
};

/// Reads a recorded run, gzipped or not; the format is told by the content (see README.md). Throws
/// BadInput, naming file and line, for a file that cannot be read to its end, is no such log, is
/// mostly broken or holds no usable scan.
[[nodiscard]] Log read_log(const std::filesystem::path& file);

}  // namespace kidnapwatch::adapters::logs
