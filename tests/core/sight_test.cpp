// SPDX-License-Identifier: Apache-2.0
// What people are shown is what the detectors computed.
#include "core/sight.hpp"

#include <gtest/gtest.h>

#include "core/dissimilarity.hpp"
#include "tests/core/walls.hpp"

namespace kidnapwatch::core {
namespace {

DetectionConfig exact() {
  DetectionConfig config;
  config.dissimilarity.precision = Precision::f64;
  return config;
}

ScanPair scans(const Pose& motion) {
  const Pose from{4.0, 2.0, 0.3};
  return {seen_from(furnished_room(), from), seen_from(furnished_room(), from * motion)};
}

TEST(Sight, TheWarpingIsThatOfTheScore) {
  const auto pair = scans({0.3, 0.1, 0.2});
  for (const Gate gate : {Gate::never, Gate::always}) {
    for (const Dimension dimension : {Dimension::points, Dimension::ranges}) {
      auto config = exact();
      config.dissimilarity.gate = gate;
      config.dissimilarity.dimension = dimension;
      const auto score = dissimilarity(pair.before, pair.after, config.dissimilarity);
      const auto warping = sight(pair, config).warping;
      ASSERT_TRUE(warping);
      EXPECT_NEAR(warping->cost, score.cost, 1e-9 * score.cost);
      EXPECT_EQ(warping->standardized, score.standardized);
    }
  }
}

TEST(Sight, StepsNameBeamsAlsoWhereSomeHitNothing) {
  auto pair = scans({});
  pair.before.ranges_m[0] = pair.after.ranges_m[0] = 0.0F;
  pair.before.ranges_m[7] = pair.after.ranges_m[7] = 0.0F;
  const auto warping = sight(pair, exact()).warping;
  ASSERT_TRUE(warping);
  EXPECT_EQ(warping->cost, 0.0);
  ASSERT_EQ(warping->steps.size(), 358U);
  EXPECT_EQ(warping->steps.front(), (WarpingStep{1, 1, 0.0}));
  EXPECT_EQ(warping->steps[6], (WarpingStep{8, 8, 0.0}));
}

TEST(Sight, TheMotionSeenIsTheTrueOneAndTheToldOneThatOfTheWheels) {
  const Pose motion{0.3, 0.1, 0.2};
  auto pair = scans(motion);
  EXPECT_FALSE(sight(pair, exact()).motion->told);
  pair.before.odometry = Pose{1.0, 1.0, 0.0};
  pair.after.odometry = Pose{1.28, 1.1, 0.19};
  const auto seen = sight(pair, exact()).motion;
  ASSERT_TRUE(seen && seen->told);
  EXPECT_NEAR(seen->told->x_m, 0.28, 1e-9);
  EXPECT_LT(distance_m(seen->seen, motion), 0.01);
  EXPECT_NEAR(seen->seen.theta_rad, motion.theta_rad, 0.01);
}

TEST(Sight, MarksTheBeamsThatContradict) {
  ScanPair pair{round_room(2.0, at_s(0.0), 120), round_room(4.0, at_s(0.2), 120)};
  const auto motion = sight(pair, exact()).motion;
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->violating_before.size(), 120U);
  EXPECT_TRUE(motion->violating_after.empty());
}

TEST(Sight, ScansOfTooManyBeamsAreNotWarped) {
  ScanPair pair{round_room(2.0, at_s(0.0), 5000), round_room(2.0, at_s(0.2), 5000)};
  EXPECT_FALSE(sight(pair, exact()).warping);
}

}  // namespace
}  // namespace kidnapwatch::core
