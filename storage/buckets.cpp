// SPDX-License-Identifier: Apache-2.0
// The coarsest that answers, down to what was asked for and is still there.
#include "storage/buckets.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "storage/rollups.hpp"
#include "storage/scores.hpp"

namespace kidnapwatch::storage {
namespace {

using core::Score;
using core::ScoreBucket;
using core::Stamp;
using std::chrono::seconds;
using BucketMap = std::map<Stamp, ScoreBucket>;

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

void add(BucketMap& buckets, const ScoreBucket& bucket) {
  const auto [found, is_new] = buckets.try_emplace(bucket.from, bucket);
  if (!is_new) found->second.add(bucket);
}

void add_all(BucketMap& buckets, std::span<const ScoreBucket> more) {
  for (const auto& bucket : more) add(buckets, bucket);
}

std::size_t scores_in(const BucketMap& buckets) {
  return std::accumulate(
      buckets.begin(), buckets.end(), std::size_t{0},
      [](std::size_t sum, const auto& each) { return sum + each.second.scores; });
}

std::optional<std::int64_t> number_of(Database& database, const std::string& robot) {
  Statement query(database, "SELECT id FROM robot WHERE name = ?1");
  return query.bind(robot).step() ? std::optional(query.integer(0)) : std::nullopt;
}

/// Every hour with packed scores is looked at, in order; its minutes if it has to be divided, and
/// their scores if those have to be. What is gone in part is told by its number of scores.
class PackedScores {
 public:
  PackedScores(Database& database, std::string robot, Stamp from, Stamp to, seconds resolution,
               core::ScoreBuckets& buckets)
      : database_(database),
        robot_(std::move(robot)),
        from_(from),
        to_(to),
        resolution_(resolution),
        buckets_(buckets),
        rollups_(database,
                 "SELECT begin, data FROM rollup "
                 "WHERE robot = ?1 AND width = ?2 AND begin >= ?3 AND begin < ?4 ORDER BY begin"),
        minutes_(database,
                 "SELECT data FROM rollup WHERE robot = ?1 AND width = ?2 AND begin >= ?3 AND "
                 "begin < ?4"),
        number_(number_of(database, robot_).value_or(0)),
        open_(open_rollups(database, number_)) {}

  void add();
  /// The last segment of which scores were added.
  [[nodiscard]] Segment segment() const { return open_.segment; }

 private:
  [[nodiscard]] bool is_wanted(const ScoreBucket& bucket) const {
    return bucket.from < to_ && bucket.end() > from_;
  }
  [[nodiscard]] bool is_undivided(const ScoreBucket& bucket) const {
    const bool is_whole = bucket.from >= from_ && bucket.end() <= to_;
    return is_whole && resolution_ % bucket.width == seconds(0);
  }
  void add_hours(BucketMap& hours, Stamp until);
  void add_hour(const ScoreBucket& hour);
  [[nodiscard]] BucketMap minutes_of(const ScoreBucket& hour);
  void add_scores_of(std::span<const ScoreBucket> minutes);

  Database& database_;
  const std::string robot_;
  const Stamp from_;
  const Stamp to_;
  const seconds resolution_;
  core::ScoreBuckets& buckets_;
  Statement rollups_;
  Statement minutes_;
  const std::int64_t number_;
  const OpenRollups open_;
};

void PackedScores::add() {
  BucketMap hours;
  add_all(hours, open_.hours);
  core::ScoreBuckets of_minutes(kHours.width, kAll);
  for (const auto& minute : open_.minutes) of_minutes.add(minute);
  add_all(hours, of_minutes.all());
  rollups_.bind(number_, kHours.width.count(), core::begin_of(kHours.span, from_), to_);
  while (rollups_.step() && !buckets_.is_complete(rollups_.stamp(0))) {
    add_hours(hours, rollups_.stamp(0));
    add_all(hours, unpacked(rollups_.blob(1), kHours));
  }
  add_hours(hours, Stamp::max());
}

/// Those that begin before `until`, of which there will be no more.
void PackedScores::add_hours(BucketMap& hours, Stamp until) {
  const auto end = hours.lower_bound(until);
  for (auto hour = hours.begin(); hour != end; ++hour) {
    if (is_wanted(hour->second) && !buckets_.is_complete(hour->first)) add_hour(hour->second);
  }
  hours.erase(hours.begin(), end);
}

void PackedScores::add_hour(const ScoreBucket& hour) {
  if (is_undivided(hour)) return buckets_.add(hour);
  const auto minutes = minutes_of(hour);
  if (scores_in(minutes) != hour.scores) return buckets_.add(hour);
  std::vector<ScoreBucket> divided;
  for (const auto& [from, minute] : minutes) {
    if (is_undivided(minute)) {
      buckets_.add(minute);
    } else if (is_wanted(minute)) {
      divided.push_back(minute);
    }
  }
  if (resolution_ < kMinutes.width) return add_scores_of(divided);
  for (const auto& minute : divided) add_scores_of({&minute, 1});  // the first and the last
}

BucketMap PackedScores::minutes_of(const ScoreBucket& hour) {
  BucketMap minutes;
  for (const auto& minute : open_.minutes) {
    if (hour.holds(minute.from)) storage::add(minutes, minute);
  }
  minutes_.bind(number_, kMinutes.width.count(), hour.from, hour.end());
  while (minutes_.step()) add_all(minutes, unpacked(minutes_.blob(0), kMinutes));
  return minutes;
}

void PackedScores::add_scores_of(std::span<const ScoreBucket> minutes) {
  if (minutes.empty()) return;
  std::map<Stamp, std::size_t> found;
  core::ScoreBuckets divided(std::min(resolution_, kMinutes.width), kAll);
  for_packed_scores(database_, robot_, minutes.front().from, minutes.back().end(),
                    [&](const Score& score) {
                      ++found[core::begin_of(kMinutes.width, score.stamp)];
                      if (score.stamp >= from_ && score.stamp < to_) divided.add(score);
                    });
  for (const auto& minute : minutes) {
    if (found[minute.from] != minute.scores) buckets_.add(minute);
  }
  for (const auto& part : divided.all()) {
    const auto minute = core::begin_of(kMinutes.width, part.from);
    const auto whole = std::ranges::find(minutes, minute, &ScoreBucket::from);
    if (whole != minutes.end() && found[minute] == whole->scores) buckets_.add(part);
  }
}

}  // namespace

std::vector<ScoreBucket> score_buckets(Database& database, const RecentScores& recent,
                                       const std::string& robot, Stamp from, Stamp to,
                                       seconds resolution, std::size_t limit) {
  const auto in_memory = recent.of(robot);  // first: what is packed meanwhile is told by segment()
  const Transaction one_look(database, Transaction::Kind::read);
  resolution = nesting(resolution);
  core::ScoreBuckets buckets(resolution, limit);
  PackedScores packed(database, robot, from, to, resolution, buckets);
  packed.add();
  for (const auto& found : in_memory) {
    const auto& score = found.arrived.score;
    const bool is_packed = found.segment <= packed.segment();
    if (!is_packed && score.stamp >= from && score.stamp < to) buckets.add(score);
  }
  return buckets.all();
}

}  // namespace kidnapwatch::storage
