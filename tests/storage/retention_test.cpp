// SPDX-License-Identifier: Apache-2.0
// What is old goes, what is evidence stays, and the file keeps its size.
#include "storage/retention.hpp"

#include <thread>

#include <gtest/gtest.h>

#include "storage/archive.hpp"
#include "storage/schema.hpp"
#include "storage/segments.hpp"
#include "storage/upkeep.hpp"
#include "storage/writer.hpp"
#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {
namespace {

using std::chrono::hours;

constexpr double kHour = 3600;

class RetentionTest : public testing::Test {
 protected:
  RetentionTest() {
    migrate(folder_.store());
    database_.execute("PRAGMA synchronous = OFF");
  }

  /// A block of one score an hour; or of so many meaningless bytes.
  void add_blocks(int from_h, int to_h, std::size_t bytes = 0) {
    Transaction transaction(database_, Transaction::Kind::write);
    RobotIds ids(database_);
    Statement add(database_,
                  "INSERT INTO block (robot, segment, arrival, first_stamp, last_stamp, data) "
                  "VALUES (?1, ?2, ?3, ?3, ?3, ?4)");
    for (int h = from_h; h < to_h; ++h) {
      const auto stamp = at_s(h * kHour);
      const auto data =
          bytes == 0 ? packed(std::vector{score_at(h * kHour)}) : std::vector<std::byte>(bytes);
      add.bind(ids.of("robot-1"), h, stamp, data).run();
    }
    transaction.commit();
  }

  /// Rows of both levels, one an hour each, of so many meaningless bytes.
  void add_rollups(int from_h, int to_h, std::size_t bytes) {
    database_.execute("PRAGMA max_page_count = 1000000");  // however full it is
    Transaction transaction(database_, Transaction::Kind::write);
    Statement add(database_,
                  "INSERT INTO rollup (robot, width, begin, arrival, data) "
                  "VALUES (1, ?1, ?2, ?2, ?3)");
    for (const auto& level : {kMinutes, kHours}) {
      for (int h = from_h; h < to_h; ++h) {
        add.bind(level.width.count(), at_s(h * kHour), std::vector<std::byte>(bytes)).run();
      }
    }
    transaction.commit();
  }
  /// A score every ten minutes, packed and summed up.
  void drive(int from_h, int to_h) {
    Segments segments(database_, {.scores_per_robot = 20});
    for (double t = from_h * kHour; t < to_h * kHour; t += 600) {
      const std::vector rows{ScoreRow{"robot-1", score_at(t), at_s(t)}};
      Transaction transaction(database_, Transaction::Kind::write);
      segments.write(rows);
      transaction.commit();
      segments.committed();
    }
  }

  void clean(const RetentionConfig& config, int now_h) {
    Retention retention(database_, config);
    retention.begin(at_s(now_h * kHour));
    finish(retention);
  }
  void finish(Retention& retention) {
    for (rounds_ = 0; retention.is_cleaning(); ++rounds_) {
      Transaction transaction(database_, Transaction::Kind::write);
      retention.clean_some();
      transaction.commit();
    }
  }

  std::int64_t count(const std::string& what) {
    return database_.integer("SELECT count(*) FROM " + what);
  }
  /// Blocks left, as hours.
  std::vector<int> left() {
    Statement query(database_, "SELECT segment FROM block ORDER BY id");
    std::vector<int> found;
    while (query.step()) found.push_back(static_cast<int>(query.integer(0)));
    return found;
  }
  void put(const core::Incident& incident, double jump_s) {
    core::Scan scan{.stamp = at_s(jump_s), .ranges_m = {1.0F}};
    Writer({.file = folder_.store()})
        .put_incident({.incident = incident, .evidence = core::ScanPair{scan, scan}});
  }

