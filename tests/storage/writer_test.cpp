// SPDX-License-Identifier: Apache-2.0
// Queue, group commits, and a disk that fails.
#include "storage/writer.hpp"

#include <csignal>
#include <numeric>
#include <thread>

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>

#include "storage/archive.hpp"
#include "storage/sqlite.hpp"
#include "tests/storage/fault_vfs.hpp"
#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {
namespace {

constexpr std::chrono::hours kNever{1};

class WriterTest : public testing::Test {
 protected:
  [[nodiscard]] std::size_t stored_scores(const std::string& robot = "robot-1") const {
    return Archive(folder_.store())
        .scores(robot, core::Stamp::min(), core::Stamp::max(), 1'000'000)
        .size();
  }
  [[nodiscard]] bool is_stored(int incident) const {
    return Archive(folder_.store()).incident(incident_id(incident)).has_value();
  }

  StoreFolder folder_;
};

TEST_F(WriterTest, ScoresAreThereAfterTheirCommit) {
  Writer writer({.file = folder_.store(), .commit_every = std::chrono::milliseconds(1)});
  ASSERT_TRUE(writer.add_score("robot-1", score_at(1), at_s(1.1)));
  while (writer.queued() > 0) std::this_thread::yield();
  EXPECT_EQ(stored_scores(), 1U);
  EXPECT_TRUE(writer.healthy());
  const auto commits = writer.commits();
  EXPECT_EQ(std::accumulate(commits.counts().begin(), commits.counts().end(), std::uint64_t{0}),
            1U);
  EXPECT_GT(commits.sum_s(), 0.0);
}

TEST_F(WriterTest, ScoresWaitForEachOther) {
  Writer writer({.file = folder_.store(), .commit_every = kNever});
  for (int i = 0; i < 10; ++i) writer.add_score("robot-1", score_at(i), at_s(i));
  EXPECT_EQ(writer.queued(), 10U);
  EXPECT_EQ(stored_scores(), 0U);
}

TEST_F(WriterTest, WhatIsLearnedReplacesWhatWas) {
  {
    Writer writer({.file = folder_.store(), .commit_every = kNever});
    writer.add_score("robot-1", score_at(1), at_s(1));
    writer.add_score("robot-2", score_at(1), at_s(1));
    writer.put_learned("robot-1", {1.0F, 2.0F});
    writer.flush().get();
    writer.put_learned("robot-1", {3.0F});
    writer.put_learned("robot-1", {4.0F, -0.5F, 1e-6F});
  }
  const auto robots = Archive(folder_.store()).robots(1);
  ASSERT_EQ(robots.size(), 2U);
  EXPECT_EQ(robots[0].learned, (std::vector{4.0F, -0.5F, 1e-6F}));
  EXPECT_TRUE(robots[1].learned.empty());
}

TEST_F(WriterTest, AnIncidentWaitsForNothingAndTakesTheScoresAlong) {
  Writer writer({.file = folder_.store(), .commit_every = kNever});
  writer.add_score("robot-1", score_at(1), at_s(1));
  writer.put_incident({.incident = incident_of(1)});
  while (!is_stored(1)) std::this_thread::yield();
  EXPECT_EQ(stored_scores(), 1U);
}

TEST_F(WriterTest, DestructionWritesWhatIsQueued) {
  {
    Writer writer({.file = folder_.store(), .commit_every = kNever});
    for (int i = 0; i < 100; ++i) writer.add_score("robot-1", score_at(i), at_s(i));
    writer.put_incident({.incident = incident_of(1)});
  }
  EXPECT_EQ(stored_scores(), 100U);
  EXPECT_TRUE(is_stored(1));
}

TEST_F(WriterTest, AConfigurationIsDurableWhenItsFutureIsReady) {
  Writer writer({.file = folder_.store(), .commit_every = kNever});
  const ConfigText config{.version = 1, .since = at_s(0), .author = "eve", .text = "{}"};
  writer.add_config(config).get();
  EXPECT_EQ(Archive(folder_.store()).latest_configs(), std::vector{config});
}

TEST_F(WriterTest, AVersionThatExistsIsRefusedAloneAndTheRestIsWritten) {
  Writer writer({.file = folder_.store(), .commit_every = kNever});
  writer.add_config({.version = 1, .since = at_s(0), .author = "eve", .text = "first"}).get();
  writer.add_score("robot-1", score_at(1), at_s(1));
  auto second = writer.add_config({.version = 1, .since = {}, .author = "", .text = "second"});
  EXPECT_THROW(second.get(), StorageError);
  EXPECT_TRUE(writer.healthy());
  EXPECT_EQ(stored_scores(), 1U);
  EXPECT_EQ(Archive(folder_.store()).latest_configs().at(0).text, "first");
}

TEST_F(WriterTest, RefusesNewerSchemas) {
  Writer({.file = folder_.store()}).flush().get();
  Database(folder_.store(), Access::read_write).execute("PRAGMA user_version = 99");
  EXPECT_THROW(Writer({.file = folder_.store()}), StorageError);
}

TEST_F(WriterTest, ASecondWriterIsRefused) {
  auto first = std::make_unique<Writer>(WriterConfig{.file = folder_.store()});
  EXPECT_THROW(Writer({.file = folder_.store()}), StorageError);
  first.reset();
  EXPECT_NO_THROW(Writer({.file = folder_.store()}));
}

TEST_F(WriterTest, AnOvertakenChangeOfAnIncidentChangesNothing) {
  Writer writer({.file = folder_.store()});
  auto incident = incident_of(1);
  incident.seq = 3;
  writer.put_incident({.incident = incident});
  auto older = incident;
  older.seq = 2;
  older.state = core::IncidentState::acknowledged;
  writer.put_incident({.incident = older});
  writer.flush().get();
  EXPECT_EQ(Archive(folder_.store()).incident(incident.id), incident);
}

class FaultyWriterTest : public WriterTest {
 protected:
  /// Waits for the thread to meet the fault.
  static void await_trouble(Writer& writer) {
    EXPECT_THROW(writer.flush().get(), StorageError);
    EXPECT_FALSE(writer.healthy());
    EXPECT_NE(writer.problem(), "");
  }

