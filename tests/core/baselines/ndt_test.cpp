// SPDX-License-Identifier: Apache-2.0
// NDT: its derivatives, and that it finds the motions between scans of simulated rooms.
#include "core/baselines/ndt.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/sim/drive.hpp"

namespace kidnapwatch::core::baselines {
namespace {

/// What a 360-beam lidar of 8 m reach sees from a pose in a world, without noise or with.
Cloud seen(const sim::World& world, const Pose& pose, double noise_sd_m = 0.0,
           std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  Normal normal;
  const sim::Fan fan(360);
  const auto ranges_m = sim::sweep(world, pose, fan, 8.0);
  Cloud points;
  for (std::size_t i = 0; i < ranges_m.size(); ++i) {
    if (std::isinf(ranges_m[i])) continue;
    const double range_m = ranges_m[i] + noise_sd_m * normal(random);
    points.x.push_back(range_m * fan.directions[i].x_m);
    points.y.push_back(range_m * fan.directions[i].y_m);
  }
  return points;
}

const Pose kBefore{4.0, 3.0, 0.4};  // in the furnished room

TEST(NormalDistributions, HaveTheDerivativesOfTheirObjective) {
  const sim::World world = sim::room_world();
  const NormalDistributions reference(seen(world, kBefore), {});
  const Cloud points = seen(world, kBefore * Pose{0.1, 0.05, 0.08}, 0.02);
  const Pose at{0.07, 0.02, 0.05};
  constexpr double kStep = 1e-6;
  const auto moved = [&](std::size_t axis, double by) {
    Pose pose = at;
    (axis == 0 ? pose.x_m : axis == 1 ? pose.y_m : pose.theta_rad) += by;
    return pose;
  };
  for (const double widening : {1.0, 4.0}) {
    const NdtFit fit = reference.fit(points, at, widening);
    EXPECT_DOUBLE_EQ(fit.objective, reference.objective(points, at, widening));
    for (std::size_t i = 0; i < 3; ++i) {
      const NdtFit high = reference.fit(points, moved(i, kStep), widening);
      const NdtFit low = reference.fit(points, moved(i, -kStep), widening);
      const double slope = (high.objective - low.objective) / (2.0 * kStep);
      EXPECT_NEAR(fit.gradient[i], slope, 1e-4 * (1.0 + std::abs(slope)));
      for (std::size_t j = 0; j < 3; ++j) {
        const double bend = (high.gradient[j] - low.gradient[j]) / (2.0 * kStep);
        EXPECT_NEAR(fit.hessian[3 * i + j], bend, 1e-3 * (10.0 + std::abs(bend)));
      }
    }
  }
}

TEST(Ndt, LeavesAScanWhereItIs) {
  const Cloud points = seen(sim::room_world(), kBefore);
  const NdtMatch found = match(NormalDistributions(points, {}), points, {}, {});
  EXPECT_TRUE(found.converged);
  EXPECT_LT(distance_m(found.T_before_now, {}), 0.01);
  EXPECT_LT(std::abs(found.T_before_now.theta_rad), 0.005);
  EXPECT_GT(found.mean_likelihood, 0.4);
}

/// Whether NDT finds `truth` from "did not move", to 3 cm and 0.02 rad.
bool finds(const sim::World& world, const NormalDistributions& reference, const Pose& before,
           const Pose& truth, std::uint64_t seed) {
  const NdtMatch found = match(reference, seen(world, before * truth, 0.01, seed), {}, {});
  const Pose off = inverse(truth) * found.T_before_now;
  return std::hypot(off.x_m, off.y_m) < 0.03 && std::abs(off.theta_rad) < 0.02;
}

/// How far the guess may be off for the motion to be found, as measured: 0.1 m and 0.1 rad always,
/// 0.2 m and 0.2 rad 646 times of 648.
TEST(Ndt, FindsMotionsWithinItsBasin) {
  const sim::World world = sim::room_world();
  std::uint64_t tried = 0;
  std::uint64_t found = 0;
  for (const Pose& before : {kBefore, Pose{2.5, 5.5, 2.0}, Pose{9.0, 4.2, -1.0}}) {
    const NormalDistributions reference(seen(world, before, 0.01), {});
    for (const double away_m : {0.0, 0.1, 0.2}) {
      for (const double turn_rad : {-0.2, -0.1, 0.0, 0.1, 0.2}) {
        for (int direction = 0; direction < 12; ++direction) {
          const double bearing_rad = direction * std::numbers::pi / 6.0;
          const Pose truth{away_m * std::cos(bearing_rad), away_m * std::sin(bearing_rad),
                           turn_rad};
          const bool is_found = finds(world, reference, before, truth, ++tried);
          found += static_cast<std::uint64_t>(is_found);
          if (away_m < 0.15 && std::abs(turn_rad) < 0.15) {
            EXPECT_TRUE(is_found) << away_m << " m towards " << bearing_rad << ", " << turn_rad;
          }
        }
      }
    }
  }
  EXPECT_GE(found, tried * 98 / 100) << "of " << tried;
}

TEST(Ndt, StaysWhereOdometryPutItWhereNothingFits) {
  const Cloud here = seen(sim::room_world(), kBefore);
  Cloud far = here;
  for (double& x : far.x) x += 100.0;
  const NdtMatch found = match(NormalDistributions(here, {}), far, {}, {});
  EXPECT_EQ(found.mean_likelihood, 0.0);
  EXPECT_EQ(found.T_before_now, Pose{});
}

TEST(Ndt, TakesCellsOfOnePlace) {
  Cloud same;
  same.x.assign(30, 1.0);
  same.y.assign(30, 2.0);
  const NdtMatch found = match(NormalDistributions(same, {}), same, {}, {});
  EXPECT_NEAR(found.mean_likelihood, 1.0, 1e-6);  // the floor keeps the variances positive
}

}  // namespace
}  // namespace kidnapwatch::core::baselines
