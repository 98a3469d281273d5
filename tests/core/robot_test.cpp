// SPDX-License-Identifier: Apache-2.0
// Names of robots and of their states.
#include "core/robot.hpp"

#include <string>

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::core {
namespace {

TEST(RobotState, IsFoundByItsName) {
  EXPECT_EQ(robot_state("unknown", "state"), RobotState::unknown);
  EXPECT_EQ(robot_state("normal", "state"), RobotState::normal);
  EXPECT_EQ(robot_state("suspect", "state"), RobotState::suspect);
  EXPECT_EQ(robot_state("kidnapped", "state"), RobotState::kidnapped);
  EXPECT_EQ(robot_state("degraded", "state"), RobotState::degraded);
  EXPECT_EQ(robot_state("stale", "state"), RobotState::stale);
}

TEST(RobotState, ComesBackFromItsName) {
  for (const auto state : {RobotState::unknown, RobotState::normal, RobotState::suspect,
                           RobotState::kidnapped, RobotState::degraded, RobotState::stale}) {
    EXPECT_EQ(robot_state(name(state), "state"), state);
  }
}

TEST(RobotState, OfAnotherNameNamesTheFieldAndWhatIsAllowed) {
  try {
    (void)robot_state("Normal", "robots.state");
    FAIL() << "nothing was thrown";
  } catch (const BadInput& error) {
    EXPECT_STREQ(error.what(),
                 "robots.state: must be one of unknown, normal, suspect, kidnapped, degraded, "
                 "stale");
  }
}

TEST(IsRobotId, TakesLettersDigitsAndFourSigns) {
  for (const auto* id : {"r", "amr-07", "AMR_7.left:front", "0", "..", "Zz9:_-."}) {
    EXPECT_TRUE(is_robot_id(id)) << id;
  }
  EXPECT_TRUE(is_robot_id(std::string(64, 'x')));
}

TEST(IsRobotId, RefusesWhatWouldBreakTopicsPathsAndLogs) {
  for (const auto* id :
       {"", "a/b", "a b", "#", "+", "a\nb", "r\xc3\xb6", "a%2f", "$SYS", "@", "["}) {
    EXPECT_FALSE(is_robot_id(id)) << id;
  }
  EXPECT_FALSE(is_robot_id(std::string_view("a\0b", 3)));
  EXPECT_FALSE(is_robot_id(std::string(65, 'x')));
}

}  // namespace
}  // namespace kidnapwatch::core
