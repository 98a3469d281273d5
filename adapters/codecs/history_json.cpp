// SPDX-License-Identifier: Apache-2.0
// Scores, incidents and scans, member by member.
#include "adapters/codecs/history_json.hpp"

#include <array>
#include <charconv>

#include "adapters/codecs/rfc3339.hpp"
#include "adapters/codecs/scan_encode.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return std::isfinite(value) ? std::string(text.data(), end) : std::string();
}

std::string csv_line(const core::Score& score) {
  return rfc3339(score.stamp) + "," + rfc3339(score.reference) + "," +
         number(score.dissimilarity.cost) + "," + number(score.dissimilarity.cost_per_beam) + "," +
         (score.dissimilarity.standardized ? "true" : "false") + "," +
         (score.threshold ? number(*score.threshold) : std::string()) + "," +
         std::string(core::name(score.state)) + "\r\n";
}

}  // namespace

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
  return object;
}

Json json(const core::Incident& incident) {
  Json object{{"id", incident.id},
              {"robotId", incident.robot},
              {"seq", incident.seq},
              {"kind", core::name(incident.kind)},
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
  object["explanation"] = sentence(incident.kind);
  object["configVersion"] = incident.config_version;
  return object;
}

std::string evidence_json(const core::Evidence& evidence) {
  Json scores = Json::array();
  for (const auto& score : evidence.scores) {
    scores.push_back(json(score));
  }
  std::string json_text = R"({"before":)";
  append_json(json_text, evidence.scans.before);
  json_text += R"(,"after":)";
  append_json(json_text, evidence.scans.after);
  return json_text + R"(,"scores":)" + text(scores) + "}";
}

std::string scores_csv(std::span<const core::Score> scores) {
  std::string csv = "time,referenceTime,score,scorePerBeam,standardized,threshold,state\r\n";
  for (const auto& score : scores) {
    csv += csv_line(score);
  }
  return csv;
}

}  // namespace kidnapwatch::adapters::codecs
