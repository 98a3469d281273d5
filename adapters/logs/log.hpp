// SPDX-License-Identifier: Apache-2.0
// Recorded runs, whatever format they were recorded in.
#pragma once

#include <filesystem>

#include "core/recording.hpp"

namespace kidnapwatch::adapters::logs {

/// Reads a recorded run; the format is told by its content, gzipped or not: the common `.scan`
/// text, or CARMEN (FLASER, ROBOTLASER1, ODOM). Broken lines are skipped and counted. Throws
/// BadInput, naming the file and line, for a file that is no such log or holds no usable scan.
struct Log {
  core::Recording recording;
  std::size_t skipped_lines = 0;
};
[[nodiscard]] Log read_log(const std::filesystem::path& file);

}  // namespace kidnapwatch::adapters::logs
