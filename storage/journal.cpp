// SPDX-License-Identifier: Apache-2.0
// The statements that write incidents and configurations.
#include "storage/journal.hpp"

#include "storage/rows.hpp"

namespace kidnapwatch::storage {
namespace {

// A change that was overtaken by a later one of the same incident changes nothing.
constexpr std::string_view kPutIncident = R"(
INSERT INTO incident VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15,
  ?16, ?17, ?18, ?19, ?20)
ON CONFLICT (id) DO UPDATE SET
  robot = ?2, seq = ?3, kind = ?4, state = ?5, opened_at = ?6, resolved_at = ?7, scan_stamp = ?8,
  before_stamp = ?9, after_stamp = ?10, detector = ?11, score = ?12, threshold = ?13,
  config_version = ?14, cause = ?15, acknowledged_by = ?16, resolved_by = ?17,
  shelved_until = ?18, label = ?19, comment = ?20
WHERE ?3 >= seq)";

AuditEntry audit_entry(const IncidentChange& change) {
  const auto& incident = change.incident;
  return {.at = change.changed_at,
          .actor = change.author,
          .action = "incident." + std::string(core::name(change.type)),
          .subject = incident.id,
          .detail = "robot " + incident.robot + ", seq " + std::to_string(incident.seq)};
}

}  // namespace

Journal::Journal(Database& database)
    : database_(database),
      put_incident_(database, kPutIncident),
      add_scan_(database, "INSERT OR IGNORE INTO evidence_scan (incident, is_after, " +
                              std::string(kScanColumns) +
                              ") VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11)"),
      add_config_(database, "INSERT INTO config VALUES (?1, ?2, ?3, ?4, ?5)"),
      add_alert_(database,
                 "INSERT OR IGNORE INTO alert (event_id, incident, robot, payload) "
                 "VALUES (?1, ?2, ?3, ?4)"),
      add_gap_(database, "INSERT INTO gap (since, until, reason, scores) VALUES (?1, ?2, ?3, ?4)"),
      put_learned_(database,
                   "INSERT INTO learned VALUES (?1, ?2) ON CONFLICT DO UPDATE SET numbers = ?2"),
      confirm_(database, "UPDATE alert SET delivered = 1 WHERE event_id = ?1"),
      audit_(database) {}

void Journal::put(const IncidentChange& change) {
  const auto& incident = change.incident;
  bind_incident(put_incident_, incident);
  put_incident_.run();
  if (database_.changes() > 0) audit_.append(audit_entry(change));
  if (change.evidence) add_evidence(incident.id, *change.evidence);
  if (const auto& alert = change.alert) {
    add_alert_.bind(alert->event_id, incident.id, alert->robot, alert->payload).run();
  }
}

void Journal::add_evidence(const std::string& incident_id, const core::ScanPair& scans) {
  bind_scan(add_scan_, incident_id, false, scans.before);
  add_scan_.run();
  bind_scan(add_scan_, incident_id, true, scans.after);
  add_scan_.run();
}

void Journal::add(const ConfigText& config) {
  add_config_.bind(config.version, config.since, config.author, config.text, config.robot).run();
  const std::string of_robot = config.robot.empty() ? "" : " of robot " + config.robot;
  audit_.append({.at = config.since,
                 .actor = config.author,
                 .action = "config.set",
                 .subject = std::to_string(config.version) + of_robot,
                 .detail = config.text});
}

void Journal::add(const Gap& gap) {
  add_gap_.bind(gap.since, gap.until, gap.reason, gap.scores).run();
}

void Journal::put_learned(const std::string& robot, std::span<const float> numbers) {
  put_learned_.bind(robot, std::as_bytes(numbers)).run();
}

void Journal::confirm(const std::string& event_id) { confirm_.bind(event_id).run(); }

}  // namespace kidnapwatch::storage
