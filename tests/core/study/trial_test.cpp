// SPDX-License-Identifier: Apache-2.0
// A trial repeats, and its kidnappings leave no trace but the scans.
#include "core/study/trial.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace kidnapwatch::core::study {
namespace {

const TrialConfig kShort{.steps = 10};

TEST(Trial, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const Trial one = drive(sim::tee_world(), kShort, 7);
  const Trial again = drive(sim::tee_world(), kShort, 7);
  const Trial other = drive(sim::tee_world(), kShort, 8);
  for (std::size_t t = 0; t < kShort.steps; ++t) {
    EXPECT_EQ(one.run[t].scan.ranges_m, again.run[t].scan.ranges_m);
    EXPECT_EQ(one.after[t].scan.ranges_m, again.after[t].scan.ranges_m);
    EXPECT_NE(one.run[t].scan.ranges_m, other.run[t].scan.ranges_m);
  }
}

TEST(Trial, GoesOnElsewhere) {
  const sim::World world = sim::tee_world();
  const Trial trial = drive(world, kShort, 1);
  EXPECT_LT(distance_m(*trial.after.front().true_pose, world.elsewhere.front()), 0.3);
  EXPECT_GT(distance_m(*trial.run.front().true_pose, world.elsewhere.front()), 5.0);
}

TEST(Trial, HasThePapersNoise) {
  const Trial trial = drive(sim::tee_world(), kShort, 1);
  EXPECT_EQ(trial.run.front().scan.ranges_m.size(), 360U);
  double squares = 0.0;
  std::size_t beams = 0;
  for (const RecordedScan& recorded : trial.run) {
    const float side_m = recorded.scan.ranges_m[90];  // the wall is 1 m to the left
    squares += (side_m - 1.0F) * (side_m - 1.0F);
    ++beams;
  }
  EXPECT_NEAR(squares / static_cast<double>(beams), 0.1, 0.1);
}

TEST(KidnappedAt, LeavesNoTraceButTheScans) {
  const Trial trial = drive(sim::turns_world(), kShort, 2);
  for (const std::size_t t_k : {std::size_t{2}, std::size_t{5}, kShort.steps}) {
    const Recording run = kidnapped_at(trial, t_k);
    ASSERT_EQ(run.scans.size(), kShort.steps);
    for (std::size_t t = 1; t <= kShort.steps; ++t) {
      const RecordedScan& scan = run.scans[t - 1];
      EXPECT_EQ(scan.scan.stamp, trial.run[t - 1].scan.stamp);
      EXPECT_EQ(scan.scan.ranges_m,
                t < t_k ? trial.run[t - 1].scan.ranges_m : trial.after[t - t_k].scan.ranges_m);
    }
    const Pose off = inverse(*trial.run[t_k - 1].scan.odometry) * *run.scans[t_k - 1].scan.odometry;
    EXPECT_LT(std::hypot(off.x_m, off.y_m, off.theta_rad), 1e-12);
  }
}

}  // namespace
}  // namespace kidnapwatch::core::study
