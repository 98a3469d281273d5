// SPDX-License-Identifier: Apache-2.0
// What `evaluate logs` found, as JSON, as text and as a page.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/evaluation/summary.hpp"

namespace kidnapwatch::service {

/// One log as it was read, and how its scans were spent.
struct JudgedLog {
  std::string file;
  std::string folder;  ///< stands for the sensor in leave-one-out
  std::size_t scans = 0;
  std::size_t skipped_lines = 0;
  bool has_odometry = false;
  double fleet_threshold = 0.0;
  std::string tuning;  ///< of motion consistency: a candidate's name
  std::string error;   ///< why it was not judged
  core::evaluation::LogTrial trial;
};

struct LogsReport {
  double target_rate = 0.0;
  bool leave_one_out = false;
  std::vector<JudgedLog> logs;
  std::vector<core::evaluation::Row> rows;
};

/// How the logs were spent, in a sentence or two.
[[nodiscard]] std::string protocol(const LogsReport& report);
[[nodiscard]] std::string to_json(const LogsReport& report);
[[nodiscard]] std::string to_text(const LogsReport& report);
[[nodiscard]] std::string to_html(const LogsReport& report);

}  // namespace kidnapwatch::service
