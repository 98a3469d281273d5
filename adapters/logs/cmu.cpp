// SPDX-License-Identifier: Apache-2.0
// Reads the logs of CMU's robotics courses.
#include "adapters/logs/cmu.hpp"

#include <numbers>

#include "adapters/logs/stamps.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

constexpr std::size_t kBeams = 180;
constexpr double kMetres = 0.01;  // per centimetre
constexpr core::ScanGeometry kSick{-0.5 * std::numbers::pi, std::numbers::pi / kBeams, 0.0, 80.0};

core::Pose pose(Words& words, std::string_view field) {
  const double x_m = kMetres * words.finite(field);
  const double y_m = kMetres * words.finite(field);
  return {x_m, y_m, words.finite(field)};
}

struct TimedScan {
  core::Scan scan;
  double time_s = 0.0;
};

TimedScan laser_line(Words& words) {
  core::Scan scan{{}, kSick, {}, pose(words, "pose")};
  static_cast<void>(pose(words, "laser pose"));
  for (const float range_cm : words.ranges(kBeams)) {
    scan.ranges_m.push_back(static_cast<float>(kMetres * static_cast<double>(range_cm)));
  }
  const double time_s = words.finite("t");
  words.expect_end();
  return {std::move(scan), time_s};
}

}  // namespace

bool is_cmu(std::string_view head) {
  try {
    Words words(head.substr(0, head.find('\n')));
    const std::string_view kind = words.word("kind");
    if (kind != "L" && kind != "O") return false;
    static_cast<void>(pose(words, "pose"));
    static_cast<void>(words.finite("t"));
    return true;
  } catch (const core::BadInput&) {
    return false;
  }
}

Log read_cmu(Lines& lines) {
  Log log;
  std::vector<double> times_s;
  read_lines(lines, log, [&](std::string_view line) {
    Words words(line);
    const std::string_view kind = words.word("kind");
    if (kind == "O") return;
    if (kind != "L") throw core::BadInput("kind", "neither L nor O");
    TimedScan timed = laser_line(words);
    core::check(timed.scan);
    log.recording.scans.push_back({std::move(timed.scan), std::nullopt});
    times_s.push_back(timed.time_s);
  });
  set_stamps(log.recording, times_s, lines.where());
  return log;
}

}  // namespace kidnapwatch::adapters::logs
