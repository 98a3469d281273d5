// SPDX-License-Identifier: Apache-2.0
// Tells a log's format by its content, and reads it.
#include "adapters/logs/log.hpp"

#include <array>

#include "adapters/logs/carmen.hpp"
#include "adapters/logs/cmu.hpp"
#include "adapters/logs/lines.hpp"
#include "adapters/logs/ros1_bag.hpp"
#include "adapters/logs/scan_text.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

struct Format {
  bool (*recognises)(std::string_view head);
  Log (*read)(Lines& lines);
};

constexpr std::array<Format, 4> kFormats{{
    {is_scan_text, read_scan_text},
    {is_carmen, read_carmen},
    {is_cmu, read_cmu},
    {is_ros1_bag, read_ros1_bag},
}};

Log read(Lines& lines) {
  for (const Format& format : kFormats) {
    if (format.recognises(lines.head())) return format.read(lines);
  }
  throw core::BadInput(lines.file().string(), "no log of a known format");
}

/// "robotdata1" of "logs/robotdata1.log.gz".
std::string stem(const std::filesystem::path& file) {
  return (file.extension() == ".gz" ? file.stem() : file).stem().string();
}

}  // namespace

Log read_log(const std::filesystem::path& file) {
  Lines lines(file);
  Log log = read(lines);
  if (log.recording.scans.empty()) {
    throw core::BadInput(lines.where(), log.skipped_lines > 0
                                            ? "no usable scan; first, " + log.first_skipped
                                            : "no scan");
  }
  if (log.recording.name.empty()) log.recording.name = stem(file);
  return log;
}

}  // namespace kidnapwatch::adapters::logs
