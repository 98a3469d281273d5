// SPDX-License-Identifier: Apache-2.0
// Deletion by age and by size.
#include "storage/retention.hpp"

#include <algorithm>
#include <string>

#include "storage/records.hpp"

namespace kidnapwatch::storage {
namespace {

constexpr int kBlocksAtOnce = 100;
constexpr int kRollupsAtOnce = 100;
constexpr int kIncidentsAtOnce = 20;
constexpr int kPagesAtOnce = 64;
constexpr std::int64_t kFreePagesToKeep = 8192;  // 32 MB: the hot tables need them again

// Evidence is the scans' robot and time, see Archive::evidence.
constexpr std::string_view kDeleteBlocks = R"(
DELETE FROM block WHERE id IN (
  SELECT id FROM block
  WHERE arrival >= ?1 AND arrival < ?2 AND NOT EXISTS (
    SELECT 1 FROM robot
    JOIN incident ON incident.robot = robot.name
    JOIN evidence_scan AS scan ON scan.incident = incident.id
    WHERE robot.id = block.robot
      AND scan.stamp BETWEEN block.first_stamp - ?3 AND block.last_stamp + ?3)
  ORDER BY arrival LIMIT ?4)
RETURNING arrival)";

constexpr std::string_view kDeleteOldIncidents = R"(
DELETE FROM incident WHERE id IN (
  SELECT id FROM incident WHERE opened_at < ?1 AND state = 'resolved'
  ORDER BY opened_at LIMIT ?2))";

constexpr std::string_view kDeleteAnyBlocks = R"(
DELETE FROM block WHERE id IN (
  SELECT id FROM block WHERE arrival < ?1 ORDER BY arrival LIMIT ?2))";

constexpr std::string_view kDeleteRollups = R"(
DELETE FROM rollup WHERE id IN (
  SELECT id FROM rollup WHERE width = ?1 AND arrival < ?2 ORDER BY arrival LIMIT ?3))";

}  // namespace

Retention::Retention(Database& database, RetentionConfig config)
    : database_(database),
      config_(config),
      max_pages_(static_cast<std::int64_t>(config.max_bytes) /
                 database.integer("PRAGMA page_size")),
      delete_blocks_(database, kDeleteBlocks),
      delete_any_blocks_(database, kDeleteAnyBlocks),
      delete_rollups_(database, kDeleteRollups),
      delete_old_incidents_(database, kDeleteOldIncidents) {
  database.execute("PRAGMA max_page_count = " + std::to_string(max_pages_));
}

void Retention::begin(core::Stamp now) {
  now_ = now;
  is_cleaning_ = true;
}

void Retention::clean_some() {
  is_cleaning_ = delete_old() || delete_old_incidents() || delete_surplus() || give_back_pages();
}

bool Retention::delete_old() {
  const auto hours_until = now_ - config_.keep_hours;
  if (delete_blocks(now_ - config_.keep_scores)) return true;
  kept_until_ = std::max(kept_until_, now_ - config_.keep_scores);
  return delete_rollups(kMinutes, now_ - config_.keep_minutes) || delete_any_blocks(hours_until) ||
         delete_rollups(kHours, hours_until);
}

bool Retention::delete_old_incidents() {
  delete_old_incidents_.bind(now_ - config_.keep_incidents, kIncidentsAtOnce).run();
  if (database_.changes() == 0) return false;
  kept_until_ = core::Stamp::min();  // what was their evidence is so no longer
  return true;
}

bool Retention::delete_surplus() {
  if (pages() - free_pages() <= max_pages_ / 8 * 7) return false;
  constexpr auto kAny = core::Stamp::max();
  return delete_blocks(kAny) || delete_rollups(kMinutes, kAny) || delete_any_blocks(kAny) ||
         delete_rollups(kHours, kAny);
}

bool Retention::delete_blocks(core::Stamp until) {
  delete_blocks_.bind(kept_until_, until, std::chrono::nanoseconds(kAroundEvidence).count(),
                      kBlocksAtOnce);
  bool any = false;
  for (; delete_blocks_.step(); any = true) {
    kept_until_ = std::max(kept_until_, delete_blocks_.stamp(0));
  }
  return any;
}

bool Retention::delete_any_blocks(core::Stamp until) {
  delete_any_blocks_.bind(until, kBlocksAtOnce).run();
  return database_.changes() > 0;
}

bool Retention::delete_rollups(const RollupLevel& level, core::Stamp until) {
  delete_rollups_.bind(level.width.count(), until, kRollupsAtOnce).run();
  return database_.changes() > 0;
}

bool Retention::give_back_pages() {
  if (free_pages() <= std::max(kFreePagesToKeep, pages() / 4)) return false;
  database_.execute("PRAGMA incremental_vacuum(" + std::to_string(kPagesAtOnce) + ")");
  return true;
}

std::int64_t Retention::pages() { return database_.integer("PRAGMA page_count"); }

std::int64_t Retention::free_pages() { return database_.integer("PRAGMA freelist_count"); }

}  // namespace kidnapwatch::storage
