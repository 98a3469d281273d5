// SPDX-License-Identifier: Apache-2.0
// Commands to incidents, read.
#include "adapters/codecs/command_json.hpp"

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

core::IncidentCommand command(const char* action, const char* body) {
  return incident_command(action, parsed(body, "body"));
}

std::string refused(const char* action, const char* body) {
  try {
    (void)command(action, body);
  } catch (const core::BadInput& error) {
    return error.field();
  }
  return "";
}

TEST(CommandJson, ReadsEveryAction) {
  using enum core::IncidentAction;
  EXPECT_EQ(command("ack", "{}").action, ack);
  EXPECT_EQ(command("unack", "{}").action, unack);
  EXPECT_EQ(command("resolve", R"({"comment":"back"})").comment, "back");
  EXPECT_EQ(command("shelve", R"({"seconds":600})").shelve_for_s, 600.0);
  EXPECT_EQ(command("label", R"({"label":"test"})").label, core::IncidentLabel::test);
}

TEST(CommandJson, NamesTheMemberThatIsWrong) {
  EXPECT_EQ(refused("dance", "{}"), "command");
  EXPECT_EQ(refused("ack", "[]"), "body");
  EXPECT_EQ(refused("ack", R"({"seconds":1})"), "seconds");
  EXPECT_EQ(refused("ack", R"({"comment":7})"), "comment");
  EXPECT_EQ(refused("shelve", "{}"), "seconds");
  EXPECT_EQ(refused("shelve", R"({"seconds":"long"})"), "seconds");
  EXPECT_EQ(refused("label", "{}"), "label");
  EXPECT_EQ(refused("label", R"({"label":"ghost"})"), "label");
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
