// SPDX-License-Identifier: Apache-2.0
// Many writers and readers at once, for the thread sanitizer above all.
#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "storage/archive.hpp"
#include "storage/writer.hpp"
#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {
namespace {

constexpr int kLanes = 3;
constexpr int kReaders = 4;
constexpr std::size_t kScores = 4000;

void drive(Writer& writer, int lane) {
  const auto robot = "robot-" + std::to_string(lane);
  for (int i = 0; i < static_cast<int>(kScores); ++i) {
    EXPECT_TRUE(writer.add_score(robot, score_at(i), at_s(i)));
    if (i % 1000 == 0) {
      writer.put_incident(
          {.incident = incident_of(lane * 1000 + i / 1000, robot), .evidence = core::ScanPair{}});
    }
  }
}

/// Reads until told to stop: what was seen once stays.
void look(const Archive& archive, const std::atomic<bool>& stop) {
  std::size_t scores = 0;
  std::size_t incidents = 0;
  while (!stop) {
    const auto found = archive.scores("robot-1", at_s(0), at_s(kScores), kScores);
    EXPECT_GE(found.size(), scores);
    scores = found.size();
    EXPECT_TRUE(scores == 0 || found.back() == score_at(static_cast<double>(scores) - 1));
    const auto listed = archive.incidents({.limit = 1000}).size();
    EXPECT_GE(listed, incidents);
    incidents = listed;
  }
}

TEST(Concurrency, ReadersSeeEveryLanesScoresInOrderWhileTheyAreWritten) {
  const StoreFolder folder;
  Writer writer({.file = folder.store(),
                 .commit_every = std::chrono::milliseconds(2),
                 .segments = {.scores_per_robot = 100, .robots_per_commit = 1}});
  const Archive archive(folder.store(), writer.recent());
  std::atomic<bool> stop = false;
  std::vector<std::thread> readers;
  readers.reserve(kReaders);
  for (int i = 0; i < kReaders; ++i) readers.emplace_back([&] { look(archive, stop); });
  std::vector<std::thread> lanes;
  lanes.reserve(kLanes);
  for (int i = 0; i < kLanes; ++i) lanes.emplace_back([&, i] { drive(writer, i); });
  for (auto& lane : lanes) lane.join();
  writer.flush().get();
  stop = true;
  for (auto& reader : readers) reader.join();
  for (int i = 0; i < kLanes; ++i) {
    const auto robot = "robot-" + std::to_string(i);
    EXPECT_EQ(archive.scores(robot, at_s(0), at_s(kScores), 2 * kScores).size(), kScores);
    EXPECT_EQ(archive.incidents({.robot = robot}).size(), kScores / 1000);
  }
}

}  // namespace
}  // namespace kidnapwatch::storage
