// SPDX-License-Identifier: Apache-2.0
// The tables as SQL, one step per released schema.
#include "storage/schema.hpp"

#include <array>
#include <string>

#include <sqlite3.h>

#include "storage/upkeep.hpp"

namespace kidnapwatch::storage {
namespace {

constexpr std::int64_t kApplicationId = 0x4b4e4157;  // "KNAW", at byte 68 of the file

// Stamps are nanoseconds since 1970. A REAL that is NULL was NaN, or absent where it may be.
// A score's state is the number of core::RobotState, its others are a byte for the detector and a
// float for each, its motion a byte of flags and floats; the robot of an incident is its id as
// text.
constexpr std::string_view kSchema1 = R"(
CREATE TABLE robot (id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE) STRICT;

-- The segment that rows are appended to: in score_even or score_odd, by its number.
CREATE TABLE segment (open INTEGER NOT NULL) STRICT;
INSERT INTO segment VALUES (0);

CREATE TABLE score_even (
  id INTEGER PRIMARY KEY, robot INTEGER NOT NULL, arrival INTEGER NOT NULL,
  stamp INTEGER NOT NULL, reference INTEGER NOT NULL, cost REAL, cost_per_beam REAL,
  standardized INTEGER NOT NULL, threshold REAL, state INTEGER NOT NULL,
  others BLOB NOT NULL, motion BLOB NOT NULL) STRICT;

CREATE TABLE score_odd (
  id INTEGER PRIMARY KEY, robot INTEGER NOT NULL, arrival INTEGER NOT NULL,
  stamp INTEGER NOT NULL, reference INTEGER NOT NULL, cost REAL, cost_per_beam REAL,
  standardized INTEGER NOT NULL, threshold REAL, state INTEGER NOT NULL,
  others BLOB NOT NULL, motion BLOB NOT NULL) STRICT;

-- Scores of one robot, packed; see storage/block.hpp.
CREATE TABLE block (
  id INTEGER PRIMARY KEY, robot INTEGER NOT NULL, segment INTEGER NOT NULL,
  arrival INTEGER NOT NULL, first_stamp INTEGER NOT NULL, last_stamp INTEGER NOT NULL,
  data BLOB NOT NULL) STRICT;
CREATE INDEX block_of_robot ON block (robot, first_stamp, last_stamp);
CREATE INDEX block_by_arrival ON block (arrival);

-- Scores of one robot, summed up in buckets of `width` seconds; see storage/rollup.hpp.
CREATE TABLE rollup (
  id INTEGER PRIMARY KEY, robot INTEGER NOT NULL, width INTEGER NOT NULL, begin INTEGER NOT NULL,
  arrival INTEGER NOT NULL, data BLOB NOT NULL) STRICT;
CREATE INDEX rollup_of_robot ON rollup (robot, width, begin);
CREATE INDEX rollup_by_arrival ON rollup (width, arrival);

-- The last segment of which the robot's scores are packed, and of those: minutes that are in no
-- rollup yet, and hours that are not, but their minutes.
CREATE TABLE rollup_open (
  robot INTEGER PRIMARY KEY, segment INTEGER NOT NULL, minutes BLOB NOT NULL,
  hours BLOB NOT NULL) STRICT;

CREATE TABLE incident (
  id TEXT PRIMARY KEY, robot TEXT NOT NULL, seq INTEGER NOT NULL, kind TEXT NOT NULL,
  state TEXT NOT NULL, opened_at INTEGER NOT NULL, resolved_at INTEGER,
  scan_stamp INTEGER NOT NULL, before_stamp INTEGER NOT NULL, after_stamp INTEGER NOT NULL,
  detector TEXT NOT NULL, score REAL, threshold REAL, config_version INTEGER NOT NULL,
  cause TEXT NOT NULL, acknowledged_by TEXT NOT NULL, resolved_by TEXT NOT NULL,
  shelved_until INTEGER, label TEXT, comment TEXT NOT NULL) STRICT, WITHOUT ROWID;
CREATE INDEX incident_of_robot ON incident (robot, id);
CREATE INDEX incident_by_opening ON incident (opened_at);
CREATE INDEX incident_unresolved ON incident (id) WHERE state <> 'resolved';

CREATE TABLE evidence_scan (
  incident TEXT NOT NULL REFERENCES incident ON DELETE CASCADE,
  is_after INTEGER NOT NULL, stamp INTEGER NOT NULL,
  angle_min REAL, angle_increment REAL, range_min REAL, range_max REAL,
  odometry_x REAL, odometry_y REAL, odometry_theta REAL,
  ranges BLOB NOT NULL,  -- float32, little-endian, metres
  PRIMARY KEY (incident, is_after)) STRICT;

CREATE TABLE config (
  version INTEGER PRIMARY KEY, since INTEGER NOT NULL, author TEXT NOT NULL, text TEXT NOT NULL,
  robot TEXT NOT NULL) STRICT;  -- '': the fleet's
CREATE INDEX config_of_robot ON config (robot, version);

-- What was learned of a robot, for the service's next start.
CREATE TABLE learned (
  robot TEXT PRIMARY KEY, numbers BLOB NOT NULL  -- float32, little-endian
) STRICT, WITHOUT ROWID;

-- Every change of an incident as it was told, in the order of the commits. AUTOINCREMENT: whoever
-- follows them remembers an id, which is never given again.
CREATE TABLE alert (
  id INTEGER PRIMARY KEY AUTOINCREMENT, event_id TEXT NOT NULL UNIQUE,
  incident TEXT NOT NULL REFERENCES incident ON DELETE CASCADE,
  robot TEXT NOT NULL, payload TEXT NOT NULL, delivered INTEGER NOT NULL DEFAULT 0) STRICT;
CREATE INDEX alert_of_incident ON alert (incident, id);
CREATE INDEX alert_undelivered ON alert (id) WHERE NOT delivered;

-- Scores that are missing, by time of arrival: the last one before and the first one after.
CREATE TABLE gap (
  id INTEGER PRIMARY KEY, since INTEGER NOT NULL, until INTEGER NOT NULL, reason TEXT NOT NULL,
  scores INTEGER) STRICT;  -- NULL: nobody knows how many
-- Whether a service writes, or died while it did.
CREATE TABLE writing (is_on INTEGER NOT NULL) STRICT;
INSERT INTO writing VALUES (0);

CREATE TABLE audit (
  id INTEGER PRIMARY KEY, at INTEGER NOT NULL, actor TEXT NOT NULL, action TEXT NOT NULL,
  subject TEXT NOT NULL, detail TEXT NOT NULL, hash BLOB NOT NULL) STRICT;
CREATE TRIGGER audit_is_not_changed BEFORE UPDATE ON audit
BEGIN SELECT raise(ABORT, 'the audit trail is append-only'); END;
CREATE TRIGGER audit_is_not_deleted BEFORE DELETE ON audit
BEGIN SELECT raise(ABORT, 'the audit trail is append-only'); END;
)";

constexpr std::array kMigrations{kSchema1};

bool has_tables(Database& database) {
  return database.integer("SELECT count(*) FROM sqlite_schema") > 0;
}

void refuse_foreign(Database& database, const std::filesystem::path& file, std::size_t latest) {
  const auto version = database.integer("PRAGMA user_version");
  if (database.integer("PRAGMA application_id") != kApplicationId && has_tables(database)) {
    throw StorageError(SQLITE_MISMATCH, "store " + file.string() + ": not a kidnapwatch store");
  }
  if (version > static_cast<std::int64_t>(latest)) {
    throw StorageError(SQLITE_MISMATCH,
                       "store " + file.string() + ": schema " + std::to_string(version) +
                           " is newer than this program's " + std::to_string(latest) +
                           "; install a newer kidnapwatch or use another file");
  }
}

/// Persistent properties of the file, which cannot be set inside a transaction.
void set_up(Database& database) {
  database.execute("PRAGMA auto_vacuum = INCREMENTAL; PRAGMA journal_mode = WAL");
}

}  // namespace

std::span<const std::string_view> migrations() { return kMigrations; }

void migrate(const std::filesystem::path& file, std::span<const std::string_view> steps) {
  Database database(file, Access::read_write);
  refuse_foreign(database, file, steps.size());
  auto version = static_cast<std::size_t>(database.integer("PRAGMA user_version"));
  if (version == 0) set_up(database);
  if (version == steps.size()) return;
  if (version > 0) backup(file, file.string() + ".schema-" + std::to_string(version));
  Transaction transaction(database, Transaction::Kind::write);
  for (; version < steps.size(); ++version) database.execute(std::string(steps[version]));
  database.execute("PRAGMA application_id = " + std::to_string(kApplicationId) +
                   "; PRAGMA user_version = " + std::to_string(version));
  transaction.commit();
}

}  // namespace kidnapwatch::storage
