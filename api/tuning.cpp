// SPDX-License-Identifier: Apache-2.0
// Stored scores and labelled incidents against other thresholds. Nothing is changed by it.
#include "api/tuning.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>
#include <utility>

#include "adapters/codecs/history_json.hpp"
#include "adapters/codecs/rfc3339.hpp"
#include "api/problem.hpp"
#include "core/bad_input.hpp"
#include "core/calibration.hpp"
#include "core/evaluation/rates.hpp"
#include "core/evaluation/roc.hpp"
#include "core/evaluation/what_if.hpp"

namespace kidnapwatch::api {
namespace {

namespace evaluation = core::evaluation;
using adapters::codecs::rfc3339;
using core::BadInput;
using evaluation::TunedDetector;

constexpr std::size_t kMostScores = 2'000'000;  // of all robots; about a second
constexpr std::size_t kScoresAtOnce = 20'000;
constexpr std::size_t kMostListed = 100;     // incidents of each kind in an answer
constexpr std::size_t kFewestNatural = 100;  // scores that a threshold may rest on
constexpr double kMerge_s = 30.0;            // where incidents are not resolved by rule
constexpr double kDay_s = 86'400.0;

/// Which scores and incidents.
struct Scope {
  TunedDetector detector = TunedDetector::motion_consistency;
  std::optional<std::string> robot;
  TimeRange range;
};

/// One at a time: the rest of the API must not wait for a thread.
Response alone(const std::function<Response()>& answer) {
  static std::mutex busy;
  const std::unique_lock lock(busy, std::try_to_lock);
  return lock ? answer() : problem(503, "another threshold is being computed");
}

/// The member, taken off `body`; nothing if it is not there.
std::optional<Json> taken(Json& body, const char* member) {
  const auto found = body.find(member);
  if (found == body.end()) return std::nullopt;
  Json value = *found;
  body.erase(member);
  return value;
}

std::optional<std::string> taken_text(Json& body, const char* member) {
  const auto value = taken(body, member);
  if (!value) return std::nullopt;
  if (!value->is_string()) throw BadInput(member, "must be a text");
  return value->get<std::string>();
}

double taken_number(Json& body, const char* member, const char* range,
                    const std::function<bool(double)>& is_usable) {
  const auto value = taken(body, member);
  const bool is_number = value && value->is_number();
  if (!is_number || !is_usable(value->get<double>())) throw BadInput(member, range);
  return value->get<double>();
}

/// What is left of `body` is no member of this call.
void refuse_rest(const Json& body) {
  for (const auto& [member, value] : body.items()) {
    throw BadInput(member, "is not a known member");
  }
}

TimeRange ordered(TimeRange range) {
  if (range.to < range.from) throw BadInput("to", "must not be before from");
  return range;
}

Scope taken_scope(Json& body) {
  Scope scope;
  if (const auto detector = taken_text(body, "detector")) {
    scope.detector = evaluation::tuned_detector(*detector, "detector");
  }
  scope.robot = taken_text(body, "robot");
  if (const auto from = taken_text(body, "from")) {
    scope.range.from = adapters::codecs::stamp_from_rfc3339(*from, "from");
  }
  if (const auto to = taken_text(body, "to")) {
    scope.range.to = adapters::codecs::stamp_from_rfc3339(*to, "to");
  }
  scope.range = ordered(scope.range);
  return scope;
}

Json object_from(const Call& call) {
  Json body = adapters::codecs::parsed(call.request.body, "body");
  if (!body.is_object()) throw BadInput("body", "must be an object");
  return body;
}

/// The robots of the scope that the caller may see.
std::vector<std::string> robots(const Call& call, const Scope& scope) {
  std::vector<std::string> names;
  for (const auto& robot : call.ports.fleet.robots()) {
    const bool is_wanted = !scope.robot || *scope.robot == robot.id;
    if (is_wanted && call.caller.may_see(robot.id)) names.push_back(robot.id);
  }
  return names;
}

/// Shows `visit` the robot's scores, oldest first; `left` is how many more there may be in all.
void each_score(const Call& call, const std::string& robot, TimeRange range, std::size_t& left,
                const std::function<void(const core::Score&)>& visit) {
  while (true) {
    const auto page = call.ports.history.scores(robot, range, kScoresAtOnce);
    if (page.size() > left) {
      throw BadInput("from", "leaves more than 2000000 scores; must be later, or name a robot");
    }
    left -= page.size();
    for (const auto& score : page) visit(score);
    if (page.size() < kScoresAtOnce) return;
    range.from = page.back().stamp + std::chrono::nanoseconds(1);
  }
}

/// What the threshold of the detector decided on, newest first.
std::vector<core::Incident> incidents(const Call& call, const Scope& scope,
                                      const std::string& robot) {
  IncidentQuery query{.robot = robot, .limit = kMaxPage};
  std::vector<core::Incident> found;
  while (true) {
    const auto page = call.ports.history.incidents(query);
    for (const auto& incident : page) {
      const bool is_in =
          incident.scan_stamp >= scope.range.from && incident.scan_stamp < scope.range.to;
      if (is_in && evaluation::decided_on(scope.detector, incident)) found.push_back(incident);
    }
    if (page.size() < query.limit) return found;
    query.before_id = page.back().id;
  }
}

double merge_s(const Call& call, const std::string& robot) {
  const double configured = call.ports.fleet.config(robot).effective.config.resolve_after_s;
  return configured > 0.0 ? configured : kMerge_s;
}

/// Whether nobody said that it was right: then it counts as false.
bool counts_as_false(const core::Incident& incident) {
  return !incident.label || incident.label == core::IncidentLabel::false_alarm;
}

double per_day(double count, double observed_s) {
  return observed_s > 0.0 ? count * kDay_s / observed_s : 0.0;
}

/// The values of a level of the configuration that put a threshold in force.
Json values(TunedDetector detector, double threshold) {
  if (detector == TunedDetector::qs2ddtw) return {{"threshold", threshold}};
  return {{"motion", {{"threshold_min", threshold}}}};
}

/// Incidents and scores of all robots, counted up.
struct Preview {
  std::size_t scores = 0;
  double observed_s = 0.0;
  std::size_t kept = 0;
  std::size_t false_now = 0;
  std::size_t false_then = 0;
  std::size_t lost = 0;
  std::size_t raised = 0;
  Json lost_list = Json::array();
  Json raised_list = Json::array();

