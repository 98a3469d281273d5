// SPDX-License-Identifier: Apache-2.0
// Scores on their way from the hot tables into blocks, with restarts and failures at every step.
#include "storage/segments.hpp"

#include <algorithm>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "storage/schema.hpp"
#include "storage/scores.hpp"
#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {
namespace {

constexpr SegmentConfig kSmall{.scores_per_robot = 10, .max_scores = 100, .robots_per_commit = 2};

class SegmentsTest : public testing::Test {
 protected:
  static Database created(const std::filesystem::path& file) {
    migrate(file);
    return {file, Access::read_write};
  }

  void commit(const std::vector<ScoreRow>& rows = {}) {
    Transaction transaction(database_, Transaction::Kind::write);
    segments_->write(rows);
    transaction.commit();
    segments_->committed();
    for (const auto& row : rows) expected_[row.robot].push_back(row.score);
  }
  void undo(const std::vector<ScoreRow>& rows) {
    {
      const Transaction transaction(database_, Transaction::Kind::write);
      segments_->write(rows);
    }
    segments_->undone();
  }
  void restart() { segments_.emplace(database_, kSmall); }

  std::vector<ScoreRow> next_rows(int robots) {
    std::vector<ScoreRow> rows;
    rows.reserve(static_cast<std::size_t>(robots));
    for (int i = 0; i < robots; ++i) {
      rows.push_back({"robot-" + std::to_string(i), score_at(clock_), at_s(clock_)});
    }
    clock_ += 0.25;
    return rows;
  }

  [[nodiscard]] std::int64_t count(const std::string& what) {
    return database_.integer("SELECT count(*) FROM " + what);
  }
  void expect_all_found() {
    const auto cold = hot_scores(database_);
    for (const auto& [robot, expected] : expected_) {
      EXPECT_EQ(found(*segments_->recent(), robot), expected) << robot;
      EXPECT_EQ(found(*cold, robot), expected) << robot;
    }
  }
  [[nodiscard]] std::vector<core::Score> found(const RecentScores& recent,
                                               const std::string& robot) {
    return scores(database_, recent, robot, core::Stamp::min(), core::Stamp::max(), 1'000'000);
  }

