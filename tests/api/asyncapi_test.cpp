// SPDX-License-Identifier: Apache-2.0
// asyncapi.yaml against the topics, and against the messages that the codecs write and read.
#include <map>
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "adapters/codecs/command_json.hpp"
#include "adapters/codecs/messages.hpp"
#include "adapters/codecs/odometry_json.hpp"
#include "adapters/codecs/particles_payload.hpp"
#include "adapters/codecs/scan_payload.hpp"
#include "adapters/mqtt/topics.hpp"
#include "api/descriptions.hpp"
#include "schema.hpp"

namespace kidnapwatch::api {
namespace {

namespace codecs = adapters::codecs;
using adapters::mqtt::TopicKind;

constexpr auto kNow = core::stamp_from_ns(1'700'000'010'500'000'000);

const Json& document() {
  static const Json parsed = codecs::parsed(asyncapi_json(), "asyncapi");
  return parsed;
}

const Json& message(const char* name) { return document()["components"]["messages"][name]; }

/// What of the text, a message of this name, does not fit its description.
std::string misfit_of(const char* name, const std::string& text) {
  return misfit(document(), message(name)["payload"], codecs::parsed(text, "message"));
}

std::string topic_of(const Json& channel) {
  const auto prefixed = std::regex_replace(channel["address"].get<std::string>(),
                                           std::regex("\\{prefix\\}"), "kidnapwatch/v1");
  return std::regex_replace(prefixed, std::regex("\\{robot\\}"), "r1");
}

TEST(Asyncapi, DescribesEveryTopicAndNoOther) {
  std::map<std::string, TopicKind> kinds;
  for (const auto& [name, channel] : document()["channels"].items()) {
    kinds[name] = adapters::mqtt::Topics().parse(topic_of(channel)).kind;
  }
  const std::map<std::string, TopicKind> expected{
      {"scan", TopicKind::scan},           {"odom", TopicKind::odom},
      {"particles", TopicKind::particles}, {"command", TopicKind::command},
      {"alert", TopicKind::own},           {"state", TopicKind::own},
      {"score", TopicKind::own},           {"response", TopicKind::own},
      {"serviceStatus", TopicKind::own}};
  EXPECT_EQ(kinds, expected);
}

TEST(Asyncapi, HasTheServiceReceiveWhatItReadsAndSendTheRest) {
  std::set<std::string> channels;
  for (const auto& [name, operation] : document()["operations"].items()) {
    const auto& channel = resolved(document(), operation["channel"]);
    const auto kind = adapters::mqtt::Topics().parse(topic_of(channel)).kind;
    EXPECT_EQ(operation["action"], kind == TopicKind::own ? "send" : "receive") << name;
    channels.insert(topic_of(channel));
  }
  EXPECT_EQ(channels.size(), document()["channels"].size());
}

TEST(Asyncapi, HasExamplesThatFit) {
  int examples = 0;
  for (const auto& [name, one] : document()["components"]["messages"].items()) {
    for (const auto& example : one["examples"]) {
      ++examples;
      EXPECT_EQ(misfit(document(), one["payload"], example["payload"]), "") << name;
    }
    EXPECT_EQ(one["payload"].contains("$ref"), true) << name;
  }
  EXPECT_GT(examples, 15);
}

TEST(Asyncapi, HasExamplesThatAreRead) {
  core::Scan scan;
  for (const auto& example : message("scanJson")["examples"]) {
    EXPECT_NO_THROW(codecs::ScanDecoder().decode(example["payload"].dump(), "", scan));
  }
  for (const auto& example : message("scanCbor")["examples"]) {
    const auto cbor = Json::to_cbor(example["payload"]);
    const std::string bytes(cbor.begin(), cbor.end());
    EXPECT_NO_THROW(codecs::ScanDecoder().decode(bytes, "application/cbor", scan));
  }
  for (const auto& example : message("odometry")["examples"]) {
    EXPECT_NO_THROW((void)codecs::OdometryDecoder().decode(example["payload"].dump()));
  }
  for (const auto& example : message("particles")["examples"]) {
    EXPECT_NO_THROW((void)codecs::ParticlesDecoder(1000).decode(example["payload"].dump()));
  }
  for (const auto& example : message("command")["examples"]) {
    EXPECT_NO_THROW((void)codecs::robot_command(example["payload"].dump(), "r1"));
  }
}

core::Incident plain_incident() {
  core::Incident incident;
  incident.id = "i1";
  incident.robot = "r1";
  incident.seq = 1;
  incident.detector = "motion_consistency";
  return incident;
}

core::Incident full_incident() {
  core::Incident incident = plain_incident();
  incident.resolved_at = kNow;
  incident.acknowledged_by = "ann";
  incident.resolved_by = "bob";
  incident.shelved_until = kNow;
  incident.label = core::IncidentLabel::test;
  incident.comment = "tried";
  return incident;
}

TEST(Asyncapi, FitsAlerts) {
  using enum core::AlertType;
  for (const auto type : {opened, updated, acknowledged, unacknowledged, resolved, shelved}) {
    for (const auto& incident : {plain_incident(), full_incident()}) {
      const core::Alert alert{
          .event_id = "e1", .type = type, .timestamp = kNow, .incident = incident};
      EXPECT_EQ(misfit_of("alert", codecs::alert_message(alert)), "");
    }
  }
}

TEST(Asyncapi, FitsStates) {
  core::RobotStatus robot;
  robot.id = "r1";
  EXPECT_EQ(misfit_of("state", codecs::state_message(robot, kNow)), "");
  robot.incident_id = "i1";
  robot.threshold = robot.motion_threshold = robot.own_motion_threshold = 3.0;
  for (const auto trouble : {core::Trouble::blind, core::Trouble::odometry, core::Trouble::noise,
                             core::Trouble::crowd}) {
    robot.trouble = trouble;
    EXPECT_EQ(misfit_of("state", codecs::state_message(robot, kNow)), "");
  }
}

TEST(Asyncapi, FitsScores) {
  core::Score score;
  EXPECT_EQ(misfit_of("score", codecs::score_message("r1", score)), "");
  score.threshold = 3.0;
  score.motion = core::MotionScore{.confirmed = 1.0, .threshold = 4.5};
  score.others = {{.detector = core::DetectorId{}, .score = 1.0F}};
  EXPECT_EQ(misfit_of("score", codecs::score_message("r1", score)), "");
}

TEST(Asyncapi, FitsAnswers) {
  EXPECT_EQ(misfit_of("answer", codecs::answer_message("r1", {.incident = full_incident()})), "");
  using enum core::CommandResult;  // retained and overload get no answer
  for (const auto result :
       {done, malformed, too_large, unknown_robot, no_incident, not_allowed, unavailable, failed}) {
    const codecs::CommandAnswer answer{.result = result, .detail = "why", .field = "seconds"};
    EXPECT_EQ(misfit_of("answer", codecs::answer_message("r1", answer)), "");
  }
}

TEST(Asyncapi, FitsTheServicesStatus) {
  const std::vector<core::Degradation> degraded{{"broker", "gone"}, {"quarantine", "damaged"}};
  for (const char* status : {"online", "stopped", "offline"}) {
    EXPECT_EQ(
        misfit_of("serviceStatus", codecs::service_status_message(status, "1", kNow, degraded)),
        "");
  }
}

TEST(Asyncapi, NamesTheSchemaOfEveryMessageOfTheService) {
  for (const auto& [name, schema] :
       std::map<const char*, std::string_view>{{"alert", codecs::kAlertSchema},
                                               {"state", codecs::kStateSchema},
                                               {"score", codecs::kScoreSchema},
                                               {"answer", codecs::kAnswerSchema},
                                               {"serviceStatus", codecs::kServiceStatusSchema}}) {
    for (const char* part : {"headers", "payload"}) {
      const auto& described = resolved(document(), message(name)[part]);
      EXPECT_EQ(described["properties"]["schema"]["const"], std::string(schema)) << name;
    }
  }
}

TEST(Asyncapi, TellsWrongMessagesFromRightOnes) {
  const core::Alert alert{.event_id = "e1", .timestamp = kNow, .incident = plain_incident()};
  Json wrong = codecs::parsed(codecs::alert_message(alert), "alert");
  wrong["severity"] = "page";
  EXPECT_NE(misfit_of("alert", wrong.dump()), "");
  EXPECT_NE(misfit_of("command", R"({"command":"dance"})"), "");
  EXPECT_NE(misfit_of("command", R"({"author":"ann"})"), "");
  EXPECT_NE(misfit_of("particles", R"({"weights":[-1]})"), "");
  EXPECT_NE(misfit_of("odometry", R"({"x":1,"y":2,"theta":3})"), "");
  EXPECT_NE(misfit_of("scanJson", R"({"ranges":[1]})"), "");
}

}  // namespace
}  // namespace kidnapwatch::api
