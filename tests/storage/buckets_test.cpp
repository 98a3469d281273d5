// SPDX-License-Identifier: Apache-2.0
// Buckets out of rollups are those of the scores that were summed up, wherever the seam is.
#include "storage/buckets.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "storage/rollups.hpp"
#include "storage/schema.hpp"
#include "storage/segments.hpp"
#include "tests/storage/any_score.hpp"

namespace kidnapwatch::storage {
namespace {

using core::ScoreBucket;
using core::Stamp;
using std::chrono::hours;
using std::chrono::seconds;

constexpr SegmentConfig kSmall{.scores_per_robot = 40, .max_scores = 1000, .robots_per_commit = 1};
constexpr std::size_t kAll = 1'000'000;
const Stamp kMidnight = core::begin_of(hours(24), at_s(0));

double since_start(Stamp stamp) { return core::elapsed_s(at_s(0), stamp); }

class BucketsTest : public testing::Test {
 protected:
  static Database created(const std::filesystem::path& file) {
    migrate(file);
    Database database(file, Access::read_write);
    database.execute("PRAGMA synchronous = OFF");
    return database;
  }

  void commit(const std::vector<ScoreRow>& rows) {
    Transaction transaction(database_, Transaction::Kind::write);
    segments_->write(rows);
    transaction.commit();
    segments_->committed();
    for (const auto& row : rows) {
      if (row.robot == "robot-1") expected_.push_back(row.score);
    }
  }
  void undo(const std::vector<ScoreRow>& rows) {
    {
      const Transaction transaction(database_, Transaction::Kind::write);
      segments_->write(rows);
    }
    segments_->undone();
  }
  void restart() { segments_.emplace(database_, kSmall); }

