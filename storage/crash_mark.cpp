// SPDX-License-Identifier: Apache-2.0
// The mark, and the gap that is told by it.
#include "storage/crash_mark.hpp"

namespace kidnapwatch::storage {
namespace {

constexpr const char* kLatestArrival = R"(
SELECT max(arrival) FROM (
  SELECT max(arrival) AS arrival FROM block
  UNION ALL SELECT max(arrival) FROM score_even
  UNION ALL SELECT max(arrival) FROM score_odd))";

}  // namespace

CrashMark::CrashMark(Database& database) : database_(database) {
  if (database.integer("SELECT is_on FROM writing") == 0) return;
  Statement query(database, kLatestArrival);
  if (query.step() && !query.is_null(0)) died_at_ = query.stamp(0);
}

void CrashMark::set(core::Stamp first_arrival) {
  if (is_set_) return;
  database_.execute("UPDATE writing SET is_on = 1");
  if (died_at_) {
    Statement(database_, "INSERT INTO gap (since, until, reason) VALUES (?1, ?2, 'crash')")
        .bind(*died_at_, first_arrival)
        .run();
  }
  is_setting_ = true;
}

void CrashMark::clear() {
  if (is_set_) database_.execute("UPDATE writing SET is_on = 0");
}

}  // namespace kidnapwatch::storage
