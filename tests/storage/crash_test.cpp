// SPDX-License-Identifier: Apache-2.0
// kill -9 while writing: what was acknowledged is there afterwards.
#include <array>
#include <csignal>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "storage/archive.hpp"
#include "storage/sqlite.hpp"
#include "storage/upkeep.hpp"
#include "storage/writer.hpp"
#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {
namespace {

constexpr int kKills = 12;
constexpr int kScoresPerIncident = 20;
constexpr double kApart_s = 300;  // so that minutes and hours come to an end, too

/// Writes incident after incident with scores in between; tells each number once it is durable.
[[noreturn]] void write_for_ever(const std::filesystem::path& store, int first, int report) {
  Writer writer({.file = store,
                 .commit_every = std::chrono::milliseconds(1),
                 .segments = {.scores_per_robot = 50, .robots_per_commit = 1}});
  for (int number = first;; ++number) {
    for (int i = 0; i < kScoresPerIncident; ++i) {
      const double t = kApart_s * number + i / 100.0;
      writer.add_score("robot-" + std::to_string(i % 2), score_at(t), at_s(t));
    }
    writer.put_incident({.incident = incident_of(number),
                         .evidence = core::ScanPair{},
                         .alert = OutboxMessage{incident_id(number), "robot-1", "{}"}});
    writer.flush().get();
    if (::write(report, &number, sizeof number) != sizeof number) ::_exit(1);
  }
}

/// Lets a child write, kills it once it has acknowledged `enough` more incidents; returns the last
/// acknowledged number.
int kill_a_writer(const std::filesystem::path& store, int first, int enough) {
  std::array<int, 2> ends{};
  EXPECT_EQ(::pipe(ends.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) write_for_ever(store, first, ends[1]);
  ::close(ends[1]);
  int last = first - 1;
  int number = 0;
  while (last < first + enough && ::read(ends[0], &number, sizeof number) == sizeof number) {
    last = number;
  }
  ::kill(child, SIGKILL);
  while (::read(ends[0], &number, sizeof number) == sizeof number) last = number;
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return last;
}

/// The scores between two incidents, of both robots.
std::size_t scores_of(const Archive& archive, int number) {
  const auto from = at_s(kApart_s * number);
  const auto to = from + std::chrono::seconds(1);
  return archive.scores("robot-0", from, to, 100).size() +
         archive.scores("robot-1", from, to, 100).size();
}

/// Whether the robot's buckets are those of its scores.
bool are_summed_up(const Archive& archive, const std::string& robot, std::chrono::seconds width) {
  constexpr auto kBegin = core::Stamp::min();
  constexpr auto kEnd = core::Stamp::max();
  core::ScoreBuckets expected(width, 100'000);
  for (const auto& score : archive.scores(robot, kBegin, kEnd, 1'000'000)) expected.add(score);
  return archive.score_buckets(robot, kBegin, kEnd, width, 100'000) == expected.all();
}

TEST(Crash, NothingAcknowledgedIsLostOrDoubledAndTheFileIsIntact) {
  const StoreFolder folder;
  std::mt19937 random(3);
  std::vector<int> acknowledged;
  int next = 1;
  for (int kill = 0; kill < kKills; ++kill) {
    const int last = kill_a_writer(folder.store(), next, static_cast<int>(random() % 30));
    for (; next <= last; ++next) acknowledged.push_back(next);
    next = last + 2;  // the one after `last` may be there or not
    ASSERT_EQ(damage(folder.store(), std::chrono::minutes(1)), std::nullopt);
    Database database(folder.store(), Access::read_only);
    const auto incidents = database.integer("SELECT count(*) FROM incident");
    EXPECT_EQ(database.integer("SELECT count(*) FROM alert"), incidents);
    EXPECT_EQ(database.integer("SELECT count(*) FROM audit"), incidents);
    EXPECT_EQ(database.integer("SELECT count(*) FROM evidence_scan"), 2 * incidents);
  }
  const Writer writer({.file = folder.store()});
  const Archive archive(folder.store(), writer.recent());
  for (const int number : acknowledged) {
    EXPECT_EQ(scores_of(archive, number), kScoresPerIncident) << number;
    EXPECT_TRUE(archive.evidence(incident_id(number))) << number;
  }
  for (const auto width : {std::chrono::seconds(60), std::chrono::seconds(3600)}) {
    EXPECT_TRUE(are_summed_up(archive, "robot-0", width));
    EXPECT_TRUE(are_summed_up(archive, "robot-1", width));
  }
  EXPECT_GT(Database(folder.store(), Access::read_only).integer("SELECT count(*) FROM rollup"), 10);
  EXPECT_EQ(archive.broken_audit_entry(), std::nullopt);
  EXPECT_EQ(writer.quarantined(), std::nullopt);
}

}  // namespace
}  // namespace kidnapwatch::storage