  /// Of this robot and another one.
  [[nodiscard]] std::vector<ScoreRow> rows_at(Stamp stamp) {
    const double t = since_start(stamp);
    return {{"robot-1", any_score(t, random_), stamp}, {"robot-2", score_at(t), stamp}};
  }
  /// A score every so many seconds, from `from` to `to`.
  void drive(Stamp from, Stamp to, seconds every) {
    for (auto stamp = from; stamp < to; stamp += every) commit(rows_at(stamp));
  }
  /// Days of it, and now and then an hour in which the clock is wrong, a restart or a failure.
  void drive_wildly() {
    Stamp stamp = kMidnight + hours(22);
    for (int i = 0; i < 3000; ++i) {
      stamp += seconds(random_() % 60);
      const bool is_late = random_() % 50 == 0;
      commit(rows_at(is_late ? stamp - seconds(random_() % 20'000) : stamp));
      if (random_() % 40 == 0) undo(rows_at(stamp));
      if (random_() % 100 == 0) restart();
      if (i == 1000) stamp -= hours(5);
      if (i == 2000) stamp += hours(30);
    }
  }

  [[nodiscard]] std::vector<ScoreBucket> expected(Stamp from, Stamp to, seconds resolution,
                                                  std::size_t limit = kAll) const {
    core::ScoreBuckets buckets(resolution, limit);
    for (const auto& score : expected_) {
      if (score.stamp >= from && score.stamp < to) buckets.add(score);
    }
    return buckets.all();
  }
  [[nodiscard]] std::vector<ScoreBucket> found(Stamp from, Stamp to, seconds resolution,
                                               std::size_t limit = kAll) {
    const auto& recent = *segments_->recent();
    return score_buckets(database_, recent, "robot-1", from, to, resolution, limit);
  }
  [[nodiscard]] std::vector<ScoreBucket> found(seconds resolution) {
    return found(Stamp::min(), Stamp::max(), resolution);
  }
  [[nodiscard]] std::vector<ScoreBucket> expected(seconds resolution) const {
    return expected(Stamp::min(), Stamp::max(), resolution);
  }
  void expect_all_found() {
    for (const int s : {10, 60, 600, 3600, 86'400}) {
      EXPECT_EQ(found(seconds(s)), expected(seconds(s))) << s;
    }
  }
  [[nodiscard]] std::size_t scores_in(const std::vector<ScoreBucket>& buckets) const {
    std::size_t sum = 0;
    for (const auto& bucket : buckets) sum += bucket.scores;
    return sum;
  }
  [[nodiscard]] std::int64_t count(const std::string& what) {
    return database_.integer("SELECT count(*) FROM " + what);
  }
  /// As retention would.
  void forget(const std::string& table, Stamp before) {
    Statement(database_, "DELETE FROM " + table + " AND arrival < ?1").bind(before).run();
  }

  StoreFolder folder_;
  Database database_ = created(folder_.store());
  std::optional<Segments> segments_{std::in_place, database_, kSmall};
  std::vector<core::Score> expected_;
  std::mt19937 random_{1};
};

TEST_F(BucketsTest, AreThoseOfTheScoresWhateverHappenedMeanwhile) {
  drive_wildly();
  ASSERT_GT(count("rollup WHERE width = 60"), 20);
  ASSERT_GT(count("rollup WHERE width = 3600"), 2);
  ASSERT_GT(count("score_even") + count("score_odd"), 0);
  expect_all_found();
}

TEST_F(BucketsTest, AreCutWhereTheRangeIs) {
  drive_wildly();
  for (int round = 0; round < 300; ++round) {
    const auto from = kMidnight + seconds(random_() % 200'000);
    const auto to = from + seconds(random_() % 50'000);
    const auto resolution = nesting(seconds(1 + random_() % 20'000));
    const std::size_t limit = 1 + random_() % 100;
    ASSERT_EQ(found(from, to, resolution, limit), expected(from, to, resolution, limit))
        << since_start(from) << " to " << since_start(to) << " by " << resolution.count();
  }
}

TEST_F(BucketsTest, ComeAtAResolutionThatEndsWithMinutesAndHours) {
  drive(kMidnight, kMidnight + hours(2), seconds(20));
  EXPECT_EQ(found(seconds(50)), expected(seconds(60)));
  EXPECT_EQ(found(seconds(5000)), expected(seconds(7200)));
}

TEST_F(BucketsTest, OutliveTheScores) {
  drive_wildly();
  const auto minutes = expected(seconds(60));
  database_.execute("DELETE FROM block");
  EXPECT_EQ(found(seconds(60)), minutes);
  EXPECT_EQ(found(seconds(7200)), expected(seconds(7200)));
  const auto fine = found(seconds(10));
  EXPECT_EQ(scores_in(fine), expected_.size());
  EXPECT_EQ(fine.front().width, seconds(60));
  database_.execute("DELETE FROM rollup WHERE width = 60");
  EXPECT_EQ(found(seconds(3600)), expected(seconds(3600)));
  EXPECT_EQ(scores_in(found(seconds(60))), expected_.size());
  EXPECT_EQ(found(seconds(60)).front().width, seconds(3600));
}

TEST_F(BucketsTest, AreNeitherDoubledNorMissingAtTheSeam) {
  drive(kMidnight, kMidnight + hours(30), seconds(25));
  const auto scores_end = kMidnight + hours(20) + seconds(1234);
  const auto minutes_end = kMidnight + hours(9) + seconds(777);
  forget("block WHERE true", scores_end);
  forget("rollup WHERE width = 60", minutes_end);
  const auto all = found(seconds(5));
  EXPECT_EQ(scores_in(all), expected_.size());
  std::vector<std::int64_t> widths;
  Stamp end = Stamp::min();
  for (const auto& bucket : all) {
    EXPECT_GE(bucket.from, end);
    end = bucket.end();
    EXPECT_EQ(std::vector{bucket}, expected(bucket.from, end, bucket.width));
    if (widths.empty() || widths.back() != bucket.width.count()) {
      widths.push_back(bucket.width.count());
    }
  }
  EXPECT_EQ(widths, (std::vector<std::int64_t>{3600, 60, 5}));
}

TEST_F(BucketsTest, ComePageByPageAcrossTheSeam) {
  drive(kMidnight, kMidnight + hours(26), seconds(25));
  forget("block WHERE true", kMidnight + hours(20) + seconds(1234));
  forget("rollup WHERE width = 60", kMidnight + hours(9) + seconds(777));
  for (const auto resolution : {seconds(5), seconds(60), seconds(1800), seconds(3600)}) {
    const auto whole = found(resolution);
    std::vector<ScoreBucket> pages;
    for (Stamp from = Stamp::min();;) {
      auto page = found(from, Stamp::max(), resolution, 8);
      const bool is_last = page.size() < 8;
      if (!is_last) {
        from = page.back().from;
        page.pop_back();
      }
      pages.insert(pages.end(), page.begin(), page.end());
      if (is_last) break;
    }
    EXPECT_EQ(pages, whole) << resolution.count();
  }
}

TEST_F(BucketsTest, ShowASpikeInARangeThatIsFinerThanWhatIsLeft) {
  drive(kMidnight, kMidnight + hours(3), seconds(30));
  database_.execute("DELETE FROM block");
  const auto at = kMidnight + seconds(3700);
  const auto some = found(at, at + seconds(10), seconds(1));
  EXPECT_EQ(some, expected(kMidnight + seconds(3660), kMidnight + seconds(3720), seconds(60)));
}

TEST_F(BucketsTest, TakeLateScoresThatAreNotPackedYet) {
  drive(kMidnight, kMidnight + hours(3), seconds(30));
  database_.execute("DELETE FROM block");
  commit(rows_at(kMidnight + seconds(95)));
  const auto minute = found(kMidnight + seconds(60), kMidnight + seconds(120), seconds(10));
  EXPECT_EQ(minute, expected(kMidnight + seconds(60), kMidnight + seconds(120), seconds(60)));
}

TEST_F(BucketsTest, AreTheSameToAReaderBetweenTheCommitAndMemory) {
  drive(kMidnight, kMidnight + seconds(40), seconds(1));
  commit({});  // closes
  Transaction transaction(database_, Transaction::Kind::write);
  segments_->write({});
  transaction.commit();  // packed one of two robots, but memory does not know yet
  ASSERT_EQ(count("block"), 1);
  expect_all_found();
}

TEST_F(BucketsTest, OfARobotThatNobodyKnowsAreNone) { EXPECT_TRUE(found(seconds(60)).empty()); }

TEST_F(BucketsTest, ThatAreBrokenAreDamage) {
  drive(kMidnight, kMidnight + hours(3), seconds(30));
  database_.execute("UPDATE rollup_open SET minutes = x'00'");
  EXPECT_THROW((void)found(seconds(60)), StorageError);
}

TEST_F(BucketsTest, OfAQuarterAreWrittenOnce) {
  drive(kMidnight, kMidnight + hours(50), seconds(20));
  EXPECT_EQ(count("rollup WHERE width = 60 AND robot = 1"), 199);
  EXPECT_EQ(count("rollup WHERE width = 3600 AND robot = 1"), 2);
  EXPECT_EQ(count("rollup_open"), 2);
}

}  // namespace
}  // namespace kidnapwatch::storage
