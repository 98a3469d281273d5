// SPDX-License-Identifier: Apache-2.0
// Scores, incidents and scans, member by member.
#include "adapters/codecs/history_json.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include "adapters/codecs/rfc3339.hpp"
#include "adapters/codecs/scan_encode.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return std::isfinite(value) ? std::string(text.data(), end) : std::string();
}

/// The double with the fewest digits that is `value` as a float: 0.02, not 0.0199999996.
double shortest(float value) {
  std::array<char, 32> text{};
  const auto* end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  double result = 0.0;
  std::from_chars(text.data(), end, result);
  return result;
}

Json json(const std::vector<core::DetectorScore>& others) {
  Json object = Json::object();
  for (const auto& [detector, score] : others) {
    set(object, std::string(core::name(detector)).c_str(), shortest(score));
  }
  return object;
}

/// Those that have a score in any of `scores`, by number.
std::set<core::DetectorId> detectors(std::span<const core::Score> scores) {
  std::set<core::DetectorId> found;
  for (const auto& score : scores) {
    for (const auto& other : score.others) found.insert(other.detector);
  }
  return found;
}

Json json(const core::Pose& pose) {
  return {{"x", pose.x_m}, {"y", pose.y_m}, {"theta", pose.theta_rad}};
}

Json json(const core::Warping& warping) {
  Json steps = Json::array();
  for (const auto& [before, after, cost] : warping.steps) {
    steps.push_back(Json::array({before, after, shortest(static_cast<float>(cost))}));
  }
  return {{"cost", warping.cost}, {"standardized", warping.standardized}, {"steps", steps}};
}

Json json(const core::MotionSight& motion) {
  Json object{{"seen", json(motion.seen)}};
  if (motion.told) object["told"] = json(*motion.told);
  object["violating"] = {{"before", motion.violating_before}, {"after", motion.violating_after}};
  return object;
}

std::string csv_cell(const core::Score& score, core::DetectorId detector) {
  const auto found = std::ranges::find(score.others, detector, &core::DetectorScore::detector);
  return "," + (found == score.others.end() ? std::string() : number(shortest(found->score)));
}

std::string optional_cell(const std::optional<double>& value) {
  return "," + (value ? number(*value) : std::string());
}

std::string motion_cells(const std::optional<core::MotionScore>& motion) {
  if (!motion) return ",,,,";
  return optional_cell(motion->score) + optional_cell(motion->confirmed) +
         optional_cell(motion->threshold) + optional_cell(motion->carry);
}

using Named = std::pair<const char*, core::Spread core::ScoreBucket::*>;
constexpr std::array<Named, 5> kSpreads{{{"score", &core::ScoreBucket::cost},
                                         {"scorePerBeam", &core::ScoreBucket::cost_per_beam},
                                         {"motion", &core::ScoreBucket::motion},
                                         {"motionConfirmed", &core::ScoreBucket::confirmed},
                                         {"carry", &core::ScoreBucket::carry}}};

constexpr std::array kIncidentColumns{
    "id",           "robotId",    "seq",         "kind",          "cause",          "state",
    "openedAt",     "resolvedAt", "beforeTime",  "afterTime",     "scanTime",       "detector",
    "score",        "threshold",  "explanation", "configVersion", "acknowledgedBy", "resolvedBy",
    "shelvedUntil", "label",      "comment"};

/// Quoted where RFC 4180 wants it. A text that a spreadsheet would take for a formula is told from
/// one by an apostrophe, for people write comments.
std::string text_cell(std::string text) {
  if (!text.empty() && std::string_view("=+-@\t\r").find(text[0]) != std::string_view::npos) {
    text.insert(text.begin(), '\'');
  }
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + "\"";
}

std::string cell(const Json& row, const char* column) {
  const auto found = row.find(column);
  if (found == row.end()) return "";
  return found->is_string() ? text_cell(found->get<std::string>()) : text(*found);
}

std::string spread_cells(const core::Spread& spread) {
  if (spread.count == 0) return ",,,";
  return "," + number(spread.min) + "," + number(spread.max) + "," + number(spread.mean());
}

std::string csv_line(const core::Score& score) {
  return rfc3339(score.stamp) + "," + rfc3339(score.reference) + "," +
         number(score.dissimilarity.cost) + "," + number(score.dissimilarity.cost_per_beam) + "," +
         (score.dissimilarity.standardized ? "true" : "false") + "," +
         (score.threshold ? number(*score.threshold) : std::string()) + "," +
         std::string(core::name(score.state));
}

}  // namespace

void set_care(Json& object, const core::Incident& incident) {
  const auto set_text = [&](const char* key, const std::string& value) {
    if (!value.empty()) object[key] = value;
  };
  set_text("acknowledgedBy", incident.acknowledged_by);
  set_text("resolvedBy", incident.resolved_by);
  if (incident.shelved_until) object["shelvedUntil"] = rfc3339(*incident.shelved_until);
  if (incident.label) object["label"] = core::name(*incident.label);
  set_text("comment", incident.comment);
}

Json json(const core::MotionScore& motion) {
  Json object = Json::object();
  set(object, "score", motion.score);
  set(object, "confirmed", motion.confirmed);
  set(object, "threshold", motion.threshold);
  set(object, "carry", motion.carry);
  return object;
}

