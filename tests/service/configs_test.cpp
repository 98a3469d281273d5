// SPDX-License-Identifier: Apache-2.0
// Three levels of configuration: what is in force for whom, and what is refused.
#include "service/configs.hpp"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::service {
namespace {

using api::Json;

class ConfigsTest : public ::testing::Test {
 protected:
  Configs::Outside outside() {
    return {.now = [] { return core::stamp_from_ns(7); },
            .save =
                [this](const api::ConfigChange& change) {
                  if (refuse_to_save_) throw std::runtime_error("disk full");
                  saved_.push_back(change);
                }};
  }
  /// Of the version that is in force.
  api::ConfigView put(const std::string& robot, const Json& values) {
    return configs_.put(robot, values, configs_.in_force(robot)->version, "ann");
  }
  std::string refused(const std::string& robot, const Json& values) {
    try {
      (void)put(robot, values);
    } catch (const core::BadInput& error) {
      return error.what();
    }
    return "";
  }

  bool refuse_to_save_ = false;
  std::vector<api::ConfigChange> saved_;
  Configs configs_{{.stale_after_s = 3.0}, {}, outside()};
};

TEST_F(ConfigsTest, LaysRobotOverFleetOverDefaults) {
  put("", {{"threshold", 60}, {"resync_scans", 9U}});
  put("r1", {{"threshold", 70}, {"calibration", {{"window_pairs", 500U}}}});
  const auto r1 = configs_.in_force("r1")->config;
  EXPECT_EQ(r1.threshold, 70.0);
  EXPECT_EQ(r1.resync_scans, 9U);
  EXPECT_EQ(r1.stale_after_s, 3.0);
  EXPECT_EQ(r1.calibration.window_pairs, 500U);
  EXPECT_EQ(r1.calibration.warmup_pairs, core::CalibrationConfig{}.warmup_pairs);
  EXPECT_EQ(configs_.in_force("r2")->config.threshold, 60.0);
  EXPECT_EQ(configs_.window_pairs(), core::CalibrationConfig{}.window_pairs);
}

TEST_F(ConfigsTest, AFleetsChangeReachesRobotsThatSetOthers) {
  put("r1", {{"threshold", 70}});
  put("", {{"resync_scans", 9U}});
  EXPECT_EQ(configs_.in_force("r1")->config.resync_scans, 9U);
  EXPECT_EQ(configs_.in_force("r1")->version, 2);  // so that nobody overwrites it unseen
  EXPECT_THROW(configs_.put("r1", Json::object(), 1, "late"), api::VersionConflict);
}

TEST_F(ConfigsTest, ARobotsChangeIsNoneOfTheOthers) {
  put("", {{"threshold", 60}});
  EXPECT_EQ(put("r1", {{"threshold", nullptr}}).effective.version, 2);
  EXPECT_EQ(configs_.in_force("r1")->config.threshold, std::nullopt);
  EXPECT_EQ(configs_.in_force("r2")->version, 1);
  EXPECT_EQ(put("r1", Json::object()).effective.config.threshold, 60.0);  // inherits again
}

TEST_F(ConfigsTest, ShowsTheLevelsThatItCameFrom) {
  put("", {{"threshold", 60}});
  put("r1", {{"resync_scans", 9U}});
  const auto view = configs_.view("r1");
  EXPECT_EQ(view.fleet, (Json{{"threshold", 60}}));
  EXPECT_EQ(view.robot, (Json{{"resync_scans", 9U}}));
  EXPECT_EQ(view.effective.author, "ann");
  EXPECT_EQ(configs_.view("").robot, Json::object());
  EXPECT_EQ(configs_.view("r2").robot, Json::object());
}

TEST_F(ConfigsTest, NamesTheMemberAndTheRobotThatAChangeWouldBreak) {
  put("r1", {{"calibration", {{"warmup_pairs", 300U}}}});
  EXPECT_EQ(refused("r2", {{"threshold", -1}}),
            "threshold: must be finite and above 0, or null to calibrate it");
  EXPECT_EQ(refused("", {{"calibration", {{"window_pairs", 200U}}}}),
            "calibration.warmup_pairs: must be from 20 to window_pairs, by what is set for robot "
            "r1");
  EXPECT_EQ(refused("", {{"colour", "red"}}), "colour: is not a known member");
  EXPECT_EQ(saved_.size(), 1U);
  EXPECT_EQ(configs_.in_force("")->version, 0);
}

TEST_F(ConfigsTest, IsInForceOnlyOnceItIsSaved) {
  refuse_to_save_ = true;
  EXPECT_THROW(put("", {{"threshold", 60}}), std::runtime_error);
  EXPECT_EQ(configs_.in_force("")->config.threshold, std::nullopt);
}

TEST_F(ConfigsTest, TakesUpWhatWasSaved) {
  put("", {{"threshold", 60}});
  put("r1", {{"threshold", 70}});
  const Configs again({}, saved_, outside());
  EXPECT_EQ(again.in_force("")->config.threshold, 60.0);
  EXPECT_EQ(again.in_force("r1")->config.threshold, 70.0);
  EXPECT_EQ(again.in_force("r1")->version, 2);
}

TEST_F(ConfigsTest, OfManyWhoSawTheSameVersionOneWins) {
  std::atomic<int> won = 0;
  std::vector<std::thread> rivals;
  rivals.reserve(4);
  for (int i = 0; i < 4; ++i) {
    rivals.emplace_back([&] {
      try {
        (void)configs_.put("", {{"threshold", 60}}, 0, "rival");
        ++won;
      } catch (const api::VersionConflict&) {
      }
    });
  }
  for (auto& rival : rivals) rival.join();
  EXPECT_EQ(won, 1);
}

}  // namespace
}  // namespace kidnapwatch::service
