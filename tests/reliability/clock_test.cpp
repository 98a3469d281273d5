// SPDX-License-Identifier: Apache-2.0
// A clock that jumps: no false incident, no robot called silent, and the operator is told.
#include <chrono>
#include <fstream>
#include <thread>

#include "tests/reliability/promise.hpp"

namespace kidnapwatch::test {
namespace {

constexpr const char* kLibrary = "/usr/lib/x86_64-linux-gnu/faketime/libfaketimeMT.so.1";

class ClockJump : public Promise, public ::testing::WithParamInterface<const char*> {
 protected:
  /// The service's wall clock goes on from here, off by `offset`.
  void set_clock(const std::string& offset) const {
    const auto unfinished = file_.string() + ".new";
    std::ofstream(unfinished) << offset << "\n";
    std::filesystem::rename(unfinished, file_);
  }
  void drive(int seed) {
    const Json sent = stack_.robots({"simulate", "--robots", "3", "--rate", "5", "--duration", "60",
                                     "--speed", "10", "--seed", std::to_string(seed)});
    sent_ += sent.at("scans").get<std::uint64_t>();
    EXPECT_TRUE(eventually([&] { return stack_.counted() >= sent_; }));
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "clock";
  std::uint64_t sent_ = 0;
};

TEST_P(ClockJump, InventsNoIncidentAndIsTold) {
  if (!std::string(KW_SANITIZED).empty() || !std::filesystem::exists(kLibrary)) {
    GTEST_SKIP() << "libfaketime is absent, or cannot be loaded before a sanitizer";
  }
  set_clock("+0");
  stack_.under = {"env", std::string("LD_PRELOAD=") + kLibrary, "FAKETIME_NO_CACHE=1",
                  "FAKETIME_DONT_FAKE_MONOTONIC=1", "FAKETIME_TIMESTAMP_FILE=" + file_.string()};
  stack_.subscribe("kidnapwatch/v1/+/state");
  start_service();
  drive(1);
  EXPECT_EQ(degraded(), std::set<std::string>{});
  set_clock(GetParam());
  EXPECT_TRUE(eventually([&] { return degraded().contains("clock"); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(600));  // two looks for silent robots
  drive(2);
  for (const auto& message : stack_.received()) {
    EXPECT_EQ(message.payload.find("stale"), std::string::npos) << message.payload;
  }
  EXPECT_EQ(number("SELECT count(*) FROM incident"), 0);
  const Json scores = stack_.get("/api/v1/robots/sim-0001/scores?limit=1000").at("scores");
  EXPECT_GT(scores.size(), 500U);
  std::string before;
  for (const auto& score : scores) {
    const std::string stamp = score.at("time");
    EXPECT_LT(before, stamp);
    before = stamp;
  }
  EXPECT_EQ(stack_.status_of("/readyz"), 200);
}

INSTANTIATE_TEST_SUITE_P(BackAndAhead, ClockJump, ::testing::Values("-3600", "+172800"));

}  // namespace
}  // namespace kidnapwatch::test