  StoreFolder folder_;
  Database database_{folder_.store(), Access::read_write};
  int rounds_ = 0;
};

TEST_F(RetentionTest, ScoresGoWhenTheyAreOld) {
  add_blocks(0, 1000);
  clean({.keep_scores = hours(10)}, 1005);
  EXPECT_EQ(left(), (std::vector{995, 996, 997, 998, 999}));
  EXPECT_GE(rounds_, 10);  // not all at once
}

TEST_F(RetentionTest, ScoresAroundEvidenceStayAsLongAsTheirIncident) {
  add_blocks(0, 20);
  auto incident = incident_of(1);
  incident.opened_at = at_s(0);
  put(incident, 5 * kHour + 9);
  incident = incident_of(2);
  incident.robot = "robot-2";
  put(incident, 7 * kHour);  // another robot's
  Retention retention(database_, {.keep_scores = hours(2), .keep_incidents = hours(24)});
  retention.begin(at_s(20 * kHour));
  finish(retention);
  EXPECT_EQ(left(), (std::vector{5, 18, 19}));
  EXPECT_EQ(Archive(folder_.store()).evidence(incident_id(1))->scores,
            std::vector{score_at(5 * kHour)});
  retention.begin(at_s(30 * kHour));
  finish(retention);
  EXPECT_EQ(left(), std::vector{5});  // open incidents stay
  incident = incident_of(1);
  incident.opened_at = at_s(0);
  incident.state = core::IncidentState::resolved;
  put(incident, 0);
  retention.begin(at_s(30 * kHour));
  finish(retention);
  EXPECT_TRUE(left().empty());
  EXPECT_EQ(count("incident"), 1);
  EXPECT_EQ(count("evidence_scan"), 2);
}

TEST_F(RetentionTest, TheOldestScoresGoWhenTheFileIsNearlyFull) {
  const RetentionConfig config{.keep_scores = hours(10'000), .max_bytes = 8'000'000};
  add_blocks(0, 3000, 1900);  // 6 MB and more
  clean(config, 3000);
  const auto before = left().size();
  EXPECT_GT(before, 2500U);
  add_blocks(3000, 3400, 1900);
  clean(config, 3400);
  EXPECT_LT(left().size(), 3400U);
  EXPECT_EQ(left().back(), 3399);
  EXPECT_LE(database_.integer("PRAGMA page_count") - database_.integer("PRAGMA freelist_count"),
            7'000'000 / 4096);
}

TEST_F(RetentionTest, RollupsGoWhenTheyAreOld) {
  add_rollups(0, 1000, 1);
  clean({.keep_scores = hours(1), .keep_minutes = hours(10), .keep_hours = hours(500)}, 1005);
  EXPECT_EQ(count("rollup WHERE width = 60"), 5);
  EXPECT_EQ(count("rollup WHERE width = 3600"), 495);
}

TEST_F(RetentionTest, RollupsAnswerAndEvidenceRemainWhenScoresAreGone) {
  drive(0, 200);
  put(incident_of(1), 50 * kHour);
  const Archive archive(folder_.store());
  const auto buckets = [&](int resolution_s) {
    return archive.score_buckets("robot-1", core::Stamp::min(), core::Stamp::max(),
                                 std::chrono::seconds(resolution_s), 10'000);
  };
  const auto minutes = buckets(60);
  const auto half_hours = buckets(1800);
  ASSERT_EQ(minutes.size(), 1200U);
  const RetentionConfig config{.keep_scores = hours(24), .keep_minutes = hours(10'000)};
  clean(config, 200);
  EXPECT_LT(archive.scores("robot-1", at_s(0), core::Stamp::max(), 10'000).size(), 200U);
  EXPECT_EQ(buckets(60), minutes);
  EXPECT_EQ(buckets(1800), half_hours);
  EXPECT_EQ(archive.evidence(incident_id(1))->scores, std::vector{score_at(50 * kHour)});
  clean({.keep_scores = hours(24), .keep_minutes = hours(48)}, 200);
  EXPECT_LT(buckets(60).size(), 500U);
  std::size_t scores = 0;
  for (const auto& bucket : buckets(60)) scores += bucket.scores;
  EXPECT_EQ(scores, 1200U);
  EXPECT_EQ(archive.evidence(incident_id(1))->scores.size(), 1U);
  EXPECT_EQ(archive.incidents({}).size(), 1U);
}

TEST_F(RetentionTest, WhatIsCoarserGoesLaterWhenTheFileIsNearlyFull) {
  const RetentionConfig config{.keep_scores = hours(10'000),
                               .keep_minutes = hours(10'000),
                               .keep_hours = hours(10'000),
                               .max_bytes = 8'000'000};
  add_blocks(0, 1000, 1900);
  add_rollups(0, 1500, 1500);  // 2.5 and 2 times 3 MB
  put(incident_of(1), 500 * kHour);
  clean(config, 1500);
  EXPECT_LT(count("block"), 900);
  EXPECT_EQ(count("rollup"), 3000);
  add_rollups(1500, 1900, 1500);
  clean(config, 1900);
  EXPECT_EQ(left(), std::vector{500});  // evidence
  EXPECT_LT(count("rollup WHERE width = 60"), 1900);
  EXPECT_EQ(count("rollup WHERE width = 3600"), 1900);
  add_rollups(1900, 3900, 1500);
  clean(config, 3900);
  EXPECT_EQ(count("rollup WHERE width = 60"), 0);
  EXPECT_EQ(count("block"), 0);
  EXPECT_LT(count("rollup WHERE width = 3600"), 3900);
  EXPECT_EQ(count("incident"), 1);
  EXPECT_EQ(count("evidence_scan"), 2);
}

TEST_F(RetentionTest, WhatAFailedTransactionDeletedIsDeletedLater) {
  add_blocks(0, 300);
  Retention retention(database_, {.keep_scores = hours(10)});
  retention.begin(at_s(400 * kHour));
  {
    const Transaction transaction(database_, Transaction::Kind::write);
    retention.clean_some();
  }
  retention.undone();
  finish(retention);
  EXPECT_TRUE(left().empty());
}

TEST_F(RetentionTest, MuchFreeSpaceIsGivenBack) {
  add_blocks(0, 15'000, 4000);  // 60 MB
  const auto before = database_.integer("PRAGMA page_count");
  clean({.keep_scores = hours(100)}, 15'000);
  EXPECT_EQ(left().size(), 100U);
  EXPECT_LT(database_.integer("PRAGMA page_count"), before / 4 * 3);
  EXPECT_EQ(damage(folder_.store(), std::chrono::minutes(1)), std::nullopt);
}

TEST_F(RetentionTest, AFileAtItsLimitRefusesAndMakesRoom) {
  // The blocks of an hour fill the file; what is appended then has to push them out.
  add_blocks(0, 900, 4000);
  const auto bytes = static_cast<std::uint64_t>(database_.integer("PRAGMA page_count")) * 4096;
  Writer writer({.file = folder_.store(),
                 .commit_every = std::chrono::milliseconds(1),
                 .retry_max = std::chrono::milliseconds(1),
                 .retention = {.max_bytes = bytes + 40'960}});
  for (int i = 0; i < 5000; ++i) {
    ASSERT_TRUE(writer.add_score("robot-2", score_at(i), at_s(kHour * 900 + i)));
  }
  while (writer.queued() > 0 || !writer.healthy()) std::this_thread::yield();
  EXPECT_EQ(Archive(folder_.store()).scores("robot-2", at_s(0), at_s(5000), 10'000).size(), 5000U);
  EXPECT_LT(left().size(), 900U);
  EXPECT_LE(std::filesystem::file_size(folder_.store()), bytes + 40'960);
}

TEST_F(RetentionTest, AClockThatJumpsAheadDeletesNothing) {
  Writer writer({.file = folder_.store(),
                 .commit_every = std::chrono::milliseconds(1),
                 .segments = {.scores_per_robot = 10},
                 .retention = {.keep_scores = hours(1)}});
  for (int i = 0; i < 10; ++i) writer.add_score("robot-2", score_at(i), at_s(i));
  writer.flush().get();
  for (int i = 10; i < 60; ++i) {  // packs, and deletes, along with these
    writer.add_score("robot-2", score_at(i), at_s(48 * kHour + i));
    writer.flush().get();
  }
  EXPECT_GT(count("block"), 2);
  EXPECT_EQ(Archive(folder_.store()).scores("robot-2", at_s(0), at_s(60), 100).size(), 60U);
}

}  // namespace
}  // namespace kidnapwatch::storage
