// SPDX-License-Identifier: Apache-2.0
// Reads CARMEN log files.
#include "adapters/logs/carmen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "adapters/logs/stamps.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

constexpr double kSickReach = 80.0;    // m
constexpr double kCarmenReach = 50.0;  // m

/// What a log tells that only makes sense at its end.
struct Run {
  std::vector<core::RecordedScan> scans;
  std::vector<double> times_s;
  std::vector<std::optional<core::Pose>> odom_before;  ///< per scan: of the last ODOM before it
  std::optional<core::Pose> odom;                      ///< of the last ODOM
  std::string scan_message;                            ///< the one that counts
  bool corrected_by_gmapping = false;
};

core::Pose finite_pose(Words& words, std::string_view field) {
  const double x_m = words.finite(field);
  const double y_m = words.finite(field);
  return {x_m, y_m, words.finite(field)};
}

void add(Run& run, core::Scan scan, double time_s) {
  core::check(scan);
  run.scans.push_back({std::move(scan), std::nullopt});
  run.times_s.push_back(time_s);
  run.odom_before.push_back(run.odom);
}

/// The end of every message: ipc_timestamp hostname logger_timestamp.
double time_s(Words& words) {
  const double ipc_s = words.finite("ipc_timestamp");
  words.skip(2, "logger_timestamp");
  words.expect_end();
  return ipc_s;
}

/// ODOM x y theta tv rv accel + time
void read_odom(Words& words, Run& run) { run.odom = finite_pose(words, "pose"); }

core::ScanGeometry front_laser(std::size_t beams) {
  const double steps = static_cast<double>(beams % 2 == 1 && beams > 1 ? beams - 1 : beams);
  return {-0.5 * std::numbers::pi, std::numbers::pi / steps, 0.0, kSickReach};
}

/// FLASER n r1..rn laser_pose robot_pose + time
void read_flaser(Words& words, Run& run) {
  core::Scan scan;
  const std::size_t beams = words.beam_count("num_readings");
  scan.geometry = front_laser(beams);
  scan.ranges_m = words.ranges(beams);
  static_cast<void>(finite_pose(words, "laser_pose"));
  scan.odometry = finite_pose(words, "robot_pose");
  const double at_s = time_s(words);
  add(run, std::move(scan), at_s);
}

/// ROBOTLASER1 type start_angle fov resolution range_max accuracy remission_mode n r1..rn
/// m remission1..m laser_pose robot_pose tv rv forward_safety side_safety turn_axis + time
void read_robotlaser(Words& words, Run& run) {
  core::Scan scan;
  words.skip(1, "laser_type");
  scan.geometry.angle_min_rad = words.number("start_angle");
  words.skip(1, "field_of_view");
  scan.geometry.angle_increment_rad = words.number("angular_resolution");
  scan.geometry.range_max_m = words.number("maximum_range");
  words.skip(2, "remission_mode");
  scan.ranges_m = words.ranges(words.beam_count("num_readings"));
  const double remissions = words.finite("num_remissions");
  if (remissions < 0.0 || remissions > core::kMaxBeams) {
    throw core::BadInput("num_remissions", "not 0 to 65536");
  }
  words.skip(static_cast<std::size_t>(remissions), "remissions");
  static_cast<void>(finite_pose(words, "laser_pose"));
  scan.odometry = finite_pose(words, "robot_pose");
  words.skip(5, "turn_axis");
  const double at_s = time_s(words);
  add(run, std::move(scan), at_s);
}

/// Whether the word can be the name of a message: upper case, or a comment.
bool is_message(std::string_view word) {
  return word.starts_with('#') || std::ranges::all_of(word, [](char c) {
           return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
         });
}

void read_message(std::string_view line, Run& run) {
  if (line.find_first_not_of(" \t") == std::string_view::npos) return;
  Words words(line);
  const std::string_view message = words.word("message");
  if (message == "ODOM") return read_odom(words, run);
  if (message == "FLASER" || message == "ROBOTLASER1") {
    if (run.scan_message.empty()) run.scan_message = message;
    if (run.scan_message != message) return;
    return message == "FLASER" ? read_flaser(words, run) : read_robotlaser(words, run);
  }
  if (message == "NEFF") run.corrected_by_gmapping = true;
  if (!is_message(message)) throw core::BadInput("message", "not a name");
}

/// Takes the corrected poses for true, and chains odometry from the motions between scans: from a
/// corrected pose to the last ODOM before the next scan.
void undo_correction(Run& run) {
  core::Pose T_odom_base;
  for (std::size_t i = 0; i < run.scans.size(); ++i) {
    core::RecordedScan& recorded = run.scans[i];
    recorded.true_pose = recorded.scan.odometry;
    const core::Pose& corrected = *recorded.true_pose;
    T_odom_base = i == 0 ? corrected
                         : T_odom_base * inverse(*run.scans[i - 1].true_pose) *
                               run.odom_before[i].value_or(*run.scans[i - 1].true_pose);
    recorded.scan.odometry = T_odom_base;
  }
}

/// Lowers range_max where the longest range is CARMEN's own code for "no return".
void tell_reach(Run& run) {
  float longest_m = 0.0F;
  for (const core::RecordedScan& recorded : run.scans) {
    for (const float range_m : recorded.scan.ranges_m) longest_m = std::max(longest_m, range_m);
  }
  if (longest_m < kCarmenReach || longest_m > kSickReach) return;
  for (core::RecordedScan& recorded : run.scans) recorded.scan.geometry.range_max_m = kCarmenReach;
}

}  // namespace

bool is_carmen(std::string_view head) {
  constexpr std::array<std::string_view, 6> kBeginnings{
      "FLASER ", "ROBOTLASER1 ", "ODOM ", "PARAM ", "SYNC ", "# message formats defined"};
  while (!head.empty()) {
    const auto begins = [&](std::string_view beginning) { return head.starts_with(beginning); };
    if (std::ranges::any_of(kBeginnings, begins)) return true;
    head.remove_prefix(std::min(head.find('\n'), head.size() - 1) + 1);
  }
  return false;
}

Log read_carmen(Lines& lines) {
  Log log;
  Run run;
  read_lines(lines, log, [&](std::string_view line) { read_message(line, run); });
  if (run.corrected_by_gmapping) undo_correction(run);
  if (run.scan_message == "FLASER") tell_reach(run);
  log.recording.scans = std::move(run.scans);
  set_stamps(log.recording, run.times_s, lines.where());
  return log;
}

}  // namespace kidnapwatch::adapters::logs
