// SPDX-License-Identifier: Apache-2.0
// The statements that write.
#include "storage/journal.hpp"

#include "storage/rows.hpp"

namespace kidnapwatch::storage {
namespace {

/// FULL: with NORMAL a power cut loses what was acknowledged since the last checkpoint (1,204 of
/// 21,663 rows in a test), with FULL none.
Database open_for_writing(const std::filesystem::path& file) {
  Database database(file, Access::read_write);
  database.execute(
      "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA secure_delete = OFF;"
      "PRAGMA journal_size_limit = 67108864; PRAGMA cache_size = -16000");
  return database;
}

// A change that was overtaken by a later one of the same incident changes nothing.
constexpr std::string_view kPutIncident = R"(
INSERT INTO incident VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14)
ON CONFLICT (id) DO UPDATE SET
  robot = ?2, seq = ?3, kind = ?4, state = ?5, opened_at = ?6, resolved_at = ?7, scan_stamp = ?8,
  before_stamp = ?9, after_stamp = ?10, detector = ?11, score = ?12, threshold = ?13,
  config_version = ?14
WHERE ?3 >= seq)";

}  // namespace

Journal::Journal(const std::filesystem::path& file)
    : database_(open_for_writing(file)),
      find_robot_(database_, "SELECT id FROM robot WHERE name = ?1"),
      add_robot_(database_, "INSERT INTO robot (name) VALUES (?1)"),
      add_score_(database_, "INSERT INTO score (robot, arrival, " + std::string(kScoreColumns) +
                                ") VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)"),
      put_incident_(database_, kPutIncident),
      add_scan_(database_, "INSERT OR IGNORE INTO evidence_scan (incident, is_after, " +
                               std::string(kScanColumns) +
                               ") VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11)"),
      add_config_(database_, "INSERT INTO config VALUES (?1, ?2, ?3, ?4)") {}

std::int64_t Journal::robot_id(const std::string& robot) {
  if (const auto known = robot_ids_.find(robot); known != robot_ids_.end()) return known->second;
  std::int64_t id = 0;
  if (find_robot_.bind(robot).step()) {
    id = find_robot_.integer(0);
  } else {
    add_robot_.bind(robot).run();
    id = database_.last_row_id();
  }
  find_robot_.bind();
  return robot_ids_[robot] = id;
}

void Journal::append(const ScoreRow& row) {
  bind_score(add_score_, robot_id(row.robot), row.arrival, row.score);
  add_score_.run();
}

void Journal::put(const IncidentChange& change) {
  bind_incident(put_incident_, change.incident);
  put_incident_.run();
  if (!change.evidence) return;
  bind_scan(add_scan_, change.incident.id, false, change.evidence->before);
  add_scan_.run();
  bind_scan(add_scan_, change.incident.id, true, change.evidence->after);
  add_scan_.run();
}

void Journal::append(const ConfigText& config) {
  add_config_.bind(config.version, core::ns_since_epoch(config.since), config.author, config.text)
      .run();
}

}  // namespace kidnapwatch::storage
