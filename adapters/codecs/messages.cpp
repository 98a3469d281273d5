// SPDX-License-Identifier: Apache-2.0
// The members of each message.
#include "adapters/codecs/messages.hpp"

#include "adapters/codecs/history_json.hpp"
#include "adapters/codecs/json.hpp"
#include "adapters/codecs/rfc3339.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

/// builtin_interfaces/Time; the nanoseconds count up from the second, before 1970 too.
Json ros_time(core::Stamp stamp) {
  const auto second = std::chrono::floor<std::chrono::seconds>(stamp);
  return {{"sec", second.time_since_epoch().count()},
          {"nanosec", std::chrono::nanoseconds(stamp - second).count()}};
}

/// As Alertmanager's users name it: what needs somebody now, and what does not, or not yet.
std::string_view severity(const core::Incident& incident) {
  const bool is_quiet = incident.state == core::IncidentState::resolved || incident.shelved_until;
  return is_quiet ? "info" : "critical";
}

}  // namespace

std::string alert_message(const core::Alert& alert) {
  const core::Incident& incident = alert.incident;
  Json message{{"schema", kAlertSchema},
               {"eventId", alert.event_id},
               {"incidentId", incident.id},
               {"seq", incident.seq},
               {"type", core::name(alert.type)},
               {"author", alert.author},
               {"kind", core::name(incident.kind)},
               {"cause", core::name(incident.cause)},
               {"robotId", incident.robot},
               {"state", core::name(incident.state)},
               {"severity", severity(incident)},
               {"timestamp", rfc3339(alert.timestamp)},
               {"openedAt", rfc3339(incident.opened_at)},
               {"scanStamp", ros_time(incident.scan_stamp)},
               {"beforeStamp", ros_time(incident.before_stamp)},
               {"afterStamp", ros_time(incident.after_stamp)},
               {"detector", incident.detector}};
  if (incident.resolved_at) {
    message["resolvedAt"] = rfc3339(*incident.resolved_at);
  }
  set(message, "score", incident.score);
  set(message, "threshold", incident.threshold);
  message["explanation"] = core::sentence(incident.cause);
  message["configVersion"] = incident.config_version;
  set_care(message, incident);
  message["links"] = {{"incident", "/api/v1/incidents/" + incident.id}};
  return text(message);
}

std::string state_message(const core::RobotStatus& robot, core::Stamp now) {
  Json message{{"schema", kStateSchema},
               {"robotId", robot.id},
               {"state", core::name(robot.state)},
               {"timestamp", rfc3339(now)}};
  if (robot.trouble) {
    message["trouble"] = name(*robot.trouble);
    message["explanation"] = sentence(*robot.trouble);
  }
  set(message, "incidentId", robot.incident_id);
  set(message, "threshold", robot.threshold);
  set(message, "motionThreshold", robot.motion_threshold);
  set(message, "ownMotionThreshold", robot.own_motion_threshold);
  message["calibration"] = {{"pairs", robot.calibration_pairs}, {"needed", robot.warmup_pairs}};
  return text(message);
}

std::string score_message(std::string_view robot, const core::Score& score) {
  Json message{{"schema", kScoreSchema}, {"robotId", robot}};
  message.update(json(score));
  return text(message);
}

std::string service_status_message(std::string_view status, std::string_view version,
                                   core::Stamp started,
                                   std::span<const core::Degradation> degraded) {
  Json names = Json::array();
  for (const auto& degradation : degraded) {
    names.push_back(degradation.name);
  }
  return text(Json{{"schema", kServiceStatusSchema},
                   {"status", status},
                   {"version", version},
                   {"startedAt", rfc3339(started)},
                   {"degraded", names}});
}

}  // namespace kidnapwatch::adapters::codecs