Json json(const core::Score& score) {
  Json object{{"time", rfc3339(score.stamp)}, {"referenceTime", rfc3339(score.reference)}};
  set(object, "score", score.dissimilarity.cost);
  set(object, "scorePerBeam", score.dissimilarity.cost_per_beam);
  set(object, "standardized", score.dissimilarity.standardized);
  set(object, "threshold", score.threshold);
  if (score.motion) {
    object["motion"] = json(*score.motion);
  }
  set(object, "state", core::name(score.state));
  if (const Json others = json(score.others); !others.empty()) {
    object["detectors"] = others;
  }
  return object;
}

Json json(const core::Incident& incident) {
  Json object{{"id", incident.id},
              {"robotId", incident.robot},
              {"seq", incident.seq},
              {"kind", core::name(incident.kind)},
              {"cause", core::name(incident.cause)},
              {"state", core::name(incident.state)},
              {"openedAt", rfc3339(incident.opened_at)}};
  if (incident.resolved_at) {
    object["resolvedAt"] = rfc3339(*incident.resolved_at);
  }
  object["beforeTime"] = rfc3339(incident.before_stamp);
  object["afterTime"] = rfc3339(incident.after_stamp);
  object["scanTime"] = rfc3339(incident.scan_stamp);
  object["detector"] = incident.detector;
  set(object, "score", incident.score);
  set(object, "threshold", incident.threshold);
  object["explanation"] = core::sentence(incident.cause);
  object["configVersion"] = incident.config_version;
  set_care(object, incident);
  return object;
}

std::string scans_json(std::span<const core::Scan> scans) {
  std::string json_text = "{";
  if (scans.size() > 1) {
    json_text += R"("before":)";
    append_json(json_text, scans.front());
    json_text += ",";
  }
  if (!scans.empty()) {
    json_text += R"("after":)";
    append_json(json_text, scans.back());
  }
  return json_text + "}";
}

Json change_json(const std::string& alert_message) {
  const Json alert = parsed(alert_message, "stored alert");
  Json change = Json::object();
  const auto take = [&](const char* from, const char* as) {
    if (const auto found = alert.find(from); found != alert.end()) change[as] = *found;
  };
  take("timestamp", "time");
  take("author", "author");
  take("type", "action");
  for (const char* member : {"seq", "state", "shelvedUntil", "label", "comment"}) {
    take(member, member);
  }
  return change;
}

std::string evidence_json(const core::Evidence& evidence, const core::Sight& sight) {
  Json scores = Json::array();
  for (const auto& score : evidence.scores) {
    scores.push_back(json(score));
  }
  std::string json_text = R"({"before":)";
  append_json(json_text, evidence.scans.before);
  json_text += R"(,"after":)";
  append_json(json_text, evidence.scans.after);
  json_text += R"(,"scores":)" + text(scores);
  if (sight.warping) json_text += R"(,"warping":)" + text(json(*sight.warping));
  if (sight.motion) json_text += R"(,"motion":)" + text(json(*sight.motion));
  return json_text + "}";
}

std::string scores_csv(std::span<const core::Score> scores) {
  const auto others = detectors(scores);
  const bool has_motion = std::ranges::any_of(
      scores, [](const core::Score& score) { return score.motion.has_value(); });
  std::string csv = "time,referenceTime,score,scorePerBeam,standardized,threshold,state";
  if (has_motion) csv += ",motion,motionConfirmed,motionThreshold,carry";
  for (const auto detector : others) csv.append(",").append(core::name(detector));
  csv += "\r\n";
  for (const auto& score : scores) {
    csv += csv_line(score);
    if (has_motion) csv += motion_cells(score.motion);
    for (const auto detector : others) csv += csv_cell(score, detector);
    csv += "\r\n";
  }
  return csv;
}

std::string incidents_csv(std::span<const core::Incident> incidents) {
  std::string csv;
  for (const char* column : kIncidentColumns) csv.append(csv.empty() ? "" : ",").append(column);
  for (const auto& incident : incidents) {
    csv += "\r\n";
    const Json row = json(incident);
    for (const char* column : kIncidentColumns) {
      if (column != kIncidentColumns.front()) csv += ",";
      csv += cell(row, column);
    }
  }
  return csv + "\r\n";
}

Json json(const core::ScoreBucket& bucket) {
  Json object{
      {"time", rfc3339(bucket.from)}, {"seconds", bucket.width.count()}, {"scores", bucket.scores}};
  for (const auto& [name, spread] : kSpreads) {
    const core::Spread& of = bucket.*spread;
    if (of.count > 0) object[name] = {{"min", of.min}, {"max", of.max}, {"mean", of.mean()}};
  }
  set(object, "threshold", bucket.threshold);
  set(object, "motionThreshold", bucket.motion_threshold);
  object["state"] = core::name(bucket.state);
  return object;
}

std::string score_buckets_csv(std::span<const core::ScoreBucket> buckets) {
  std::string csv = "time,seconds,scores";
  for (const auto& [name, spread] : kSpreads) {
    for (const char* of : {"Min", "Max", "Mean"}) csv.append(",").append(name).append(of);
  }
  csv += ",threshold,motionThreshold,state\r\n";
  for (const auto& bucket : buckets) {
    csv += rfc3339(bucket.from) + "," + std::to_string(bucket.width.count()) + "," +
           std::to_string(bucket.scores);
    for (const auto& [name, spread] : kSpreads) csv += spread_cells(bucket.*spread);
    csv += optional_cell(bucket.threshold) + optional_cell(bucket.motion_threshold) + "," +
           std::string(core::name(bucket.state)) + "\r\n";
  }
  return csv;
}

}  // namespace kidnapwatch::adapters::codecs
