// SPDX-License-Identifier: Apache-2.0
// What robots and programs say on the topic `command`, and what they are answered.
#include <csignal>

#include <gtest/gtest.h>

#include "tests/e2e/stack.hpp"

namespace kidnapwatch::test {
namespace {

class Commands : public ::testing::Test {
 protected:
  void SetUp() override {
    stack_.start_service();
    stack_.await_ready();
  }

  /// mosquitto's clients, told where the broker is.
  [[nodiscard]] std::string say(std::vector<std::string> words) const {
    words.insert(words.begin() + 1,
                 {"-h", "127.0.0.1", "-p", std::to_string(stack_.broker.port()), "-q", "1"});
    return output_of(words);
  }
  /// The answer by MQTT 5; {} where none came within 10 s. Also checks the correlation data.
  [[nodiscard]] Json answer(const std::string& robot, const std::string& payload) const {
    const std::string topic = "kidnapwatch/v1/" + robot;
    const std::string line =
        say({"mosquitto_rr", "-V", "5", "-t", topic + "/command", "-e", topic + "/response", "-m",
             payload, "-D", "publish", "correlation-data", "call 7", "-F", "%D %C %p", "-W", "10"});
    EXPECT_TRUE(line.starts_with("call 7 application/json {")) << line;
    return Json::parse(line.substr(line.find('{')));
  }
  [[nodiscard]] std::string result(const std::string& robot, const std::string& payload) const {
    return answer(robot, payload).at("result").get<std::string>();
  }
  [[nodiscard]] std::uint64_t counted(const std::string& command_result) const {
    return stack_.get("/api/v1/service").at("commands").at(command_result).get<std::uint64_t>();
  }
  /// One robot with one open incident.
  void kidnap() {
    (void)stack_.robots({"simulate", "--robots", "1", "--rate", "5", "--duration", "30",
                         "--kidnap-every", "25", "--speed", "10"});
    ASSERT_TRUE(eventually([&] { return !incidents().empty(); }));
  }
  [[nodiscard]] Json incidents() const {
    return stack_.get("/api/v1/incidents?state=open").at("incidents");
  }

  Stack stack_;
};

TEST_F(Commands, AreCarriedOutAndAnswered) {
  kidnap();
  const auto incident = incidents().at(0);
  const auto robot = incident.at("robotId").get<std::string>();
  const auto id = incident.at("id").get<std::string>();
  EXPECT_EQ(answer(robot, R"({"command":"ack","author":"ann"})").at("incident").at("state"),
            "acknowledged");
  EXPECT_EQ(answer(robot, R"({"command":"shelve"})").at("field"), "seconds");
  EXPECT_EQ(result(robot, R"({"command":"reset"})"), "done");
  const Json relocalized = answer(robot, R"({"command":"relocalized"})");
  EXPECT_EQ(relocalized.at("incident").at("id"), id);
  EXPECT_EQ(relocalized.at("incident").at("resolvedBy"), "robot:" + robot);
  EXPECT_EQ(stack_.get("/api/v1/incidents/" + id).at("state"), "resolved");  // stored, too
  EXPECT_EQ(result(robot, R"({"command":"relocalized"})"), "no_incident");
  EXPECT_EQ(result(robot, R"({"command":"ack","incidentId":")" + id + R"("})"), "not_allowed");
  EXPECT_EQ(result(robot, R"({"command":"label","label":"test","incidentId":")" + id + R"("})"),
            "done");
  EXPECT_EQ(counted("done"), 4U);
}

TEST_F(Commands, ThatCannotBeCarriedOutAreCountedByReason) {
  const std::string topic = "kidnapwatch/v1/r1/command";
  EXPECT_EQ(result("r1", R"({"command":"ack"})"), "unknown_robot");
  EXPECT_EQ(result("r1", std::string(20'000, ' ')), "too_large");
  for (const char* version : {"311", "5"}) {
    (void)say({"mosquitto_pub", "-V", version, "-r", "-t", topic, "-m", R"({"command":"reset"})"});
  }
  EXPECT_TRUE(eventually([&] { return counted("retained") >= 1; }));
  EXPECT_EQ(counted("done"), 0U);
  const std::string metrics = stack_.get_text("/metrics");
  EXPECT_NE(metrics.find(R"(kidnapwatch_commands_total{result="too_large"} 1)"), std::string::npos);
}

TEST_F(Commands, ByMqtt311AreCarriedOutUnlessRetained) {
  kidnap();
  const auto robot = incidents().at(0).at("robotId").get<std::string>();
  const std::string topic = "kidnapwatch/v1/" + robot + "/command";
  const std::string resolve = R"({"command":"resolve"})";
  stack_.service->signal(SIGTERM);
  (void)stack_.service->wait();
  (void)say({"mosquitto_pub", "-V", "311", "-r", "-t", topic, "-m", resolve});
  stack_.start_service();
  stack_.await_ready();
  EXPECT_TRUE(eventually([&] { return counted("retained") == 1; }));
  EXPECT_EQ(incidents().size(), 1U);
  (void)say({"mosquitto_pub", "-V", "311", "-t", topic, "-m", resolve});
  EXPECT_TRUE(eventually([&] { return incidents().empty(); }));
}

TEST_F(Commands, DoNotHaveTheServiceSpeakForOthers) {
  stack_.subscribe("kidnapwatch/v1/+/alert");
  (void)say({"mosquitto_pub", "-V", "5", "-t", "kidnapwatch/v1/r1/command", "-m", "{}", "-D",
             "publish", "response-topic", "kidnapwatch/v1/r2/alert"});
  EXPECT_TRUE(eventually([&] { return counted("unknown_robot") == 1; }));
  EXPECT_EQ(result("r1", "{}"), "unknown_robot");  // by the same connection, after it
  for (const auto& message : stack_.received()) {
    EXPECT_EQ(message.payload, "ping");
  }
}

}  // namespace
}  // namespace kidnapwatch::test
