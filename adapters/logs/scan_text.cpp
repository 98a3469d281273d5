// SPDX-License-Identifier: Apache-2.0
// Reads the common `.scan` text.
#include "adapters/logs/scan_text.hpp"

#include <cmath>
#include <optional>

#include "adapters/logs/stamps.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

struct Header {
  std::string name;
  core::ScanGeometry geometry;
  std::size_t beams = 0;
};

/// Throws BadInput unless all six words are there and describe a lidar.
Header header(std::string_view line) {
  Words words(line);
  if (words.word("header") != "#") throw core::BadInput("header", "does not start with #");
  Header header;
  header.name = words.word("name");
  header.geometry.angle_min_rad = words.number("angle_min");
  header.geometry.angle_increment_rad = words.number("angle_increment");
  header.beams = words.beam_count("beams");
  header.geometry.range_max_m = words.number("range_max");
  words.expect_end();
  return header;
}

std::optional<core::Pose> finite_pose(Words& words, std::string_view field) {
  const core::Pose pose = words.pose(field);
  const bool finite =
      std::isfinite(pose.x_m) && std::isfinite(pose.y_m) && std::isfinite(pose.theta_rad);
  return finite ? std::optional(pose) : std::nullopt;
}

}  // namespace

bool is_scan_text(std::string_view head) {
  try {
    static_cast<void>(header(head.substr(0, head.find_first_of("\r\n"))));
    return true;
  } catch (const core::BadInput&) {
    return false;
  }
}

Log read_scan_text(Lines& lines) {
  Log log;
  static_cast<void>(lines.next());
  const Header head = header(lines.text());
  log.recording.name = head.name;
  std::vector<double> times_s;
  read_lines(lines, log, [&](std::string_view line) {
    Words words(line);
    const double time_s = words.finite("t");
    core::RecordedScan recorded;
    recorded.scan.geometry = head.geometry;
    recorded.scan.odometry = finite_pose(words, "odometry");
    recorded.true_pose = finite_pose(words, "true pose");
    recorded.scan.ranges_m = words.ranges(head.beams);
    words.expect_end();
    core::check(recorded.scan);
    times_s.push_back(time_s);
    log.recording.scans.push_back(std::move(recorded));
  });
  set_stamps(log.recording, times_s, lines.where());
  return log;
}

}  // namespace kidnapwatch::adapters::logs
