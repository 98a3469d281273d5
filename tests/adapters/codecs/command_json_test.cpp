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

core::RobotCommand told(const char* payload) { return robot_command(payload, "r1"); }

std::string field_refused(const std::string& payload) {
  try {
    (void)robot_command(payload, "r1");
  } catch (const core::BadInput& error) {
    return error.field();
  }
  return "";
}

TEST(RobotCommand, ReadsEveryCommand) {
  using enum core::IncidentAction;
  EXPECT_EQ(told(R"({"command":"ack"})").change->action, ack);
  EXPECT_EQ(told(R"({"command":"unack"})").change->action, unack);
  EXPECT_EQ(told(R"({"command":"resolve","comment":"back"})").change->comment, "back");
  EXPECT_EQ(told(R"({"seconds":600,"command":"shelve"})").change->shelve_for_s, 600.0);
  EXPECT_EQ(told(R"({"command":"label","label":"test"})").change->label, core::IncidentLabel::test);
  EXPECT_EQ(told(R"({"command":"relocalized"})").change->action, resolve);
  EXPECT_FALSE(told(R"({"command":"reset"})").change);
}

TEST(RobotCommand, TellsWhoAndWhich) {
  EXPECT_EQ(told(R"({"command":"ack"})").change->author, "mqtt");
  EXPECT_EQ(told(R"({"command":"ack","author":"ann"})").change->author, "mqtt:ann");
  EXPECT_EQ(told(R"({"command":"relocalized"})").change->author, "robot:r1");
  EXPECT_FALSE(told(R"({"command":"ack"})").incident_id);
  EXPECT_EQ(told(R"({"command":"ack","incidentId":"i7"})").incident_id, "i7");
}

TEST(RobotCommand, NamesTheMemberThatIsWrong) {
  EXPECT_EQ(field_refused(""), "payload");
  EXPECT_EQ(field_refused("[]"), "payload");
  EXPECT_EQ(field_refused(std::string(10'000, '[')), "payload");
  EXPECT_EQ(field_refused(R"({"command":"ack","command":"resolve"})"), "payload");
  EXPECT_EQ(field_refused("{}"), "command");
  EXPECT_EQ(field_refused(R"({"command":7})"), "command");
  EXPECT_EQ(field_refused(R"({"command":"dance"})"), "command");
  EXPECT_EQ(field_refused(R"({"command":"ack","incidentId":null})"), "incidentId");
  EXPECT_EQ(field_refused(R"({"command":"ack","author":""})"), "author");
  EXPECT_EQ(field_refused(R"({"command":"ack","author":")" + std::string(65, 'a') + "\"}"),
            "author");
  EXPECT_EQ(field_refused(R"({"command":"relocalized","author":"ann"})"), "author");
  EXPECT_EQ(field_refused(R"({"command":"reset","incidentId":"i7"})"), "incidentId");
  EXPECT_EQ(field_refused(R"({"command":"ack","seconds":1})"), "seconds");
  EXPECT_EQ(field_refused(R"({"command":"shelve","seconds":604801})"), "seconds");
  EXPECT_EQ(field_refused(R"({"command":"label"})"), "label");
}

TEST(AnswerMessage, SaysWhatWasDone) {
  CommandAnswer answer;
  answer.incident = core::Incident{.id = "i7", .robot = "r1", .seq = 2};
  const Json done = parsed(answer_message("r1", answer), "answer");
  EXPECT_EQ(done.at("schema"), "kidnapwatch/answer/1");
  EXPECT_EQ(done.at("robotId"), "r1");
  EXPECT_EQ(done.at("result"), "done");
  EXPECT_EQ(done.at("status"), 200);
  EXPECT_EQ(done.at("incident").at("seq"), 2);
  EXPECT_FALSE(done.contains("detail"));
}

TEST(AnswerMessage, SaysWhyNot) {
  const Json refused = parsed(answer_message("r1", {.result = core::CommandResult::malformed,
                                                    .detail = "seconds: must be a number",
                                                    .field = "seconds"}),
                              "answer");
  EXPECT_EQ(refused.at("type"), "about:blank");
  EXPECT_EQ(refused.at("title"), "Bad Request");
  EXPECT_EQ(refused.at("status"), 400);
  EXPECT_EQ(refused.at("field"), "seconds");
  EXPECT_EQ(refused.at("detail"), "seconds: must be a number");
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
