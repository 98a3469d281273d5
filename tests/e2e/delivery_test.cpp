// SPDX-License-Identifier: Apache-2.0
// Alerts arrive, whoever dies on the way: the broker, the connection, the service.
#include <algorithm>
#include <csignal>
#include <map>
#include <set>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>

#include "tests/e2e/stack.hpp"
#include "tests/support/proxy.hpp"

namespace kidnapwatch::test {
namespace {

class Delivery : public ::testing::Test {
 protected:
  /// The rows of a query on the store, one value each.
  [[nodiscard]] std::set<std::string> stored(const std::string& query) const {
    std::istringstream lines(
        output_of({"sqlite3", "-cmd", ".timeout 5000", stack_.database().string(), query}));
    std::set<std::string> values;
    for (std::string line; std::getline(lines, line);) values.insert(line);
    return values;
  }

  /// How often each alert came, by the member `key`.
  [[nodiscard]] std::map<std::string, int> received(const std::string& key) const {
    std::map<std::string, int> counts;
    for (const auto& message : stack_.received()) {
      const Json alert = Json::parse(message.payload, nullptr, false);
      if (alert.is_object() && alert.contains(key)) ++counts[alert.at(key).get<std::string>()];
    }
    return counts;
  }

  [[nodiscard]] bool all_delivered() const {
    return stored("SELECT event_id FROM alert WHERE NOT delivered").empty();
  }

  void start_service(const std::vector<std::string>& more_flags = {}) {
    stack_.start_service(more_flags);
    stack_.await_ready();
  }

  /// Two robots, kidnapped and never back: their incidents stay open.
  void kidnap_two() {
    (void)stack_.robots({"simulate", "--robots", "2", "--rate", "5", "--duration", "60",
                         "--kidnap-every", "50", "--speed", "10"});
    ASSERT_TRUE(eventually([&] { return stored("SELECT id FROM incident").size() == 2; }));
  }

  void expect_whole_store() const {
    EXPECT_EQ(stored("PRAGMA integrity_check"), std::set<std::string>{"ok"});
    EXPECT_EQ(stored("SELECT count(*) FROM incident"),
              stored("SELECT count(DISTINCT subject) FROM audit WHERE action LIKE 'incident.%'"));
    EXPECT_EQ(stored("SELECT sum(seq) FROM incident"),
              stored("SELECT count(*) FROM audit WHERE action LIKE 'incident.%'"));
  }

  Stack stack_;
};

TEST_F(Delivery, AnAlertIsDoneWhenTheBrokerHasConfirmedIt) {
  stack_.subscribe("kidnapwatch/v1/+/alert");
  start_service();
  kidnap_two();
  EXPECT_TRUE(eventually([&] { return all_delivered(); }));
  EXPECT_EQ(stored("SELECT event_id FROM alert WHERE delivered").size(), 2U);  // not resolved
  for (const auto& [event, times] : received("eventId")) EXPECT_EQ(times, 1) << event;
  expect_whole_store();
}

TEST_F(Delivery, OpenIncidentsAreAnnouncedAgainToABrokerThatCameBack) {
  Proxy cable(stack_.broker.port());
  stack_.broker_url = cable.url();
  start_service();
  kidnap_two();
  ASSERT_TRUE(eventually([&] { return all_delivered(); }));
  const auto open = stored(
      "SELECT event_id FROM alert WHERE id IN (SELECT max(id) FROM alert GROUP BY incident)");
  cable.swallow(true);
  stack_.broker.kill();
  std::filesystem::remove(stack_.broker.folder() / "mosquitto.db");  // it has forgotten all
  stack_.broker.start();
  stack_.subscribe("kidnapwatch/v1/+/alert");
  cable.swallow(false);
  EXPECT_TRUE(eventually([&] {
    const auto events = received("eventId");
    return std::ranges::all_of(open, [&](const auto& id) { return events.contains(id); });
  }));
}

TEST_F(Delivery, WhatAnEarlierServiceLeftUndeliveredGoesOutAtTheNextStart) {
  start_service();
  kidnap_two();
  ASSERT_TRUE(eventually([&] { return all_delivered(); }));
  stack_.service->signal(SIGKILL);
  (void)stack_.service->wait();
  (void)stored("UPDATE alert SET delivered = 0");  // as if it had died before the confirmation
  const auto open = stored("SELECT event_id FROM alert");
  stack_.subscribe("kidnapwatch/v1/+/alert");
  start_service();
  EXPECT_TRUE(eventually([&] { return all_delivered(); }));
  const auto events = received("eventId");
  for (const auto& id : open) EXPECT_TRUE(events.contains(id)) << id;
}

TEST_F(Delivery, EveryIncidentArrivesThroughKillsOfBrokerAndService) {
  stack_.subscribe("kidnapwatch/v1/+/alert");  // comes back by itself
  start_service();
  const auto robots =
      stack_.robots_in_background({"simulate", "--robots", "4", "--rate", "5", "--duration",
                                   "36000", "--kidnap-every", "20", "--speed", "20"});
  for (int kill = 0; kill < 3; ++kill) {
    const auto before = stored("SELECT event_id FROM alert");
    EXPECT_TRUE(eventually([&] { return stored("SELECT event_id FROM alert") != before; }));
    stack_.broker.kill();
    stack_.broker.start();
    EXPECT_TRUE(eventually([&] { return stack_.status_of("/readyz") == 200; }));
    stack_.service->signal(SIGKILL);
    (void)stack_.service->wait();
    start_service();
  }
  robots->signal(SIGTERM);
  (void)robots->wait();
  EXPECT_TRUE(eventually([&] { return all_delivered(); }));
  const auto arrived = received("incidentId");
  const auto incidents = stored("SELECT id FROM incident");
  EXPECT_FALSE(incidents.empty());  // how many depends on when the service was away
  for (const auto& id : incidents) EXPECT_TRUE(arrived.contains(id)) << id;
  expect_whole_store();
}

TEST_F(Delivery, AHalfOpenConnectionIsNoticedAndItsAlertsGoOutByTheNext) {
  Proxy cable(stack_.broker.port());
  stack_.broker_url = cable.url();
  stack_.subscribe("kidnapwatch/v1/+/alert");
  start_service({"--mqtt-keep-alive-s", "3"});
  kidnap_two();
  ASSERT_TRUE(eventually([&] { return all_delivered(); }));
  const auto before = received("eventId");
  cable.swallow(true);                                                          // pulled
  EXPECT_TRUE(eventually([&] { return stack_.status_of("/readyz") == 503; }));  // in 3 keepalives
  cable.swallow(false);
  EXPECT_TRUE(eventually([&] { return stack_.status_of("/readyz") == 200; }));
  EXPECT_TRUE(eventually([&] {
    return std::ranges::all_of(received("eventId"), [](const auto& one) { return one.second > 1; });
  }));
  EXPECT_EQ(received("eventId").size(), before.size());  // each again, and by the same id
}

}  // namespace
}  // namespace kidnapwatch::test
