// SPDX-License-Identifier: Apache-2.0
// Monte Carlo localization follows real robots. Skipped where the logs are absent.
#include "core/baselines/localization.hpp"

#include <cmath>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "adapters/logs/grid_map.hpp"
#include "adapters/logs/log.hpp"
#include "core/baselines/mapping.hpp"

namespace kidnapwatch::core::baselines {
namespace {

namespace logs = adapters::logs;

const std::filesystem::path kData(KW_DATA);

MeasurementConfig lidar_ahead(double x_m) {
  MeasurementConfig config;
  config.T_base_lidar.x_m = x_m;
  return config;
}

/// CMU's Wean Hall with the map that came with it. Its poses are another filter's on the same map,
/// confirmed backwards in time to 0.15-0.20 m: no truth, but not ours either.
class WeanHall : public ::testing::TestWithParam<int> {
 protected:
  [[nodiscard]] static Recording run(int number) {
    return logs::read_log(kData / "cmu_wean" /
                          ("cmu_wean_robotdata" + std::to_string(number) + ".scan.gz"))
        .recording;
  }
};

TEST_P(WeanHall, IsFollowedFromAKnownStart) {
  const auto file = kData / "cmu_wean" / "original" / "wean.dat.gz";
  if (!exists(file)) GTEST_SKIP() << "no logs at " << kData;
  const Recording recording = run(GetParam());
  const MeasuredMap map(logs::read_grid_map(file), lidar_ahead(0.25));
  const auto& start = recording.scans.front().true_pose;
  const auto found = errors(localized(recording.scans, Mcl(map, {}, 1), start), recording.scans);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->scans, recording.scans.size());
  EXPECT_LE(found->median_m, 0.3);
  EXPECT_LE(found->largest_m, 1.0);
  EXPECT_LE(found->median_rad, 0.03);
}

INSTANTIATE_TEST_SUITE_P(Runs, WeanHall, ::testing::Values(1, 3, 4, 5));

TEST(WeanHallMap, IsMadeByAnotherRunAsWell) {
  const auto directory = kData / "cmu_wean";
  if (!exists(directory)) GTEST_SKIP() << "no logs at " << kData;
  const auto mapped = logs::read_log(directory / "cmu_wean_robotdata1.scan.gz").recording;
  std::vector<Pose> poses;
  for (const RecordedScan& recorded : mapped.scans) poses.push_back(*recorded.true_pose);
  MappingConfig mapping;
  mapping.T_base_lidar.x_m = 0.25;
  const MeasuredMap map(map_from(mapped.scans, poses, mapping), lidar_ahead(0.25));
  const auto run = logs::read_log(directory / "cmu_wean_robotdata4.scan.gz").recording;
  const auto found =
      errors(localized(run.scans, Mcl(map, {}, 1), run.scans.front().true_pose), run.scans);
  ASSERT_TRUE(found);
  EXPECT_LE(found->median_m, 0.3);
}

/// Without any pose to compare with: filters that start anywhere, and share nothing but map and
/// scans, agree where the robot is.
TEST(OlinFloor, IsFoundFromAnywhereByIndependentFilters) {
  const auto directory = kData / "tb4_rplidar_olin";
  if (!exists(directory)) GTEST_SKIP() << "no logs at " << kData;
  const auto run = logs::read_log(directory / "tb4_rplidar_olin.scan.gz").recording;
  const MeasuredMap map(logs::read_grid_map(directory / "original" / "mac_1st_floor_final.yaml"),
                        lidar_ahead(0.004));
  MclConfig config;
  config.relocalization = Relocalization::global;
  const auto one = localized(run.scans, Mcl(map, config, 1), std::nullopt);
  const auto other = localized(run.scans, Mcl(map, config, 2), std::nullopt);
  EXPECT_GT(one.back()->max_current_weight, 0.5);
  EXPECT_LT(distance_m(one.back()->T_map_base, other.back()->T_map_base), 0.2);
}

}  // namespace
}  // namespace kidnapwatch::core::baselines
