// SPDX-License-Identifier: Apache-2.0
// What `evaluate logs` found, as a page to look at.
#include <algorithm>
#include <map>
#include <string_view>

#include "adapters/report/html.hpp"
#include "adapters/report/intervals.hpp"
#include "adapters/report/lines.hpp"
#include "adapters/report/svg.hpp"
#include "service/evaluate/logs_report.hpp"

namespace kidnapwatch::service {
namespace {

namespace evaluation = core::evaluation;
namespace report = adapters::report;
using evaluation::DetectorKind;
using evaluation::Family;
using report::fixed;
using report::number;

constexpr std::string_view kPooled = "pooled";
constexpr double kCurvesFrom = 1e-3;  // fewer natural pairs than this allows say nothing

const evaluation::Row* find(const LogsReport& page, DetectorKind detector, std::string_view kind,
                            std::string_view log = kPooled) {
  const auto row = std::ranges::find_if(page.rows, [&](const evaluation::Row& one) {
    return one.detector == detector && one.kind == kind && one.log == log;
  });
  return row == page.rows.end() ? nullptr : &*row;
}

std::vector<DetectorKind> detectors(const LogsReport& page) {
  std::vector<DetectorKind> found;
  for (const DetectorKind kind : evaluation::kDetectors)
    if (find(page, kind, "natural")) found.push_back(kind);
  return found;
}

/// The kinds of a family that any detector was tried on, in order of the first that was.
std::vector<std::string> kinds(const LogsReport& page, Family family) {
  std::vector<std::string> found;
  for (const auto& row : page.rows)
    if (row.family == family && row.log == kPooled && std::ranges::count(found, row.kind) == 0)
      found.push_back(row.kind);
  return found;
}

/// A kind, a detector: its name with its numbers as people write them.
std::string in_words(std::string_view name) {
  static const std::map<std::string_view, std::string> kWords{
      {"move_025m", "moved 0.25 m"},    {"move_05m", "moved 0.5 m"},
      {"move_1m", "moved 1 m"},         {"move_2m", "moved 2 m"},
      {"turn_15deg", "turned 15°"},     {"turn_30deg", "turned 30°"},
      {"turn_90deg", "turned 90°"},     {"turn_180deg", "turned 180°"},
      {"slip_way", "slip by 0.5 m"},    {"slip_turn", "slip by 30°"},
      {"gap_2", "2 scans missed"},      {"gap_5", "5 scans missed"},
      {"gap_10", "10 scans missed"},    {"person_1", "1 person"},
      {"people_3", "3 people"},         {"people_5", "5 people"},
      {"range_noise", "noise of 0.1 m"}};
  if (const auto known = kWords.find(name); known != kWords.end()) return known->second;
  std::string words(name);
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string figure_of(const LogsReport& page, Family family, std::string title, double reach) {
  report::IntervalFigure figure{
      std::move(title), "share of the episodes that alarm", reach, {}, {}};
  for (const DetectorKind detector : detectors(page))
    figure.series.push_back(in_words(name(detector)));
  for (const auto& kind : kinds(page, family)) {
    report::IntervalRow row{in_words(kind), {}};
    for (const DetectorKind detector : detectors(page)) {
      const auto* found = find(page, detector, kind);
      row.values.emplace_back();
      if (found)
        row.values.back() = {found->alarms.value(), found->alarms.low(), found->alarms.high()};
    }
    figure.rows.push_back(std::move(row));
  }
  return drawn(figure);
}

std::string curves(const LogsReport& page, DetectorKind detector) {
  report::LineFigure figure{in_words(name(detector)),
                            {"false alarms per natural pair of scans", kCurvesFrom},
                            {"share of the kidnappings found", 0.0},
                            {}};
  for (const std::string_view kind :
       {"far", "look_alike", "move_1m", "move_05m", "turn_30deg", "turn_180deg"}) {
    const auto* row = find(page, detector, kind);
    if (!row || !row->roc) continue;
    report::Line line{in_words(kind) + ", AUC " + fixed(row->roc->auc, 3), {}};
    for (const auto& point : row->roc->points) line.points.push_back({point.fpr, point.tpr});
    figure.lines.push_back(std::move(line));
  }
  return drawn(figure);
}

std::string shares(const evaluation::Rate& rate) {
  return number(static_cast<double>(rate.hits), 0) + " of " +
         number(static_cast<double>(rate.trials), 0);
}

void add_rates(const LogsReport& page, report::Html& html) {
  report::Table table{{"Detector", "False alarms on natural pairs", "Share", "95 %", "For carries"},
                      {}};
  for (const DetectorKind detector : detectors(page)) {
    const auto& rate = find(page, detector, "natural")->alarms;
    const auto* carry = find(page, detector, "carry_natural");
    table.rows.push_back({in_words(name(detector)), shares(rate), fixed(rate.value(), 4),
                          fixed(rate.low(), 4) + " to " + fixed(rate.high(), 4),
                          carry ? shares(carry->alarms) : ""});
  }
  html.heading("False alarms while nothing happens");
  html.paragraph("The rate that was asked for is " + number(page.target_rate, 6) +
                 " per pair of scans.");
  html.table(table);
}

void add_detector(const LogsReport& page, DetectorKind detector, report::Html& html) {
  report::Table table{
      {"Event", "", "Alarms", "Share", "95 %", "AUC", "TPR at FPR .01", ".002", ".001"}, {}};
  for (const auto& row : page.rows) {
    if (row.detector != detector || row.log != kPooled) continue;
    std::vector<std::string> cells{
        in_words(row.kind),
        std::string(name(row.family)),
        shares(row.alarms),
        fixed(row.alarms.value(), 4),
        fixed(row.alarms.low(), 3) + " to " + fixed(row.alarms.high(), 3),
        row.roc ? fixed(row.roc->auc, 3) : ""};
    for (const auto& point : row.points) cells.push_back(fixed(point.found.value(), 3));
    cells.resize(table.head.size());
    table.rows.push_back(std::move(cells));
  }
  html.heading("All events: " + in_words(name(detector)));
  html.table(table);
}

std::string trouble_text(const evaluation::TrialResult& result) {
  std::string text;
  for (const auto& [trouble, scans] : result.troubles)
    text += (text.empty() ? "" : ", ") + trouble + " " + std::to_string(scans);
  return text;
}

/// One line of the table of logs, by the first detector that was tried.
std::vector<std::string> cells_of(const LogsReport& page, const JudgedLog& log) {
  std::vector<std::string> cells{log.trial.log,
                                 log.folder,
                                 std::to_string(log.scans),
                                 log.has_odometry ? "yes" : "no",
                                 log.tuning,
                                 fixed(log.fleet_threshold, 2)};
  const auto motion = log.trial.results.find(DetectorKind::motion_consistency);
  const auto* row = find(page, DetectorKind::motion_consistency, "natural", log.trial.log);
  if (!log.error.empty()) {
    cells.push_back(log.error);
  } else if (motion != log.trial.results.end() && row) {
    const auto& threshold = motion->second.threshold;
    cells.push_back(threshold ? fixed(*threshold, 2) : "warming up");
    cells.push_back(shares(row->alarms));
    cells.push_back(trouble_text(motion->second));
  }
  return cells;
}

void add_logs(const LogsReport& page, report::Html& html) {
  report::Table table{{"Log", "Folder", "Scans", "Odometry", "Tuning", "Fleet's threshold",
                       "In force", "False alarms", "Scans degraded"},
                      {}};
  for (const JudgedLog& log : page.logs) {
    table.rows.push_back(cells_of(page, log));
    table.rows.back().resize(table.head.size());
  }
  html.heading("Logs");
  html.paragraph("Thresholds, false alarms and degraded scans are motion consistency's.");
  html.table(table);
}

}  // namespace

std::string to_html(const LogsReport& page) {
  report::Html html("Do the detectors fit these robots?");
  html.paragraph(protocol(page));
  html.paragraph(
      "Kidnappings are cut from the recordings themselves: real scans before, real scans after, "
      "and odometry as if the robot had just driven on. Confounders look like kidnappings and are "
      "none.");
  html.heading("Kidnappings found");
  html.figure(figure_of(page, Family::kidnap, "Kidnappings: more is better", 1.0),
              "Dots: share found at the threshold in force; whiskers: 95 % (Wilson).");
  add_rates(page, html);
  html.heading("False alarms while something else happens");
  html.figure(figure_of(page, Family::confounder, "Confounders: less is better", 0.25),
              "The same for events that are no kidnappings. An arrow: more than the axis shows.");
  html.heading("What another threshold would do");
  for (const DetectorKind detector : detectors(page))
    html.figure(curves(page, detector),
                "One threshold for all logs, instead of each robot's own. A kidnapping counts as "
                "found if one of the three scans that decide on it is above.");
  for (const DetectorKind detector : detectors(page)) add_detector(page, detector, html);
  add_logs(page, html);
  return html.str();
}

}  // namespace kidnapwatch::service
