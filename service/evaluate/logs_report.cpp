// SPDX-License-Identifier: Apache-2.0
// Rows written down, as JSON and as text.
#include "service/evaluate/logs_report.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "adapters/codecs/json.hpp"

namespace kidnapwatch::service {
namespace {

namespace evaluation = core::evaluation;
using adapters::codecs::Json;

Json json(const evaluation::Rate& rate) {
  return {{"hits", rate.hits},
          {"trials", rate.trials},
          {"rate", rate.value()},
          {"low", rate.low()},
          {"high", rate.high()}};
}

Json json(const evaluation::OperatingPoint& point) {
  return {{"fpr", point.fpr},
          {"threshold", point.threshold},
          {"naturalAbove", json(point.natural)},
          {"tpr", json(point.found)}};
}

Json json(const evaluation::Row& row) {
  Json object{{"detector", name(row.detector)},
              {"family", name(row.family)},
              {"kind", row.kind},
              {"log", row.log},
              {"alarms", json(row.alarms)}};
  adapters::codecs::set(object, "threshold", row.threshold);
  if (row.roc)
    object["auc"] = {
        {"value", row.roc->auc}, {"low", row.roc->auc_low}, {"high", row.roc->auc_high}};
  if (!row.points.empty()) object["tprAtFpr"] = Json::array();
  for (const auto& point : row.points) object["tprAtFpr"].push_back(json(point));
  if (!row.causes.empty()) object["causes"] = row.causes;
  return object;
}

Json json(const JudgedLog& log) {
  Json object{{"log", log.trial.log},
              {"file", log.file},
              {"folder", log.folder},
              {"scans", log.scans},
              {"skippedLines", log.skipped_lines},
              {"hasOdometry", log.has_odometry},
              {"tuning", log.tuning},
              {"fleetThreshold", log.fleet_threshold}};
  if (!log.error.empty()) object["error"] = log.error;
  for (const auto& [detector, result] : log.trial.results) {
    Json& spent = object["detectors"][std::string(name(detector))];
    spent = Json{{"pairs", result.natural.size()}, {"notComparable", result.skipped}};
    adapters::codecs::set(spent, "threshold", result.threshold);
    if (!result.troubles.empty()) spent["degraded"] = result.troubles;
  }
  return object;
}

std::string formatted(const char* format, auto... values) {
  char line[400];
  const int length = std::snprintf(line, sizeof line, format, values...);
  return {line, static_cast<std::size_t>(std::max(0, length))};
}

std::string text(const evaluation::Row& row) {
  std::string line =
      formatted("%-20s %5zu/%-6zu %.4f [%.4f, %.4f]", row.kind.c_str(), row.alarms.hits,
                row.alarms.trials, row.alarms.value(), row.alarms.low(), row.alarms.high());
  if (row.roc) line += formatted("  AUC %.3f  TPR", row.roc->auc);
  for (const auto& point : row.points) line += formatted(" %.3f", point.found.value());
  return line + "\n";
}

std::string natural_text(const LogsReport& report, core::evaluation::DetectorKind detector) {
  std::string lines;
  for (const auto& row : report.rows) {
    if (row.detector != detector || row.kind != "natural" || row.log == "pooled") continue;
    lines += formatted("  %-44s %4zu/%-5zu %.4f threshold %.2f\n", row.log.c_str(), row.alarms.hits,
                       row.alarms.trials, row.alarms.value(), row.threshold.value_or(0.0));
  }
  return lines;
}

/// What was chosen for each folder, once.
std::string choices_text(const LogsReport& report) {
  if (!report.leave_one_out) return {};
  std::string lines = "\nChosen for each folder on all others\n";
  std::string last;
  for (const auto& log : report.logs) {
    if (std::exchange(last, log.folder) == log.folder) continue;
    lines += formatted("  %-26s %-22s fleet's threshold %.2f\n", log.folder.c_str(),
                       log.tuning.c_str(), log.fleet_threshold);
  }
  return lines;
}

}  // namespace

std::string protocol(const LogsReport& report) {
  std::string text =
      "The first half of each log calibrates, the second is judged. Alarms are at the robot's own "
      "threshold, or its fleet's where that is higher; intervals are Wilson's at 95 %.";
  if (report.leave_one_out)
    text +=
        " The tuning of motion consistency and the fleet's threshold were chosen for each folder "
        "on the logs of all others.";
  return text;
}

std::string to_json(const LogsReport& report) {
  Json object{{"targetFalseAlarmRate", report.target_rate},
              {"leaveOneFolderOut", report.leave_one_out},
              {"protocol", protocol(report)},
              {"logs", Json::array()},
              {"results", Json::array()}};
  for (const auto& log : report.logs) object["logs"].push_back(json(log));
  for (const auto& row : report.rows) object["results"].push_back(json(row));
  return adapters::codecs::text(object) + "\n";
}

std::string to_text(const LogsReport& report) {
  std::string lines;
  for (const auto detector : evaluation::kDetectors) {
    bool first = true;
    for (const auto& row : report.rows) {
      if (row.detector != detector || row.log != "pooled") continue;
      if (std::exchange(first, false)) {
        lines += "\n" + std::string(name(detector)) +
                 ": alarms at the robot's own threshold; TPR at FPR .01 .002 .001\n";
      }
      lines += text(row);
    }
    lines += natural_text(report, detector);
  }
  return lines + choices_text(report);
}

}  // namespace kidnapwatch::service
