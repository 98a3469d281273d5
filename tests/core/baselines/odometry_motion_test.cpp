// SPDX-License-Identifier: Apache-2.0
// Motions scatter as the noise says, around what odometry says.
#include "core/baselines/odometry_motion.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace kidnapwatch::core::baselines {
namespace {

constexpr OdometryNoise kNoiseless{0.0, 0.0, 0.0, 0.0, 0.0, 0.0};

Pose moved(const Pose& before, const Pose& motion, const OdometryNoise& noise = kNoiseless) {
  std::mt19937_64 random(1);
  Normal normal;
  return OdometryMotion(motion, noise).drawn(before, random, normal);
}

TEST(OdometryMotion, WithoutNoiseIsTheMotion) {
  const Pose before{1.0, -2.0, 3.0};
  for (const Pose& motion : {Pose{0.3, 0.1, 0.4}, Pose{-0.2, 0.0, 0.0}, Pose{0.0, 0.0, -3.0},
                             Pose{0.1, -0.4, 3.1}, Pose{}}) {
    const Pose expected = before * motion;
    const Pose found = moved(before, motion);
    EXPECT_NEAR(distance_m(found, expected), 0.0, 1e-12);
    EXPECT_NEAR(wrapped(found.theta_rad - expected.theta_rad), 0.0, 1e-12);
  }
}

TEST(MotionBetween, IsTheChangeOfOdometry) {
  Scan before;
  Scan now;
  EXPECT_EQ(motion_between(before, now), Pose{});
  before.odometry = Pose{3.0, 1.0, 0.5 * std::numbers::pi};
  EXPECT_EQ(motion_between(before, now), Pose{});
  now.odometry = Pose{3.0, 2.0, 0.5 * std::numbers::pi + 0.1};
  const Pose moved = motion_between(before, now);
  EXPECT_NEAR(distance_m(moved, {1.0, 0.0, 0.0}), 0.0, 1e-12);
  EXPECT_NEAR(moved.theta_rad, 0.1, 1e-12);
}

struct Scatter {
  double along_m = 0.0;
  double heading_rad = 0.0;
};

/// Standard deviations after `motion` from the origin.
Scatter scatter(const Pose& motion, const OdometryNoise& noise) {
  constexpr int kDraws = 20'000;
  std::mt19937_64 random(2);
  Normal normal;
  const OdometryMotion model(motion, noise);
  Scatter squares;
  for (int i = 0; i < kDraws; ++i) {
    const Pose pose = model.drawn({}, random, normal);
    const double along_m = std::hypot(pose.x_m, pose.y_m) - std::hypot(motion.x_m, motion.y_m);
    const double off_rad = wrapped(pose.theta_rad - motion.theta_rad);
    squares.along_m += along_m * along_m;
    squares.heading_rad += off_rad * off_rad;
  }
  return {std::sqrt(squares.along_m / kDraws), std::sqrt(squares.heading_rad / kDraws)};
}

TEST(OdometryMotion, ScattersByItsAlphas) {
  OdometryNoise noise = kNoiseless;
  noise.alpha3 = 0.04;  // 20 % of the way
  EXPECT_NEAR(scatter({2.0, 0.0, 0.0}, noise).along_m, 0.4, 0.01);
  EXPECT_NEAR(scatter({2.0, 0.0, 0.0}, noise).heading_rad, 0.0, 1e-12);
  noise = kNoiseless;
  noise.alpha1 = 0.01;  // 10 % of the turn
  EXPECT_NEAR(scatter({0.0, 0.0, 0.8}, noise).heading_rad, 0.08, 0.002);
  noise = kNoiseless;
  noise.alpha2 = 0.01;  // both turns, 0.1 rad per metre each
  EXPECT_NEAR(scatter({1.0, 0.0, 0.0}, noise).heading_rad, 0.1 * std::numbers::sqrt2, 0.004);
  noise = kNoiseless;
  noise.alpha4 = 0.01;
  EXPECT_NEAR(scatter({1.0, 0.0, 0.5}, noise).along_m, 0.05, 0.002);
}

TEST(OdometryMotion, TakesBackingUpForNoTurn) {
  OdometryNoise noise = kNoiseless;
  noise.alpha1 = 0.04;
  EXPECT_NEAR(scatter({-1.0, 0.0, 0.0}, noise).heading_rad, 0.0, 1e-9);
}

TEST(OdometryMotion, ScattersALittleEvenAtRest) {
  OdometryNoise noise = kNoiseless;
  noise.least_m = 0.02;
  noise.least_rad = 0.01;
  const Scatter found = scatter({}, noise);
  EXPECT_NEAR(found.along_m, 0.02, 0.001);
  EXPECT_NEAR(found.heading_rad, 0.01 * std::numbers::sqrt2, 0.001);
}

}  // namespace
}  // namespace kidnapwatch::core::baselines
