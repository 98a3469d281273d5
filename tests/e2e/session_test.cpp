// SPDX-License-Identifier: Apache-2.0
// A subscriber that comes and goes, in a session that stays: it sees every change, in order.
#include <csignal>
#include <numeric>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/e2e/packages.hpp"
#include "tests/e2e/stack.hpp"

namespace kidnapwatch::test {
namespace {

/// The parameter: the version of MQTT.
class Session : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!has_paho()) GTEST_SKIP() << "python3-paho-mqtt is not installed";
    stack_.start_service();
    stack_.await_ready();
  }

  void come() {
    const auto out = folder_.path() / ("heard-" + std::to_string(++visits_));
    keeper_ = std::make_unique<Process>(
        std::vector<std::string>{"/usr/bin/python3", KW_SOURCE "/tests/e2e/keeper.py",
                                 std::to_string(stack_.broker.port()), GetParam()},
        out, folder_.path() / "keeper.log");
    ASSERT_TRUE(eventually([&] {
      return content_of(out).find("listening\n") != std::string::npos;
    })) << content_of(folder_.path() / "keeper.log");
  }
  void go() {
    keeper_->signal(SIGKILL);
    (void)keeper_->wait();
  }

  /// The alerts of all visits, each event the first time that it came.
  [[nodiscard]] std::vector<Json> heard() const {
    std::vector<Json> alerts;
    std::set<std::string> events;
    for (int visit = 1; visit <= visits_; ++visit) {
      std::istringstream lines(content_of(folder_.path() / ("heard-" + std::to_string(visit))));
      for (std::string line; std::getline(lines, line);) {
        const Json alert = Json::parse(line, nullptr, false);
        const bool is_new = alert.is_object() && events.insert(alert.at("eventId")).second;
        if (is_new) alerts.push_back(alert);
      }
    }
    return alerts;
  }
  /// Of one incident, as they came.
  [[nodiscard]] std::vector<int> seqs_heard(const std::string& incident) const {
    std::vector<int> seqs;
    for (const auto& alert : heard()) {
      if (alert.at("incidentId") == incident) seqs.push_back(alert.at("seq"));
    }
    return seqs;
  }
  [[nodiscard]] Json incidents() const { return stack_.get("/api/v1/incidents").at("incidents"); }

  Stack stack_;
  TemporaryFolder folder_;
  std::unique_ptr<Process> keeper_;
  int visits_ = 0;
};

TEST_P(Session, ThatStaysMissesNoChange) {
  come();
  go();  // from here on, the broker keeps what it misses
  (void)stack_.robots({"simulate", "--robots", "1", "--rate", "5", "--duration", "30",
                       "--kidnap-every", "25", "--speed", "10"});
  ASSERT_TRUE(eventually([&] { return incidents().size() == 1; }));
  for (int visit = 0; visit < 4; ++visit) {
    if (visit % 2 == 0) come();
    for (const auto& incident : incidents()) {
      const auto path = "/api/v1/incidents/" + incident.at("id").get<std::string>();
      for (const char* action : {"/ack", "/unack", "/ack", "/unack"}) {
        (void)stack_.post(path + action, R"({"comment":"visit )" + std::to_string(visit) + "\"}");
      }
    }
    if (visit % 2 == 0) go();  // in the middle of what just changed
  }
  come();
  for (const auto& incident : incidents()) {
    std::vector<int> all(incident.at("seq").get<std::size_t>());
    std::iota(all.begin(), all.end(), 1);
    EXPECT_GE(all.size(), 17U);
    const auto id = incident.at("id").get<std::string>();
    EXPECT_TRUE(eventually([&] { return seqs_heard(id).size() >= all.size(); }));
    EXPECT_EQ(seqs_heard(id), all);
  }
}

INSTANTIATE_TEST_SUITE_P(Mqtt, Session, ::testing::Values("3.1.1", "5"), [](const auto& version) {
  return version.param[0] == '5' ? "V5" : "V311";
});

}  // namespace
}  // namespace kidnapwatch::test
