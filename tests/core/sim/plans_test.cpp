// SPDX-License-Identifier: Apache-2.0
// Floor plans become the walls, tours and poses that they show.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/sim/world.hpp"

namespace kidnapwatch::core::sim {
namespace {

TEST(WorldFromPlan, DrawsWhatThePlanShows) {
  constexpr std::array<std::string_view, 4> kPlan{
      "#####",
      "#a.1#",
      "#0.b#",
      "#####",
  };
  const World world = world_from_plan("small", kPlan, 1.0);
  EXPECT_EQ(world.name, "small");
  const std::vector<Wall> inner{
      {{1, 1}, {4, 1}}, {{1, 3}, {4, 3}}, {{1, 1}, {1, 3}}, {{4, 1}, {4, 3}}};
  for (const Wall& wall : inner) {
    EXPECT_EQ(std::count(world.walls.begin(), world.walls.end(), wall), 1);
  }
  EXPECT_EQ(world.walls.size(), inner.size());  // nothing is seen of the outside
  ASSERT_EQ(world.elsewhere.size(), 2U);
  EXPECT_EQ(world.elsewhere[0], (Pose{1.5, 1.5, 0.0}));
  EXPECT_NEAR(world.elsewhere[1].theta_rad, 0.2 * std::numbers::pi, 1e-12);
  ASSERT_FALSE(world.path.empty());
  EXPECT_EQ(world.path.back(), (Point{1.5, 2.5}));  // the tour ends where it began
}

TEST(WorldFromPlan, MakesOneWallOfAStraightFront) {
  constexpr std::array<std::string_view, 3> kPlan{"....", ".##.", "...."};
  EXPECT_EQ(world_from_plan("block", kPlan, 0.5).walls.size(), 4U + 4U);  // and the plan's edge
}

class AWorld : public ::testing::TestWithParam<World> {};

TEST_P(AWorld, HasATourOfShortFreeLegs) {
  const World& world = GetParam();
  for (std::size_t i = 0; i < world.path.size(); ++i) {
    const Point from = world.path[i];
    const Point to = world.path[(i + 1) % world.path.size()];
    EXPECT_LE(std::hypot(to.x_m - from.x_m, to.y_m - from.y_m), 1.0 + 1e-9);
    for (double share = 0.0; share < 1.0; share += 0.05) {
      const Point at{from.x_m + share * (to.x_m - from.x_m),
                     from.y_m + share * (to.y_m - from.y_m)};
      EXPECT_GE(clearance_m(world, at), 0.35) << at.x_m << ", " << at.y_m;
    }
  }
}

TEST_P(AWorld, HasFreePosesElsewhereFarFromEachOther) {
  const World& world = GetParam();
  EXPECT_GE(world.elsewhere.size(), 6U);
  for (const Pose& pose : world.elsewhere) {
    EXPECT_GE(clearance_m(world, {pose.x_m, pose.y_m}), 0.2);
    double farthest_m = 0.0;
    for (const Pose& other : world.elsewhere) {
      farthest_m = std::max(farthest_m, distance_m(pose, other));
    }
    EXPECT_GE(farthest_m, 5.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Worlds, AWorld, ::testing::Values(corridor_world(), room_world()),
                         [](const auto& world) { return world.param.name; });

class APaperWorld : public AWorld {};

TEST_P(APaperWorld, HasAFreeTourAndOnePoseFarFromItsBeginning) {
  const World& world = GetParam();
  ASSERT_EQ(world.elsewhere.size(), 1U);
  const Pose there = world.elsewhere.front();
  EXPECT_GE(clearance_m(world, {there.x_m, there.y_m}), 0.9);
  EXPECT_GE(std::hypot(there.x_m - world.path.back().x_m, there.y_m - world.path.back().y_m), 5.0);
  for (const Point& at : world.path) EXPECT_GE(clearance_m(world, at), 0.9);
}

INSTANTIATE_TEST_SUITE_P(Worlds, APaperWorld,
                         ::testing::Values(turns_world(), tee_world(), ring_world()),
                         [](const auto& world) { return world.param.name; });

TEST(RingWorld, LooksTheSameFromEverywhereOnItsTour) {
  const World ring = ring_world();
  const Fan fan(360);
  const Pose start{4.0, 0.0, 0.5 * std::numbers::pi};
  const auto here = sweep(ring, start, fan, 3.5);
  const auto there = sweep(ring, ring.elsewhere.front(), fan, 3.5);
  for (std::size_t i = 0; i < here.size(); ++i) {
    if (std::isinf(here[i]) || std::isinf(there[i])) continue;  // one is just out of reach
    EXPECT_NEAR(here[i], there[i], 1e-6);
  }
}

}  // namespace
}  // namespace kidnapwatch::core::sim