  void add(const std::string& robot, const evaluation::WhatIf& what_if,
           const evaluation::Difference& difference);
};

void Preview::add(const std::string& robot, const evaluation::WhatIf& what_if,
                  const evaluation::Difference& difference) {
  const auto count_false = [](const auto& list) {
    return static_cast<std::size_t>(std::ranges::count_if(list, counts_as_false));
  };
  scores += what_if.scores();
  observed_s += what_if.observed_s();
  kept += difference.kept.size();
  lost += difference.lost.size();
  raised += difference.raised.size();
  false_now += count_false(difference.kept) + count_false(difference.lost);
  false_then += count_false(difference.kept) + difference.raised.size();
  for (const auto& incident : difference.lost) {
    if (lost_list.size() < kMostListed) lost_list.push_back(adapters::codecs::json(incident));
  }
  for (const auto& would_be : difference.raised) {
    if (raised_list.size() >= kMostListed) break;
    raised_list.push_back(
        {{"robotId", robot}, {"time", rfc3339(would_be.first)}, {"score", would_be.score}});
  }
}

Response previewed(const Call& call, const Scope& scope, double threshold) {
  const auto names = robots(call, scope);
  if (names.empty() && scope.robot) return problem(404, "no robot is named " + *scope.robot);
  Preview preview;
  std::size_t left = kMostScores;
  for (const auto& robot : names) {
    const double merge = merge_s(call, robot);
    evaluation::WhatIf what_if(scope.detector, threshold, merge);
    each_score(call, robot, scope.range, left, [&](const auto& score) { what_if.add(score); });
    preview.add(robot, what_if,
                evaluation::difference(incidents(call, scope, robot), what_if.incidents(), merge));
  }
  const auto day = [&](std::size_t count) {
    return per_day(static_cast<double>(count), preview.observed_s);
  };
  return ok(
      {{"detector", evaluation::name(scope.detector)},
       {"threshold", threshold},
       {"scores", preview.scores},
       {"observedHours", preview.observed_s / 3600.0},
       {"kept", preview.kept},
       {"lost", preview.lost},
       {"raised", preview.raised},
       {"falseAlarmsPerDay", {{"now", day(preview.false_now)}, {"then", day(preview.false_then)}}},
       {"lostIncidents", preview.lost_list},
       {"raisedIncidents", preview.raised_list},
       {"values", values(scope.detector, threshold)}});
}

Response calibrated(const Call& call, const Scope& scope, double rate) {
  const auto names = robots(call, scope);
  if (names.empty() && scope.robot) return problem(404, "no robot is named " + *scope.robot);
  std::vector<double> natural;
  std::size_t left = kMostScores;
  double observed_s = 0.0;
  for (const auto& robot : names) {
    evaluation::WhatIf time(scope.detector, std::numeric_limits<double>::infinity(), kMerge_s);
    each_score(call, robot, scope.range, left, [&](const core::Score& score) {
      time.add(score);
      const auto value = evaluation::natural_score(scope.detector, score);
      if (value && std::isfinite(*value)) natural.push_back(*value);
    });
    observed_s += time.observed_s();
  }
  if (natural.size() < kFewestNatural) {
    return problem(409, "there are " + std::to_string(natural.size()) +
                            " natural scores of this detector; 100 are needed");
  }
  const double threshold = core::exponential_tail_threshold(natural, rate);
  const double pairs = rate * static_cast<double>(natural.size());
  return ok({{"detector", evaluation::name(scope.detector)},
             {"falseAlarmRate", rate},
             {"threshold", threshold},
             {"scores", natural.size()},
             {"observedHours", observed_s / 3600.0},
             {"above", evaluation::share_above(natural, threshold).hits},
             {"abovePerDay", per_day(pairs, observed_s)},
             {"values", values(scope.detector, threshold)}});
}

Json json(const evaluation::Rate& rate) {
  return {{"count", rate.hits}, {"rate", rate.value()}, {"low", rate.low()}, {"high", rate.high()}};
}

/// The point of the curve that is farthest above chance (Youden's index).
const evaluation::RocPoint& best(const evaluation::Roc& roc) {
  return *std::ranges::max_element(
      roc.points, {}, [](const evaluation::RocPoint& point) { return point.tpr - point.fpr; });
}

Json points(const evaluation::Roc& roc) {
  Json list = Json::array();
  for (const auto& [threshold, fpr, tpr] : roc.points) {
    Json point{{"falseAlarms", fpr}, {"found", tpr}};
    adapters::codecs::set(point, "threshold", threshold);  // the first is infinite
    list.push_back(std::move(point));
  }
  return list;
}

/// How many of `scores` are at least `threshold`.
evaluation::Rate share_from(const std::vector<double>& scores, double threshold) {
  const auto hits = std::ranges::count_if(scores, [&](double score) { return score >= threshold; });
  return {.hits = static_cast<std::size_t>(hits), .trials = scores.size()};
}

Response roc_of(TunedDetector detector, const std::vector<double>& false_alarms,
                const std::vector<double>& kidnappings) {
  const auto roc = evaluation::roc(false_alarms, kidnappings);
  // An alarm is above its threshold: a little below the score that is still to be found.
  const double lowest = best(roc).threshold;
  const double threshold = std::nextafter(lowest, 0.0);
  Json body{{"detector", evaluation::name(detector)},
            {"kidnappings", kidnappings.size()},
            {"falseAlarms", false_alarms.size()},
            {"area", {{"value", roc.auc}, {"low", roc.auc_low}, {"high", roc.auc_high}}},
            {"points", points(roc)}};
  if (std::isfinite(lowest)) {  // else nothing is better than chance
    body["suggestion"] = {{"threshold", threshold},
                          {"found", json(share_from(kidnappings, threshold))},
                          {"falseAlarms", json(share_from(false_alarms, threshold))},
                          {"values", values(detector, threshold)}};
  }
  return ok(body);
}

}  // namespace

Response preview_threshold(const Call& call) {
  Json body = object_from(call);
  const Scope scope = taken_scope(body);
  const double threshold =
      taken_number(body, "threshold", "must be a finite number above 0",
                   [](double value) { return std::isfinite(value) && value > 0.0; });
  refuse_rest(body);
  return alone([&] { return previewed(call, scope, threshold); });
}

Response calibrate_threshold(const Call& call) {
  Json body = object_from(call);
  const Scope scope = taken_scope(body);
  const double rate = taken_number(body, "falseAlarmRate", "must be above 0 and below 0.05",
                                   [](double value) { return value > 0.0 && value < 0.05; });
  refuse_rest(body);
  return alone([&] { return calibrated(call, scope, rate); });
}

Response get_roc(const Call& call) {
  Scope scope{.detector = {}, .robot = parameter(call, "robot"), .range = time_range(call)};
  scope.detector = evaluation::tuned_detector(
      parameter(call, "detector").value_or("motion_consistency"), "detector");
  const auto names = robots(call, scope);
  if (names.empty() && scope.robot) return problem(404, "no robot is named " + *scope.robot);
  std::vector<double> kidnappings;
  std::vector<double> false_alarms;
  for (const auto& robot : names) {
    for (const auto& incident : incidents(call, scope, robot)) {
      if (incident.label == core::IncidentLabel::kidnapping) kidnappings.push_back(incident.score);
      if (incident.label == core::IncidentLabel::false_alarm)
        false_alarms.push_back(incident.score);
    }
  }
  if (kidnappings.empty() || false_alarms.empty()) {
    return problem(409,
                   "incidents of this detector must be labelled, some kidnapping and some "
                   "false_alarm");
  }
  return roc_of(scope.detector, false_alarms, kidnappings);
}

}  // namespace kidnapwatch::api
