// SPDX-License-Identifier: Apache-2.0
// What is missing is told: after a crash, after an overload; and only then.
#include <csignal>
#include <thread>

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include "storage/archive.hpp"
#include "storage/writer.hpp"
#include "tests/storage/fault_vfs.hpp"
#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {
namespace {

class GapTest : public testing::Test {
 protected:
  void write(double from_s, double to_s) const {
    Writer writer({.file = folder_.store()});
    write(writer, from_s, to_s);
  }
  static void write(Writer& writer, double from_s, double to_s) {
    for (double t = from_s; t < to_s; ++t) writer.add_score("robot-1", score_at(t), at_s(t));
    writer.flush().get();
  }
  /// In a process that is killed when it has written them.
  void write_and_die(double from_s, double to_s) const {
    const pid_t child = ::fork();
    if (child == 0) {
      Writer writer({.file = folder_.store()});
      write(writer, from_s, to_s);
      ::raise(SIGKILL);
    }
    ::waitpid(child, nullptr, 0);
  }
  [[nodiscard]] std::vector<Gap> gaps() const { return Archive(folder_.store()).gaps(); }

  StoreFolder folder_;
};

TEST_F(GapTest, AStopInOrderLeavesNone) {
  write(1, 4);
  write(10, 14);
  EXPECT_TRUE(gaps().empty());
}

TEST_F(GapTest, ACrashLeavesOneUpToTheNextScore) {
  write(1, 4);
  write_and_die(10, 14);
  write(20, 21);
  write(30, 31);
  EXPECT_EQ(gaps(), std::vector{(Gap{at_s(13), at_s(20), "crash"})});
}

TEST_F(GapTest, EachCrashLeavesItsOwn) {
  write_and_die(1, 2);
  write_and_die(3, 4);
  write(5, 6);
  EXPECT_EQ(gaps(), (std::vector{Gap{at_s(1), at_s(3), "crash"}, Gap{at_s(3), at_s(5), "crash"}}));
}

TEST_F(GapTest, ScoresThatWereRefusedAreCountedInOne) {
  FaultyDisk disk;
  Writer writer(
      {.file = folder_.store(), .max_queued = 10, .retry_max = std::chrono::milliseconds(1)});
  disk.let_writes_return(SQLITE_FULL);
  for (int i = 0; i < 25; ++i) writer.add_score("robot-1", score_at(i), at_s(i));
  EXPECT_EQ(writer.lost(), 15U);
  disk.let_writes_return(SQLITE_OK);
  while (writer.queued() > 0 || !writer.healthy()) std::this_thread::yield();
  writer.add_score("robot-1", score_at(30), at_s(30));
  writer.flush().get();
  EXPECT_EQ(gaps(), std::vector{(Gap{at_s(10), at_s(24), "overload", 15})});
}

}  // namespace
}  // namespace kidnapwatch::storage
