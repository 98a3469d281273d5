// SPDX-License-Identifier: Apache-2.0
// Commands by MQTT: each ends in one result, and its sender is told.
#include "service/command_desk.hpp"

#include <future>

#include <gtest/gtest.h>

#include "api/ports.hpp"

namespace kidnapwatch::service {
namespace {

using adapters::codecs::Json;
using core::CommandResult;

/// A service of one robot, r1, whose incident i1 is open and whose i0 is resolved.
class CommandDeskTest : public ::testing::Test {
 protected:
  CommandDesk::Ways ways() {
    return {.knows = [](const auto& robot) { return robot != "stranger"; },
            .stored = [](const auto& id) { return incident(id); },
            .change = [](const auto& id, const auto& command) -> std::optional<core::Incident> {
              if (id == "i0") return std::nullopt;
              return changed(*incident(id), command);
            },
            .change_open =
                [this](const auto& robot, const auto& command) {
                  if (trouble) trouble();
                  return robot == "r1" ? changed(*incident("i1"), command) : std::nullopt;
                },
            .forget_scans = [this](const auto& robot) { forgotten_ = robot; },
            .publish =
                [this](const CommandLetter& letter, std::string answer) {
                  answers_.set_value({letter.correlation, std::move(answer)});
                  return true;
                },
            .log_refusal = [](const auto&, const auto&) {}};
  }

  static std::optional<core::Incident> incident(const std::string& id) {
    if (id != "i0" && id != "i1" && id != "of_r2") return std::nullopt;
    return core::Incident{.id = id, .robot = id == "of_r2" ? "r2" : "r1", .seq = 1};
  }
  static std::optional<core::Incident> changed(core::Incident incident,
                                               const core::IncidentCommand& command) {
    incident.resolved_by = command.author;
    ++incident.seq;
    return incident;
  }

  static CommandLetter letter(std::string payload, std::string robot = "r1") {
    return {.robot = std::move(robot),
            .payload = std::make_shared<const std::string>(std::move(payload)),
            .response_topic = "answers",
            .correlation = std::string("\0 7", 3)};
  }

  Json answer_to(const CommandLetter& letter) {
    answers_ = {};
    auto answer = answers_.get_future();
    desk_.take(letter);
    const auto [correlation, text] = answer.get();
    EXPECT_EQ(correlation, letter.correlation);
    return adapters::codecs::parsed(text, "answer");
  }
  std::string result_of(const std::string& payload, const std::string& robot = "r1") {
    return answer_to(letter(payload, robot)).at("result").get<std::string>();
  }
  [[nodiscard]] std::uint64_t counted(CommandResult result) const {
    return desk_.counts().at(static_cast<std::size_t>(result));
  }

  std::function<void()> trouble;
  std::promise<std::pair<std::string, std::string>> answers_;
  std::string forgotten_;
  CommandDesk desk_{ways()};
};

TEST_F(CommandDeskTest, ChangesTheOpenIncident) {
  const Json answer = answer_to(letter(R"({"command":"relocalized"})"));
  EXPECT_EQ(answer.at("status"), 200);
  EXPECT_EQ(answer.at("incident").at("resolvedBy"), "robot:r1");
  EXPECT_EQ(counted(CommandResult::done), 1U);
}

TEST_F(CommandDeskTest, ChangesTheIncidentThatIsNamed) {
  EXPECT_EQ(answer_to(letter(R"({"command":"ack","incidentId":"i1"})")).at("incident").at("id"),
            "i1");
  EXPECT_EQ(result_of(R"({"command":"ack","incidentId":"i0"})"), "not_allowed");
  EXPECT_EQ(result_of(R"({"command":"ack","incidentId":"i9"})"), "no_incident");
  EXPECT_EQ(result_of(R"({"command":"ack","incidentId":"of_r2"})"), "no_incident");
}

TEST_F(CommandDeskTest, ForgetsScans) {
  EXPECT_EQ(result_of(R"({"command":"reset"})"), "done");
  EXPECT_EQ(forgotten_, "r1");
}

TEST_F(CommandDeskTest, SaysWhyNot) {
  EXPECT_EQ(result_of(R"({"command":"ack"})", "r2"), "no_incident");
  EXPECT_EQ(result_of(R"({"command":"ack"})", "stranger"), "unknown_robot");
  EXPECT_EQ(result_of(std::string(16'385, ' ')), "too_large");
  EXPECT_EQ(result_of("garbage"), "malformed");
  const Json answer = answer_to(letter(R"({"command":"shelve","seconds":-1})"));
  EXPECT_EQ(answer.at("field"), "seconds");
  EXPECT_EQ(answer.at("status"), 400);
  EXPECT_EQ(counted(CommandResult::malformed), 2U);
}

TEST_F(CommandDeskTest, TellsABusyServiceFromABrokenOne) {
  trouble = [] { throw api::Unavailable("the robot's queue is full"); };
  EXPECT_EQ(answer_to(letter(R"({"command":"ack"})")).at("detail"), "the robot's queue is full");
  trouble = [] { throw std::runtime_error("secret"); };
  const Json answer = answer_to(letter(R"({"command":"ack"})"));
  EXPECT_EQ(answer.at("status"), 500);
  EXPECT_EQ(answer.dump().find("secret"), std::string::npos);
}

TEST_F(CommandDeskTest, IgnoresWhatWasRetained) {
  CommandLetter old = letter(R"({"command":"reset"})");
  old.retained = true;
  desk_.take(old);
  EXPECT_EQ(counted(CommandResult::retained), 1U);
  EXPECT_EQ(result_of(R"({"command":"ack"})"), "done");
  EXPECT_EQ(forgotten_, "");
}

TEST_F(CommandDeskTest, CountsWhatIsTooMuch) {
  std::promise<void> begun;
  std::promise<void> go_on;
  auto going_on = go_on.get_future().share();
  trouble = [&, first = true]() mutable {
    if (std::exchange(first, false)) begun.set_value();
    going_on.wait();
  };
  CommandLetter unanswered = letter(R"({"command":"ack"})");
  unanswered.response_topic.clear();
  desk_.take(unanswered);
  begun.get_future().wait();
  for (int i = 0; i < 66; ++i) {
    desk_.take(unanswered);
  }
  EXPECT_EQ(counted(CommandResult::overload), 2U);
  go_on.set_value();
  desk_.stop();
}

}  // namespace
}  // namespace kidnapwatch::service
