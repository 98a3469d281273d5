// SPDX-License-Identifier: Apache-2.0
// Learning what odometry gets wrong.
#include "core/wheel_model.hpp"

#include <random>

#include <gtest/gtest.h>

namespace kidnapwatch::core {
namespace {

/// Drives with changing speed; `seen` makes the lidar's motion of the wheels' and the one before.
template <class Seen>
WheelModel driven(Seen seen, int pairs = 400) {
  WheelModel model;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> speed(0.0, 0.1);
  std::uniform_real_distribution<double> turn(-0.2, 0.2);
  Pose before;
  for (int i = 0; i < pairs; ++i) {
    const Pose motion{speed(random), 0.0, turn(random)};
    const Wheels wheels{motion, 1.0, before, 1.0};
    model.learn(wheels, seen(motion, before));
    before = motion;
  }
  return model;
}

TEST(WheelModel, ExpectsWhatIsToldBeforeItLearned) {
  const Pose motion{0.1, 0.02, 0.3};
  EXPECT_EQ(WheelModel{}.expected({motion, 1.0, {}, 1.0}), motion);
}

TEST(WheelModel, LearnsTheLeverArmOfTheSensor) {
  const Pose sensor{0.4, -0.1, 0.0};
  const WheelModel model =
      driven([&](const Pose& motion, const Pose&) { return inverse(sensor) * motion * sensor; });
  EXPECT_NEAR(model.going()[2], 0.4, 0.03);
  EXPECT_NEAR(model.going()[3], -0.1, 0.03);
  const Pose turn{0.05, 0.0, 0.2};
  EXPECT_LT(distance_m(model.expected({turn, 1.0, turn, 1.0}), inverse(sensor) * turn * sensor),
            0.01);
}

TEST(WheelModel, LearnsLateOdometry) {
  const WheelModel model = driven([](const Pose& motion, const Pose& before) {
    return Pose{0.5 * (motion.x_m + before.x_m), 0.0, 0.5 * (motion.theta_rad + before.theta_rad)};
  });
  EXPECT_NEAR(model.turning()[1], 0.5, 0.05);
  EXPECT_NEAR(model.going()[1], 0.5, 0.1);
}

TEST(WheelModel, LearnsTheSizeOfTheWheels) {
  const WheelModel model = driven([](const Pose& motion, const Pose&) {
    return Pose{0.9 * motion.x_m, 0.0, 1.1 * motion.theta_rad};
  });
  EXPECT_NEAR(model.turning()[0], 0.1, 0.02);
  EXPECT_NEAR(model.going()[0], -0.1, 0.03);
}

TEST(WheelModel, IsHardlyMovedByASlip) {
  WheelModel model = driven([](const Pose& motion, const Pose&) { return motion; });
  model.learn({{0.5, 0.0, 0.0}, 1.0, {}, 1.0}, {});
  EXPECT_NEAR(model.going()[0], 0.0, 0.02);
}

}  // namespace
}  // namespace kidnapwatch::core
