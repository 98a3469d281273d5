// SPDX-License-Identifier: Apache-2.0
// Configuration and tuning through the real service: in force at once, and after a crash.
#include <csignal>

#include <gtest/gtest.h>

#include "tests/e2e/stack.hpp"

namespace kidnapwatch::test {
namespace {

class Configuration : public ::testing::Test {
 protected:
  void start() {
    stack_.start_service();
    stack_.await_ready();
    ASSERT_TRUE(eventually([&] {
      stack_.publish("kidnapwatch/v1/r1/scan", "no scan, but the robot is known by it");
      return stack_.status_of("/api/v1/robots/r1") == 200;
    }));
  }

  Stack stack_;
  const std::string fleet_ = "/api/v1/config";
  const std::string r1_ = "/api/v1/robots/r1/config";
};

TEST_F(Configuration, OfARobotOutlivesACrash) {
  start();
  EXPECT_EQ(stack_.ask("PUT", fleet_, R"({"threshold":60,"resync_scans":9})").at("version"), 1);
  EXPECT_EQ(stack_.ask("PUT", r1_, R"({"threshold":70})").at("version"), 2);
  EXPECT_EQ(stack_.ask("PATCH", fleet_, R"({"threshold":null})").at("version"), 3);
  EXPECT_TRUE(eventually([&] {  // with its next scan, even a bad one
    stack_.publish("kidnapwatch/v1/r1/scan", "no scan");
    return stack_.get("/api/v1/robots/r1").value("threshold", 0.0) == 70.0;
  }));
  stack_.service->signal(SIGKILL);
  (void)stack_.service->wait();
  start();
  const Json kept = stack_.get(r1_);
  EXPECT_EQ(kept.at("version"), 3);
  EXPECT_EQ(kept.at("origins").at("threshold"), "robot");
  EXPECT_EQ(kept.at("origins").at("resync_scans"), "fleet");
  EXPECT_EQ(stack_.ask("POST", "/api/v1/config/history/1/restore", "{}").at("version"), 4);
  EXPECT_EQ(stack_.get(fleet_).at("effective").at("threshold"), 60.0);
  EXPECT_EQ(stack_.ask("DELETE", r1_, "").at("effective").at("threshold"), 60.0);
  EXPECT_EQ(stack_.get("/api/v1/config/history").at("changes").size(), 5U);
}

TEST_F(Configuration, IsTunedByWhatWasStored) {
  stack_.start_service();
  stack_.await_ready();
  (void)stack_.robots({"simulate", "--robots", "1", "--rate", "5", "--duration", "30",
                       "--kidnap-every", "25", "--speed", "10"});
  ASSERT_TRUE(
      eventually([&] { return stack_.get("/api/v1/incidents").at("incidents").size() == 1; }));
  const auto robot =
      stack_.get("/api/v1/incidents").at("incidents").at(0).at("robotId").get<std::string>();
  const std::string preview = "/api/v1/thresholds:preview";
  ASSERT_TRUE(eventually([&] {  // until all scores are stored
    return stack_.post(preview, R"({"threshold":4.5})").at("kept") == 1;
  }));
  EXPECT_EQ(stack_.post(preview, R"({"threshold":1000})").at("lost"), 1);
  EXPECT_TRUE(stack_.post("/api/v1/thresholds:calibrate", R"({"falseAlarmRate":0.001})")
                  .contains("threshold"));
  EXPECT_EQ(stack_.get("/api/v1/evaluation/roc").at("status"), 409);
  const std::string scores = "/api/v1/robots/" + robot + "/scores";
  const Json bucket = stack_.get(scores + "?resolution=86400").at("buckets").at(0);
  EXPECT_GT(bucket.at("motionConfirmed").at("max"), 4.5);
  EXPECT_EQ(bucket.at("state"), "kidnapped");
}

}  // namespace
}  // namespace kidnapwatch::test
