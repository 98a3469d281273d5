// SPDX-License-Identifier: Apache-2.0
// Scores, incidents and scans, member by member.
#include "adapters/codecs/history_json.hpp"

#include <array>
#include <charconv>

#include "adapters/codecs/rfc3339.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

Json ros_stamp(core::Stamp stamp) {
  const auto sec = std::chrono::floor<std::chrono::seconds>(stamp);
  return {{"sec", sec.time_since_epoch().count()}, {"nanosec", (stamp - sec).count()}};
}

/// The double whose shortest text is the float's: 1.2f becomes 1.2, not 1.2000000476837158. Halves
/// the size of evidence and still reads back as the same float.
double shortest(float value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  double result = 0.0;
  std::from_chars(text.data(), end, result);
  return result;
}

Json ranges(const std::vector<float>& ranges_m) {
  Json array = Json::array();
  for (const float range_m : ranges_m) {
    array.push_back(std::isfinite(range_m) ? Json(shortest(range_m)) : Json(nullptr));
  }
  return array;
}

Json json(const core::Pose& pose) {
  return {{"x", pose.x_m}, {"y", pose.y_m}, {"theta", pose.theta_rad}};
}

Json json(const core::Scan& scan) {
  const auto& geometry = scan.geometry;
  const auto steps = static_cast<double>(scan.ranges_m.size()) - 1.0;
  Json object{{"header", {{"stamp", ros_stamp(scan.stamp)}}},
              {"angle_min", geometry.angle_min_rad},
              {"angle_max", geometry.angle_min_rad + steps * geometry.angle_increment_rad},
              {"angle_increment", geometry.angle_increment_rad},
              {"range_min", geometry.range_min_m},
              {"range_max", geometry.range_max_m},
              {"ranges", ranges(scan.ranges_m)}};
  if (scan.odometry) {
    object["odom"] = json(*scan.odometry);
  }
  return object;
}

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

Json json(const core::Score& score) {
  Json object{{"time", rfc3339(score.stamp)}, {"referenceTime", rfc3339(score.reference)}};
  set(object, "score", score.dissimilarity.cost);
  set(object, "scorePerBeam", score.dissimilarity.cost_per_beam);
  set(object, "standardized", score.dissimilarity.standardized);
  set(object, "threshold", score.threshold);
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
  object["configVersion"] = incident.config_version;
  return object;
}

Json json(const core::Evidence& evidence) {
  Json scores = Json::array();
  for (const auto& score : evidence.scores) {
    scores.push_back(json(score));
  }
  return {{"before", json(evidence.scans.before)},
          {"after", json(evidence.scans.after)},
          {"scores", std::move(scores)}};
}

std::string scores_csv(std::span<const core::Score> scores) {
  std::string csv = "time,referenceTime,score,scorePerBeam,standardized,threshold,state\r\n";
  for (const auto& score : scores) {
    csv += csv_line(score);
  }
  return csv;
}

}  // namespace kidnapwatch::adapters::codecs
