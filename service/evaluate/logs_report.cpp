// SPDX-License-Identifier: Apache-2.0
// Rows written down.
#include "service/evaluate/logs_report.hpp"

#include <cstdio>

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

/// A bar of a share, with its confidence interval as a whisker.
std::string bar(const evaluation::Rate& rate) {
  return formatted(
      "<svg width=200 height=12><rect width=%.1f height=12 fill=#69c /><line x1=%.1f x2=%.1f y1=6 "
      "y2=6 stroke=#333 /></svg>",
      200.0 * rate.value(), 200.0 * rate.low(), 200.0 * rate.high());
}

std::string html(const evaluation::Row& row) {
  std::string line = "<tr><td>" + row.kind + "<td>" + std::string(name(row.family)) +
                     formatted("<td>%zu<td>%zu<td>%.4f<td>", row.alarms.hits, row.alarms.trials,
                               row.alarms.value()) +
                     bar(row.alarms) + (row.roc ? formatted("<td>%.3f", row.roc->auc) : "<td>");
  for (const auto& point : row.points) line += formatted("<td>%.3f", point.found.value());
  return line;
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

}  // namespace

std::string to_json(const LogsReport& report) {
  Json object{{"targetFalseAlarmRate", report.target_rate},
              {"leaveOneFolderOut", report.leave_one_out},
              {"protocol",
               "The first half of each log calibrates, the second is judged. Alarms are at the "
               "robot's own threshold; intervals are Wilson's at 95 %."},
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
  return lines;
}

std::string to_html(const LogsReport& report) {
  std::string page =
      "<!doctype html><meta charset=utf-8><title>kidnapwatch evaluate logs</title><style>"
      "body{font:14px sans-serif;margin:2em}td,th{padding:2px 8px;text-align:right}"
      "td:first-child{text-align:left}svg{display:block}</style><h1>Recorded logs</h1><p>The first "
      "half of each log calibrates, the second is judged. Bars: share alarming at the robot's own "
      "threshold; whiskers: 95 %.</p>";
  for (const auto detector : evaluation::kDetectors) {
    page += "<h2>" + std::string(name(detector)) +
            "</h2><table><tr><th>event<th>family<th>alarms<th>of<th>share<th>0 ... 1<th>AUC"
            "<th>TPR at FPR .01<th>.002<th>.001";
    for (const auto& row : report.rows)
      if (row.detector == detector && row.log == "pooled") page += html(row);
    page += "</table>";
  }
  return page + "<h2>Logs</h2><pre>" + to_text(report) + "</pre>\n";
}

}  // namespace kidnapwatch::service
