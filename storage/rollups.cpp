// SPDX-License-Identifier: Apache-2.0
// Runs of buckets: which one stays open, and which are written for good.
#include "storage/rollups.hpp"

#include <algorithm>

namespace kidnapwatch::storage {
namespace {

using core::ScoreBucket;
using Run = std::span<const ScoreBucket>;

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

void add_all(core::ScoreBuckets& buckets, Run run) {
  for (const auto& bucket : run) buckets.add(bucket);
}

/// Of the runs that `buckets` are made of, the one that holds `latest`; the others are `done`.
template <typename Done>
std::vector<ScoreBucket> open_run(const std::vector<ScoreBucket>& buckets, const RollupLevel& level,
                                  core::Stamp latest, const Done& done) {
  std::vector<ScoreBucket> open;
  for (auto begin = buckets.begin(); begin != buckets.end();) {
    const ScoreBucket span{.from = core::begin_of(level.span, begin->from), .width = level.span};
    const auto end = std::find_if(begin, buckets.end(),
                                  [&](const auto& each) { return !span.holds(each.from); });
    if (span.holds(latest)) {
      open.assign(begin, end);
    } else {
      done(Run(begin, end));
    }
    begin = end;
  }
  return open;
}

}  // namespace

OpenRollups open_rollups(Database& database, std::int64_t robot) {
  Statement query(database, "SELECT segment, minutes, hours FROM rollup_open WHERE robot = ?1");
  if (!query.bind(robot).step()) return {};
  return {.segment = query.integer(0),
          .minutes = unpacked(query.blob(1), kMinutes),
          .hours = unpacked(query.blob(2), kHours)};
}

Rollups::Rollups(Database& database)
    : database_(database),
      add_rollup_(database,
                  "INSERT INTO rollup (robot, width, begin, arrival, data) "
                  "VALUES (?1, ?2, ?3, ?4, ?5)"),
      put_open_(database, "INSERT OR REPLACE INTO rollup_open VALUES (?1, ?2, ?3, ?4)") {}

void Rollups::add(std::int64_t robot, Segment segment, std::span<const ArrivedScore> scores) {
  const auto& latest = scores.back();
  const auto open = open_rollups(database_, robot);
  core::ScoreBuckets minutes(kMinutes.width, kAll);
  add_all(minutes, open.minutes);
  for (const auto& arrived : scores) minutes.add(arrived.score);
  core::ScoreBuckets hours(kHours.width, kAll);
  add_all(hours, open.hours);
  const auto open_minutes = open_run(minutes.all(), kMinutes, latest.score.stamp, [&](Run run) {
    write(robot, kMinutes, latest.arrival, run);
    add_all(hours, run);
  });
  const auto open_hours = open_run(hours.all(), kHours, latest.score.stamp,
                                   [&](Run run) { write(robot, kHours, latest.arrival, run); });
  put_open_.bind(robot, segment, packed(open_minutes, kMinutes), packed(open_hours, kHours)).run();
}

void Rollups::write(std::int64_t robot, const RollupLevel& level, core::Stamp arrival, Run run) {
  const auto begin = core::begin_of(level.span, run.front().from);
  add_rollup_.bind(robot, level.width.count(), begin, arrival, packed(run, level)).run();
}

}  // namespace kidnapwatch::storage
