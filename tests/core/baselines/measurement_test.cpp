// SPDX-License-Identifier: Apache-2.0
// A scan is likeliest from where it was taken, by end points and by beams.
#include "core/baselines/measurement.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/sim/drive.hpp"
#include "tests/core/baselines/floors.hpp"

namespace kidnapwatch::core::baselines {
namespace {

BeamSubset chosen(const Scan& scan, const MeasurementConfig& config) {
  BeamSubset beams;
  choose_beams(scan, config, beams);
  return beams;
}

TEST(ChooseBeams, SpreadsThemOverTheValidOnes) {
  const float inf = std::numeric_limits<float>::infinity();
  Scan scan{{}, {0.0, 0.1, 0.1, 10.0}, {inf, 1.0F, 2.0F, NAN, 3.0F, 0.0F, 4.0F, 5.0F, 6.0F}, {}};
  MeasurementConfig config;
  config.beams = 3;
  EXPECT_EQ(chosen(scan, config).range_m, (std::vector<float>{1.0F, 3.0F, 5.0F}));
  config.beams = 6;
  EXPECT_EQ(chosen(scan, config).size(), 6U);
  config.beams = 60;
  EXPECT_EQ(chosen(scan, config).range_m, (std::vector<float>{1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F}));
  scan.ranges_m = {inf, NAN};
  EXPECT_EQ(chosen(scan, config).size(), 0U);
}

TEST(ChooseBeams, PutsEndPointsIntoTheBaseFrame) {
  const Scan scan{{}, {0.5 * std::numbers::pi, 0.1, 0.1, 10.0}, {2.0F}, {}};
  MeasurementConfig config;
  config.T_base_lidar = {0.2, 0.1, 0.5 * std::numbers::pi};
  const BeamSubset beams = chosen(scan, config);
  EXPECT_NEAR(beams.x_m[0], -1.8, 1e-6);
  EXPECT_NEAR(beams.y_m[0], 0.1, 1e-6);
}

/// One beam ahead of 2 m, a wall 3 m ahead of the origin, and one 1 m behind it.
struct OneBeam {
  GridMap map =
      rasterised(std::vector<Segment>{{3.0, -2.0, 3.0, 2.0}, {-1.0, -2.0, -1.0, 2.0}}, 0.1);
  Scan scan{{}, {0.0, 0.1, 0.1, 10.0}, {2.0F}, {}};

  [[nodiscard]] double likelihood(const MeasurementConfig& config, double x_m) const {
    const MeasuredMap measured(map, config);
    return std::exp(measured.log_likelihood({x_m, 0.0, 0.0}, chosen(scan, config)));
  }
};

TEST(MeasuredMap, HasTheLikelihoodFieldsGoldenValues) {
  MeasurementConfig config;
  config.hit_sd_m = 0.2;
  config.random_share = 0.1;
  const OneBeam beam;
  EXPECT_NEAR(beam.likelihood(config, 1.0), 1.0, 1e-5);
  EXPECT_NEAR(beam.likelihood(config, 0.8), 0.9 * std::exp(-0.5) + 0.1, 1e-5);
  EXPECT_NEAR(beam.likelihood(config, 0.6), 0.9 * std::exp(-2.0) + 0.1, 1e-5);
  EXPECT_NEAR(beam.likelihood(config, -50.0), 0.1, 1e-5);  // beyond the map
}

TEST(MeasuredMap, HasTheBeamModelsGoldenValues) {
  MeasurementConfig config;
  config.model = MeasurementModel::beam;
  config.hit_sd_m = 0.2;
  config.random_share = 0.1;
  config.short_share = 0.2;
  config.short_rate_per_m = 0.5;
  const OneBeam beam;
  EXPECT_NEAR(beam.likelihood(config, 1.2), 0.7 * std::exp(-0.5) + 0.1, 1e-5);  // 20 cm too far
  EXPECT_NEAR(beam.likelihood(config, 0.8), 0.7 * std::exp(-0.5) + 0.2 * std::exp(-1.0) + 0.1,
              1e-5);                                                            // 20 cm short
  EXPECT_NEAR(beam.likelihood(config, 3.9), 0.2 * std::exp(-1.0) + 0.1, 1e-5);  // no wall ahead
}

TEST(MeasuredMap, TakesTheGeometricMeanOfTheBeams) {
  const OneBeam one;
  MeasurementConfig config;
  const MeasuredMap measured(one.map, config);
  Scan scan = one.scan;
  scan.geometry.angle_increment_rad = 1e-9;
  scan.ranges_m = {2.0F, 2.2F};
  const double both = measured.log_likelihood({1.0, 0.0, 0.0}, chosen(scan, config));
  scan.ranges_m = {2.2F};
  const double second = measured.log_likelihood({1.0, 0.0, 0.0}, chosen(scan, config));
  EXPECT_NEAR(both, 0.5 * second, 1e-6);
}

TEST(MeasuredMap, ListsTheFreeCells) {
  const GridMap map = drawn({"?#.", "..?"}, 1.0);
  EXPECT_EQ(MeasuredMap(map, {}).free_cells(), (std::vector<std::size_t>{0, 1, 5}));
}

class BestPose : public ::testing::TestWithParam<MeasurementModel> {};

TEST_P(BestPose, IsTheTrueOne) {
  const sim::World world = sim::room_world();
  MeasurementConfig config;
  config.model = GetParam();
  const MeasuredMap measured(floor_of(world), config);
  sim::Drive drive(world, {}, 7, {});
  for (int i = 0; i < 20; ++i) {
    const RecordedScan recorded = drive.next(2.0);
    const BeamSubset beams = chosen(recorded.scan, config);
    const Pose& truth = *recorded.true_pose;
    const double here = measured.log_likelihood(truth, beams);
    EXPECT_GT(here, std::log(0.75));
    for (const Pose& off : {Pose{0.3, 0.0, 0.0}, Pose{-0.3, 0.0, 0.0}, Pose{0.0, 0.3, 0.0},
                            Pose{0.0, -0.3, 0.0}, Pose{0.0, 0.0, 0.2}, Pose{0.0, 0.0, -0.2}}) {
      EXPECT_LT(measured.log_likelihood(truth * off, beams), here);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Models, BestPose, ::testing::Values(MeasurementModel::likelihood_field, MeasurementModel::beam),
    [](const auto& model) { return model.param == MeasurementModel::beam ? "Beam" : "Field"; });

}  // namespace
}  // namespace kidnapwatch::core::baselines
