// SPDX-License-Identifier: Apache-2.0
// MCW and ME as detectors: of our own filter at a kidnapping, and of streamed weights.
#include "core/baselines/particle_detectors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/baselines/particle_scores.hpp"
#include "core/sim/drive.hpp"
#include "tests/core/baselines/floors.hpp"

namespace kidnapwatch::core::baselines {
namespace {

TEST(MclDetectors, SeeAKidnappingInTheirRoom) {
  const sim::World world = sim::room_world();
  const MeasuredMap map(floor_of(world), {});
  sim::Drive drive(world, {}, 5, Stamp{});
  const auto detectors = mcl_detectors(map, {.particles = 500}, 1, drive.true_pose());
  ASSERT_EQ(detectors.size(), 2U);
  double lowest = 1.0;
  for (int i = 0; i < 25; ++i) {
    const Scan scan = drive.next(0.4).scan;
    lowest = std::min(lowest, *detectors[0]->observe(scan));
    EXPECT_TRUE(detectors[1]->observe(scan));
  }
  drive.kidnap_far();
  const Scan scan = drive.next(0.4).scan;
  EXPECT_LT(*detectors[0]->observe(scan), lowest);
  EXPECT_EQ(detectors[0]->polarity(), Polarity::lptf);
  EXPECT_EQ(detectors[1]->name(), "me");
}

TEST(MclDetectors, NeedOdometryAndABeam) {
  const sim::World world = sim::room_world();
  const MeasuredMap map(floor_of(world), {});
  sim::Drive drive(world, {}, 5, Stamp{});
  const auto detectors = mcl_detectors(map, {.particles = 100}, 1, std::nullopt);
  Scan scan = drive.next(0.4).scan;
  Scan without = scan;
  without.odometry.reset();
  EXPECT_FALSE(detectors[0]->observe(without));
  Scan blind = drive.next(0.4).scan;
  std::ranges::fill(blind.ranges_m, 0.0F);
  EXPECT_FALSE(detectors[0]->observe(blind));
  EXPECT_TRUE(detectors[0]->observe(drive.next(0.4).scan));  // it found somewhere to start
}

TEST(ParticleDetectors, ScoreTheWeightsThatCameWithTheScan) {
  const auto stream = std::make_shared<StreamedWeights>();
  const auto detectors = particle_detectors(stream, Polarity::hptf);
  const Scan scan;
  EXPECT_FALSE(detectors[0]->observe(scan));
  const std::vector weights{0.1, 0.4, 0.2};
  stream->take(weights);
  EXPECT_EQ(detectors[0]->observe(scan), max_current_weight(weights));
  EXPECT_EQ(detectors[1]->observe(scan), measurement_entropy(weights));
  EXPECT_EQ(detectors[1]->polarity(), Polarity::hptf);
  EXPECT_FALSE(detectors[0]->observe(scan));  // nothing new came
}

TEST(ParticleDetectors, TakeNoWeightsThatAreNone) {
  const auto stream = std::make_shared<StreamedWeights>();
  const auto detectors = particle_detectors(stream);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const auto& weights : {std::vector{0.0, 0.0}, std::vector{-1.0, 2.0}, std::vector<double>{},
                              std::vector{std::nan(""), 1.0}, std::vector{infinity}}) {
    stream->take(weights);
    for (const auto& detector : detectors) EXPECT_FALSE(detector->observe({}));
  }
}

}  // namespace
}  // namespace kidnapwatch::core::baselines
