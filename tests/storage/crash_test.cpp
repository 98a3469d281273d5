// SPDX-License-Identifier: Apache-2.0
// kill -9 while writing: what was acknowledged is there afterwards.
#include <array>
#include <csignal>
#include <random>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "storage/archive.hpp"
#include "storage/upkeep.hpp"
#include "storage/writer.hpp"
#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {
namespace {

constexpr int kKills = 10;
constexpr int kScoresPerIncident = 20;

/// Writes incident after incident with scores in between; tells each number once it is durable.
[[noreturn]] void write_for_ever(const std::filesystem::path& store, int first, int report) {
  Writer writer({.file = store, .commit_every = std::chrono::milliseconds(1)});
  for (int number = first;; ++number) {
    for (int i = 0; i < kScoresPerIncident; ++i) {
      const double t = number + i / 100.0;
      writer.add_score("robot-1", score_at(t), at_s(t));
    }
    writer.put_incident({.incident = incident_of(number), .evidence = core::ScanPair{}});
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

TEST(Crash, NothingAcknowledgedIsLostAndTheFileIsIntact) {
  const StoreFolder folder;
  std::mt19937 random(3);
  int last = 0;
  for (int kill = 0; kill < kKills; ++kill) {
    last = kill_a_writer(folder.store(), last + 2, std::uniform_int_distribution(1, 30)(random));
    ASSERT_EQ(damage(folder.store(), std::chrono::minutes(1)), std::nullopt);
    const Archive archive(folder.store());
    const auto newest = archive.incidents({.limit = 1000});
    ASSERT_FALSE(newest.empty());
    EXPECT_GE(newest.front().id, incident_id(last));
    for (int number = last; number > last - 2; --number) {
      EXPECT_EQ(archive.scores("robot-1", at_s(number), at_s(number + 1), 100).size(),
                kScoresPerIncident);
      EXPECT_TRUE(archive.evidence(incident_id(number)));
    }
  }
  const Writer writer({.file = folder.store()});
  EXPECT_EQ(writer.quarantined(), std::nullopt);
}

}  // namespace
}  // namespace kidnapwatch::storage
