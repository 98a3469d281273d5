// SPDX-License-Identifier: Apache-2.0
// Detectors asked for by name, and what they say of a robot's scans.
#include "service/other_detectors.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "core/sim/drive.hpp"
#include "core/sim/world.hpp"

namespace kidnapwatch::service {
namespace {

using Names = std::vector<std::string>;

core::DetectionConfig asking_for(Names detectors) {
  core::DetectionConfig config;
  config.detectors = std::move(detectors);
  return config;
}

Names names(const std::vector<core::DetectorScore>& scores) {
  Names found;
  for (const auto& one : scores) found.emplace_back(core::name(one.detector));
  return found;
}

/// What they say of the second of two scans, between which particles come.
std::vector<core::DetectorScore> second_scores(OtherDetectors& others) {
  const core::sim::World world = core::sim::room_world();
  core::sim::Drive drive(world, {}, 1, core::Stamp{});
  EXPECT_TRUE(others.observe(drive.next(0.2).scan).empty());
  others.take_particles({0.5, 0.5});
  return others.observe(drive.next(0.2).scan);
}

TEST(OtherDetectorsTest, SayNothingUnlessTheyAreAsked) {
  OtherDetectors none{core::DetectionConfig{}};
  EXPECT_TRUE(second_scores(none).empty());
}

TEST(OtherDetectorsTest, SpeakInTheOrderOfTheirNumbersAndLeaveOutTheAlarmsOwn) {
  OtherDetectors others(asking_for({"ndt_qe", "qs2ddtw", "1ddtw", "ndt_qo"}));
  EXPECT_EQ(names(second_scores(others)), (Names{"1ddtw", "ndt_qe", "ndt_qo"}));
}

TEST(OtherDetectorsTest, AreAllThatHaveAName) {
  const Names all(core::kDetectorNames.begin(), core::kDetectorNames.end());
  core::DetectionConfig config = asking_for(all);
  config.dissimilarity.gate = core::Gate::never;
  OtherDetectors others(config);
  auto said = names(second_scores(others));
  said.insert(std::ranges::find(said, "s2ddtw"), "2ddtw");  // the alarm's own
  EXPECT_EQ(said, all);
}

TEST(OtherDetectorsTest, ScoreTheParticlesThatCameSinceTheLastScan) {
  OtherDetectors others(asking_for({"mcw", "me"}));
  EXPECT_TRUE(others.need_particles());
  EXPECT_TRUE(others.observe({}).empty());
  others.take_particles({0.25, 0.5});
  const auto scores = others.observe({});
  ASSERT_EQ(names(scores), (Names{"mcw", "me"}));
  EXPECT_EQ(scores[0].score, 0.5F);
  EXPECT_NEAR(scores[1].score, -(1 / 3.0 * std::log(1 / 3.0) + 2 / 3.0 * std::log(2 / 3.0)), 1e-6);
  EXPECT_TRUE(others.observe({}).empty());
}

TEST(OtherDetectorsTest, NeedNoParticlesForOtherScores) {
  EXPECT_FALSE(OtherDetectors(asking_for({"ndt_qs"})).need_particles());
}

}  // namespace
}  // namespace kidnapwatch::service