  static void await_health(const Writer& writer) {
    while (!writer.healthy() || writer.queued() > 0) std::this_thread::yield();
  }

  FaultyDisk disk_;
  const WriterConfig config_{.file = folder_.store(),
                             .commit_every = std::chrono::milliseconds(1),
                             .max_queued = 1000,
                             .retry_max = std::chrono::milliseconds(5)};
};

TEST_F(FaultyWriterTest, AFullDiskLosesNothingAndResumesByItself) {
  for (const int code : {SQLITE_FULL, SQLITE_IOERR_WRITE}) {
    Writer writer(config_);
    const auto before = stored_scores();
    disk_.let_writes_return(code);
    writer.add_score("robot-1", score_at(1), at_s(1));
    writer.put_incident({.incident = incident_of(code)});
    await_trouble(writer);
    for (int i = 2; i <= 100; ++i) EXPECT_TRUE(writer.add_score("robot-1", score_at(i), at_s(i)));
    await_trouble(writer);
    EXPECT_EQ(writer.queued(), 100U);
    disk_.let_writes_return(SQLITE_OK);
    await_health(writer);
    EXPECT_EQ(stored_scores() - before, 100U);
    EXPECT_TRUE(is_stored(code));
    EXPECT_EQ(writer.problem(), "");
  }
}

TEST_F(WriterTest, ALimitOfTheFileSizeIsAFullDiskToo) {
  Writer writer({.file = folder_.store(),
                 .commit_every = std::chrono::milliseconds(1),
                 .retry_max = std::chrono::milliseconds(5)});
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{.rlim_cur = 4096, .rlim_max = before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  writer.add_score("robot-1", score_at(1), at_s(1));
  EXPECT_THROW(writer.flush().get(), StorageError);
  EXPECT_FALSE(writer.healthy());
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_NO_THROW(writer.flush().get());
  EXPECT_TRUE(writer.healthy());
  EXPECT_EQ(stored_scores(), 1U);
}

TEST_F(FaultyWriterTest, AFailingSyncIsNoCommit) {
  Writer writer(config_);
  disk_.let_syncs_return(SQLITE_IOERR_FSYNC);
  writer.add_score("robot-1", score_at(1), at_s(1));
  await_trouble(writer);
  EXPECT_EQ(writer.queued(), 1U);
  disk_.let_syncs_return(SQLITE_OK);
  await_health(writer);
  EXPECT_EQ(stored_scores(), 1U);
}

TEST_F(FaultyWriterTest, MemoryIsBoundedAndEveryRefusalCounted) {
  Writer writer(config_);
  disk_.let_writes_return(SQLITE_FULL);
  writer.add_score("robot-1", score_at(0), at_s(0));
  await_trouble(writer);  // that score is out of the queue, and still counts
  std::size_t taken = 1;
  for (int i = 1; i < 5000; ++i) taken += writer.add_score("robot-1", score_at(i), at_s(i)) ? 1 : 0;
  EXPECT_EQ(taken, 1000U);
  EXPECT_EQ(writer.lost(), 4000U);
  EXPECT_EQ(writer.queued(), 1000U);
  disk_.let_writes_return(SQLITE_OK);
  await_health(writer);
  EXPECT_EQ(stored_scores(), 1000U);
}

TEST_F(FaultyWriterTest, ChangesBeyondTheBoundAreRefusedCountedAndTold) {
  auto config = config_;
  config.max_changes = 10;
  Writer writer(config);
  disk_.let_writes_return(SQLITE_FULL);
  writer.add_score("robot-1", score_at(0), at_s(0));
  await_trouble(writer);
  for (int i = 0; i < 24; ++i) writer.put_incident({.incident = incident_of(i)});
  writer.add_audit({.at = at_s(7), .actor = "eve", .action = "token.add"});
  for (int i = 0; i < 100; ++i) writer.confirm_delivery("event");  // forgotten
  EXPECT_EQ(writer.lost(), 15U);
  disk_.let_writes_return(SQLITE_OK);
  writer.flush().get();
  writer.flush().get();
  const Archive archive(folder_.store());
  EXPECT_EQ(archive.incidents({}).size(), 10U);
  const auto told = archive.audit(std::nullopt, 1).at(0).entry;
  EXPECT_EQ(told.action, "store.refused");
  EXPECT_EQ(told.detail, "15 records, the last one then");
  EXPECT_EQ(told.at, at_s(7));
}

TEST_F(FaultyWriterTest, AConfigurationIsToldAtOnceThatItFailedAndStaysUnwritten) {
  Writer writer(config_);
  disk_.let_writes_return(SQLITE_FULL);
  auto config = writer.add_config({.version = 1, .since = {}, .author = "eve", .text = "{}"});
  EXPECT_THROW(config.get(), StorageError);
  disk_.let_writes_return(SQLITE_OK);
  writer.flush().get();
  EXPECT_TRUE(Archive(folder_.store()).latest_configs().empty());
}

TEST_F(FaultyWriterTest, StopsEvenWhileTheDiskIsFull) {
  auto writer = std::make_unique<Writer>(config_);
  disk_.let_writes_return(SQLITE_FULL);
  writer->add_score("robot-1", score_at(1), at_s(1));
  await_trouble(*writer);
  writer.reset();
  disk_.let_writes_return(SQLITE_OK);
  EXPECT_EQ(stored_scores(), 0U);
}

TEST_F(FaultyWriterTest, ARobotFirstSeenDuringAFailureIsNamedAfterIt) {
  Writer writer(config_);
  disk_.let_writes_return(SQLITE_FULL);
  writer.add_score("robot-new", score_at(1), at_s(1));
  await_trouble(writer);
  disk_.let_writes_return(SQLITE_OK);
  await_health(writer);
  EXPECT_EQ(stored_scores("robot-new"), 1U);
}

}  // namespace
}  // namespace kidnapwatch::storage
