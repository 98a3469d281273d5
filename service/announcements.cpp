// SPDX-License-Identifier: Apache-2.0
// What is said where, and how surely it arrives.
#include "service/announcements.hpp"

#include <utility>

#include "adapters/codecs/messages.hpp"

namespace kidnapwatch::service {

namespace codecs = adapters::codecs;

void Announcements::announce_state(const core::RobotStatus& status, core::Stamp now) {
  link_.publish_state(status.id, codecs::state_message(status, now),
                      std::string(codecs::kStateSchema));
}

void Announcements::announce_alert(const core::Alert& alert,
                                   std::optional<core::ScanPair> evidence) {
  const storage::OutboxMessage message{.event_id = alert.event_id,
                                       .robot = alert.incident.robot,
                                       .payload = codecs::alert_message(alert)};
  // Handed over before it is sent, so that the confirmation comes after it; waits for nothing.
  writer_.put_incident({.incident = alert.incident,
                        .type = alert.type,
                        .evidence = std::move(evidence),
                        .alert = message,
                        .changed_at = alert.timestamp,
                        .author = alert.author});
  outbox_.send(message);
}

void Announcements::announce_score(const std::string& robot, const core::Score& score,
                                   core::Stamp arrival) {
  if (score_rate_.allows(robot, score.state, arrival)) {
    link_.publish_score(robot, codecs::score_message(robot, score),
                        std::string(codecs::kScoreSchema));
  }
  writer_.add_score(robot, score, arrival);
}

void Announcements::keep_learned(const std::string& robot, std::vector<float> learned) {
  writer_.put_learned(robot, std::move(learned));
}

}  // namespace kidnapwatch::service
