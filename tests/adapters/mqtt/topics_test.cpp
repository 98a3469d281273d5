// SPDX-License-Identifier: Apache-2.0
// Topics built, taken apart, and refused.
#include "adapters/mqtt/topics.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "core/bad_input.hpp"
#include "core/robot.hpp"

namespace kidnapwatch::adapters::mqtt {
namespace {

const Topics kTopics({.prefix = "kidnapwatch/v1",
                      .scan_filters = {"+/scan", "fleet/+/front/laser"}});

void expect_parsed(std::string_view topic, TopicKind kind, std::string_view robot = "") {
  const Topic parsed = kTopics.parse(topic);
  EXPECT_EQ(parsed.kind, kind) << topic;
  EXPECT_EQ(parsed.robot, robot) << topic;
}

TEST(Topics, AreNamedAsDocumented) {
  EXPECT_EQ(kTopics.scan("r1"), "kidnapwatch/v1/r1/scan");
  EXPECT_EQ(kTopics.odom("r1"), "kidnapwatch/v1/r1/odom");
  EXPECT_EQ(kTopics.particles("r1"), "kidnapwatch/v1/r1/particles");
  EXPECT_EQ(kTopics.alert("r1"), "kidnapwatch/v1/r1/alert");
  EXPECT_EQ(kTopics.state("r1"), "kidnapwatch/v1/r1/state");
  EXPECT_EQ(kTopics.score("r1"), "kidnapwatch/v1/r1/score");
  EXPECT_EQ(kTopics.command("r1"), "kidnapwatch/v1/r1/command");
  EXPECT_EQ(kTopics.service_status(), "kidnapwatch/v1/service/status");
}

TEST(Topics, AreSubscribedToWhole) {
  EXPECT_EQ(kTopics.filters(),
            (std::vector<std::string>{"kidnapwatch/v1/#", "+/scan", "fleet/+/front/laser"}));
}

TEST(Topics, TellKindAndRobot) {
  expect_parsed("kidnapwatch/v1/r1/scan", TopicKind::scan, "r1");
  expect_parsed("kidnapwatch/v1/r:1.a-B_/odom", TopicKind::odom, "r:1.a-B_");
  expect_parsed("kidnapwatch/v1/r1/particles", TopicKind::particles, "r1");
  expect_parsed("kidnapwatch/v1/service/command", TopicKind::command, "service");
}

TEST(Topics, KnowTheirOwn) {
  for (const char* topic : {"kidnapwatch/v1/r1/alert", "kidnapwatch/v1/r1/state",
                            "kidnapwatch/v1/r1/score", "kidnapwatch/v1/r1/response",
                            "kidnapwatch/v1/r1/response/ann", "kidnapwatch/v1/service/status"}) {
    expect_parsed(topic, TopicKind::own);
  }
}

TEST(Topics, AnswerNowhereInAnothersName) {
  for (const char* topic : {"kidnapwatch/v1/r1/response", "kidnapwatch/v1/r1/response/ann",
                            "ann/answers", "kidnapwatch/v2/r1/alert"}) {
    EXPECT_TRUE(kTopics.may_answer("r1", topic)) << topic;
  }
  for (const char* topic :
       {"", "kidnapwatch/v1/r1/alert", "kidnapwatch/v1/r2/response", "kidnapwatch/v1/r1/responses",
        "kidnapwatch/v1/service/status", "kidnapwatch/v1/"}) {
    EXPECT_FALSE(kTopics.may_answer("r1", topic)) << topic;
  }
}

TEST(Topics, ReadRobotsFromFurtherFilters) {
  expect_parsed("r7/scan", TopicKind::scan, "r7");
  expect_parsed("fleet/r7/front/laser", TopicKind::scan, "r7");
  expect_parsed("r7/b/scan", TopicKind::unknown);
  expect_parsed("fleet/front/laser", TopicKind::unknown);
  expect_parsed("fleet/r7/rear/laser", TopicKind::unknown);
}

TEST(Topics, RefuseRobotIdsThatAreNone) {
  expect_parsed("kidnapwatch/v1//scan", TopicKind::bad_robot_id);
  expect_parsed("kidnapwatch/v1/r 1/scan", TopicKind::bad_robot_id);
  expect_parsed("kidnapwatch/v1/r\xC3\xA9/odom", TopicKind::bad_robot_id);
  expect_parsed("kidnapwatch/v1/" + std::string(65, 'r') + "/scan", TopicKind::bad_robot_id);
  expect_parsed("/scan", TopicKind::bad_robot_id);
}

TEST(Topics, CallTheRestUnknown) {
  for (const char* topic :
       {"", "/", "kidnapwatch/v1", "kidnapwatch/v1/", "kidnapwatch/v1/r1", "kidnapwatch/v1/r1/",
        "kidnapwatch/v1/r1/map", "kidnapwatch/v1/r1/scan/x", "kidnapwatch/v2/r1/scan",
        "kidnapwatch/v1x/r1/scan", "$SYS/r1/scan"}) {
    expect_parsed(topic, TopicKind::unknown);
  }
}

TEST(Topics, RefusePrefixesThatCannotBe) {
  for (const char* prefix : {"", "/", "a/", "/a", "a/+", "#", "a/#/b", "$SYS", "a\nb"}) {
    EXPECT_THROW(Topics({.prefix = prefix, .scan_filters = {}}), core::BadInput) << prefix;
  }
}

TEST(Topics, RefuseFiltersThatNameNoRobot) {
  for (const char* filter : {"", "scan", "+/+/scan", "r+/scan", "+r/scan", "+/#", "#", "a/+\n"}) {
    EXPECT_THROW(Topics({.prefix = "p", .scan_filters = {filter}}), core::BadInput) << filter;
  }
}

RC_GTEST_PROP(Topics, NeverNameARobotThatIsNone, (const std::string& robot)) {
  const Topic parsed = kTopics.parse(kTopics.scan(robot));
  RC_ASSERT((parsed.kind == TopicKind::scan) == core::is_robot_id(robot));
}

RC_GTEST_PROP(Topics, SurviveAnything, (const std::string& topic)) {
  const Topic parsed = kTopics.parse(topic);
  RC_ASSERT(parsed.robot.empty() || core::is_robot_id(parsed.robot));
}

}  // namespace
}  // namespace kidnapwatch::adapters::mqtt
