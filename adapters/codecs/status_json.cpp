// SPDX-License-Identifier: Apache-2.0
// Robots and the service, member by member.
#include "adapters/codecs/status_json.hpp"

#include "adapters/codecs/history_json.hpp"
#include "adapters/codecs/rfc3339.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

/// Every one by its name, zeros too: a reader never has to ask whether one is known.
template <typename Enum, std::size_t N>
Json by_name(const std::array<std::uint64_t, N>& counts) {
  Json object = Json::object();
  for (std::size_t i = 0; i < N; ++i) {
    object[std::string(core::name(static_cast<Enum>(i)))] = counts.at(i);
  }
  return object;
}

Json json(const core::OutcomeCounts& counts) { return by_name<core::Outcome>(counts); }

Json json(const std::vector<core::Degradation>& degraded) {
  Json list = Json::array();
  for (const auto& [name, what] : degraded) {
    list.push_back({{"name", name}, {"what", what}});
  }
  return list;
}

}  // namespace

Json json(const core::RobotStatus& robot) {
  Json object{{"id", robot.id},
              {"state", core::name(robot.state)},
              {"lastScanAt", rfc3339(robot.last_arrival)}};
  if (robot.trouble) {
    object["trouble"] = name(*robot.trouble);
    object["explanation"] = sentence(*robot.trouble);
  }
  set(object, "incidentId", robot.incident_id);
  set(object, "threshold", robot.threshold);
  set(object, "motionThreshold", robot.motion_threshold);
  set(object, "ownMotionThreshold", robot.own_motion_threshold);
  object["calibration"] = {{"pairs", robot.calibration_pairs}, {"needed", robot.warmup_pairs}};
  if (robot.score) {
    object["lastScore"] = json(*robot.score);
  }
  object["scans"] = json(robot.counts);
  return object;
}

Json brief_json(const core::RobotStatus& robot) {
  Json object{{"id", robot.id},
              {"state", core::name(robot.state)},
              {"lastScanAt", rfc3339(robot.last_arrival)}};
  if (robot.trouble) object["trouble"] = name(*robot.trouble);
  set(object, "incidentId", robot.incident_id);
  set(object, "threshold", robot.threshold);
  set(object, "motionThreshold", robot.motion_threshold);
  if (const auto& score = robot.score) {
    set(object, "score", score->dissimilarity.cost);
    if (const auto& motion = score->motion) {
      set(object, "motion", motion->score);
      set(object, "motionConfirmed", motion->confirmed);
    }
  }
  return object;
}

Json json(const core::ServiceStatus& service) {
  return {{"version", service.version},
          {"startedAt", rfc3339(service.started)},
          {"robots", service.robots},
          {"brokerConnected", service.broker_connected},
          {"storeHealthy", service.store_healthy},
          {"queuedScans", service.queued_scans},
          {"queuedWrites", service.queued_writes},
          {"lostWrites", service.lost_writes},
          {"storeBytes", service.store_bytes},
          {"degraded", json(service.degraded)},
          {"scans", json(service.counts)},
          {"commands", by_name<core::CommandResult>(service.commands)}};
}

}  // namespace kidnapwatch::adapters::codecs