  StoreFolder folder_;
  Database database_ = created(folder_.store());
  std::optional<Segments> segments_{std::in_place, database_, kSmall};
  std::map<std::string, std::vector<core::Score>> expected_;
  double clock_ = 0;
};

TEST_F(SegmentsTest, AFullSegmentIsPackedAFewRobotsAtATime) {
  for (int i = 0; i < 10; ++i) commit(next_rows(5));
  EXPECT_EQ(count("score_even"), 50);
  EXPECT_FALSE(segments_->is_packing());
  commit(next_rows(5));  // closes the first segment
  EXPECT_EQ(count("score_odd"), 5);
  EXPECT_TRUE(segments_->is_packing());
  for (const int blocks : {2, 4, 5}) {
    EXPECT_TRUE(segments_->is_packing());
    commit();
    EXPECT_EQ(count("block"), blocks);
    expect_all_found();
  }
  EXPECT_FALSE(segments_->is_packing());
  EXPECT_EQ(count("score_even"), 0);
  EXPECT_EQ(segments_->recent()->size(0).scores, 0U);
}

TEST_F(SegmentsTest, ManyRobotsCloseASegmentEarly) {
  for (int i = 0; i < 2; ++i) commit(next_rows(50));
  EXPECT_FALSE(segments_->is_packing());
  commit();
  EXPECT_TRUE(segments_->is_packing());
}

TEST_F(SegmentsTest, WhatIsUndoneWasNever) {
  for (int i = 0; i < 60; ++i) {
    undo(next_rows(4));  // with a robot that no committed transaction has seen, at first
    commit(next_rows(3));
    expect_all_found();
  }
  EXPECT_GT(count("block"), 0);
}

TEST_F(SegmentsTest, NothingIsLostOrDoubledByRestartsAtAnyStep) {
  std::mt19937 random(1);
  for (int i = 0; i < 150; ++i) {
    commit(next_rows(static_cast<int>(random() % 7)));
    if (random() % 3 == 0) undo(next_rows(2));
    if (random() % 2 == 0) restart();
    expect_all_found();
  }
  EXPECT_GT(count("block"), 30);
  EXPECT_LT(count("score_even") + count("score_odd"), 150);
}

TEST_F(SegmentsTest, RangesCutThroughBlocksAndRecentScores) {
  for (int i = 0; i < 57; ++i) commit(next_rows(1));  // to 14.25 s; some in blocks, some not
  ASSERT_GT(count("block"), 3);
  ASSERT_GT(count("score_even") + count("score_odd"), 0);
  const auto& all = expected_["robot-0"];
  for (std::size_t from = 0; from <= all.size(); ++from) {
    for (std::size_t to = from; to <= all.size(); to += 3) {
      for (const std::size_t limit : {0, 1, 5, 1000}) {
        const auto end = std::min(to, from + limit);
        const std::vector expected(all.begin() + static_cast<std::ptrdiff_t>(from),
                                   all.begin() + static_cast<std::ptrdiff_t>(end));
        EXPECT_EQ(scores(database_, *segments_->recent(), "robot-0",
                         at_s(0.25 * static_cast<double>(from)),
                         at_s(0.25 * static_cast<double>(to)), limit),
                  expected);
      }
    }
  }
}

TEST_F(SegmentsTest, AClockSetBackIsOrderedByStampAllTheSame) {
  for (int i = 0; i < 25; ++i) commit(next_rows(1));
  clock_ = 1.1;
  for (int i = 0; i < 32; ++i) commit(next_rows(1));
  auto expected = expected_["robot-0"];
  std::ranges::stable_sort(expected, {}, &core::Score::stamp);
  EXPECT_EQ(found(*segments_->recent(), "robot-0"), expected);
  expected.resize(20);
  EXPECT_EQ(scores(database_, *segments_->recent(), "robot-0", at_s(0), at_s(1000), 20), expected);
}

TEST_F(SegmentsTest, AReaderBetweenTheCommitAndMemoryFindsEachScoreOnce) {
  for (int i = 0; i < 10; ++i) commit(next_rows(1));
  commit();  // closes
  Transaction transaction(database_, Transaction::Kind::write);
  segments_->write({});
  transaction.commit();  // packed, but memory does not know yet
  ASSERT_EQ(count("block"), 1);
  EXPECT_EQ(found(*segments_->recent(), "robot-0"), expected_["robot-0"]);
  EXPECT_EQ(history(database_, *segments_->recent(), "robot-0", 100)->natural_scores.size(), 10U);
}

TEST_F(SegmentsTest, WhatOtherDetectorsSaidIsReadBackFromTheHotTable) {
  auto rows = next_rows(1);
  rows[0].score.others = {{core::detector_id("1ddtw", ""), 1.5F}, {core::detector_id("me", ""), 3}};
  rows[0].score.motion = core::MotionScore{.score = 1.5, .confirmed = -2.0, .carry = 0.25};
  commit(rows);
  const auto found = hot_scores(database_)->of("robot-0");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].arrived.score, rows[0].score);
}

TEST_F(SegmentsTest, ADetectorThatNobodyKnowsIsDamage) {
  commit(next_rows(1));
  database_.execute("UPDATE score_even SET others = x'FF00000000'");
  EXPECT_THROW((void)hot_scores(database_), StorageError);
}

TEST_F(SegmentsTest, AHistoryGoesBackThroughBlocks) {
  for (int i = 0; i < 45; ++i) {
    auto rows = next_rows(1);
    rows[0].score =
        score_at(i, i, i % 3 == 0 ? core::RobotState::kidnapped : core::RobotState::normal);
    commit(rows);
  }
  ASSERT_GT(count("block"), 2);
  const auto found = history(database_, *segments_->recent(), "robot-0", 25);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->latest.stamp, at_s(44));
  EXPECT_EQ(found->last_arrival, at_s(11));
  std::vector<double> natural;
  for (int i = 8; i < 45; ++i) {
    if (i % 3 != 0) natural.push_back(i);
  }
  EXPECT_EQ(found->natural_scores, natural);
  EXPECT_EQ(natural.size(), 25U);
}

}  // namespace
}  // namespace kidnapwatch::storage
