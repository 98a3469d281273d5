// SPDX-License-Identifier: Apache-2.0
// A run as a whole: started where it is told, errors as far as there are true poses.
#include "core/baselines/localization.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/sim/drive.hpp"
#include "tests/core/baselines/floors.hpp"

namespace kidnapwatch::core::baselines {
namespace {

std::vector<RecordedScan> tour(std::size_t scans) {
  static const sim::World world = sim::room_world();
  sim::Drive drive(world, {}, 3, {});
  std::vector<RecordedScan> recorded;
  while (recorded.size() < scans) recorded.push_back(drive.next(0.2));
  return recorded;
}

const MeasuredMap& room() {
  static const MeasuredMap map(floor_of(sim::room_world()), {});
  return map;
}

TEST(Localized, FollowsARunFromItsStartOrFromAnywhere) {
  const auto scans = tour(40);
  for (const auto& start : {scans.front().true_pose, std::optional<Pose>{}}) {
    const Localization localization = localized(scans, Mcl(room(), {}, 1), start);
    ASSERT_EQ(localization.size(), scans.size());
    const auto found = errors(localization, scans);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->scans, 40U);
    EXPECT_LT(found->median_m, 0.05);
    EXPECT_LT(found->median_rad, 0.02);
    EXPECT_GT(median_max_current_weight(localization), 0.9);
  }
}

TEST(Localized, OfNoScansIsNothing) {
  const Localization nothing = localized({}, Mcl(room(), {}, 1), {});
  EXPECT_TRUE(nothing.empty());
  EXPECT_FALSE(errors(nothing, {}));
  EXPECT_TRUE(std::isnan(median_max_current_weight(nothing)));
}

TEST(LocalizationErrors, AreQuantilesOverTheScansWithTruthAndEstimate) {
  Localization localization;
  std::vector<RecordedScan> scans;
  for (int i = 0; i < 100; ++i) {
    MclUpdate update;
    update.T_map_base = {1.0 + 0.01 * i, 5.0, 0.1};
    localization.emplace_back(update);
    scans.push_back({{}, Pose{1.0, 5.0, 0.3}});
  }
  localization.emplace_back(std::nullopt);
  scans.push_back({{}, Pose{}});
  localization.emplace_back(MclUpdate{});
  scans.push_back({{}, std::nullopt});
  const auto found = errors(localization, scans);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->scans, 100U);
  EXPECT_NEAR(found->median_m, 0.50, 1e-12);
  EXPECT_NEAR(found->q95_m, 0.95, 1e-12);
  EXPECT_NEAR(found->largest_m, 0.99, 1e-12);
  EXPECT_NEAR(found->last_m, 0.99, 1e-12);
  EXPECT_NEAR(found->median_rad, 0.2, 1e-12);
}

}  // namespace
}  // namespace kidnapwatch::core::baselines
