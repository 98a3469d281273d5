// SPDX-License-Identifier: Apache-2.0
// Poses form the group SE(2).
#include "core/pose.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace kidnapwatch::core {
namespace {

constexpr double kPi = std::numbers::pi;

void expect_near(const Pose& a, const Pose& b) {
  EXPECT_NEAR(a.x_m, b.x_m, 1e-9);
  EXPECT_NEAR(a.y_m, b.y_m, 1e-9);
  EXPECT_NEAR(wrapped(a.theta_rad - b.theta_rad), 0.0, 1e-9);
}

class Poses : public testing::Test {
 protected:
  Pose any() {
    std::uniform_real_distribution<double> metres(-50.0, 50.0);
    std::uniform_real_distribution<double> radians(-kPi, kPi);
    return {metres(random_), metres(random_), radians(random_)};
  }
  std::mt19937_64 random_{1};
};

TEST(Wrapped, LiesAboveMinusPiAndUpToPi) {
  EXPECT_DOUBLE_EQ(wrapped(kPi), kPi);
  EXPECT_DOUBLE_EQ(wrapped(-kPi), kPi);
  EXPECT_DOUBLE_EQ(wrapped(3.0 * kPi), kPi);
  EXPECT_DOUBLE_EQ(wrapped(1.5 * kPi), -0.5 * kPi);
  EXPECT_DOUBLE_EQ(wrapped(-1.5 * kPi), 0.5 * kPi);
  EXPECT_EQ(wrapped(0.25), 0.25);
}

TEST(Wrapped, KeepsTheDirection) {
  for (double angle_rad = -40.0; angle_rad < 40.0; angle_rad += 0.37) {
    const double in_range_rad = wrapped(angle_rad);
    EXPECT_GT(in_range_rad, -kPi);
    EXPECT_LE(in_range_rad, kPi);
    EXPECT_NEAR(std::cos(in_range_rad), std::cos(angle_rad), 1e-12);
    EXPECT_NEAR(std::sin(in_range_rad), std::sin(angle_rad), 1e-12);
  }
}

TEST(Pose, ComposesInTheFrameOfTheFirst) {
  expect_near(Pose{1.0, 2.0, kPi / 2.0} * Pose{3.0, 0.0, kPi / 2.0}, {1.0, 5.0, kPi});
}

TEST_F(Poses, FormAGroup) {
  for (int i = 0; i < 100; ++i) {
    const Pose a = any();
    const Pose b = any();
    const Pose c = any();
    expect_near((a * b) * c, a * (b * c));
    expect_near(a * Pose{}, a);
    expect_near(Pose{} * a, a);
    expect_near(a * inverse(a), {});
    expect_near(inverse(a) * a, {});
  }
}

TEST_F(Poses, KeepDistancesWhereverTheyAreSeenFrom) {
  for (int i = 0; i < 100; ++i) {
    const Pose a = any();
    const Pose b = any();
    const Pose from = any();
    EXPECT_NEAR(distance_m(from * a, from * b), distance_m(a, b), 1e-9);
  }
}

TEST(Distance, IsEuclidean) { EXPECT_DOUBLE_EQ(distance_m({1.0, 1.0, 0.0}, {4.0, 5.0, 2.0}), 5.0); }

}  // namespace
}  // namespace kidnapwatch::core
