// SPDX-License-Identifier: Apache-2.0
// The main job, end to end: a robot is kidnapped, and everybody who should know does.
#include <algorithm>
#include <csignal>
#include <fstream>
#include <map>

#include <gtest/gtest.h>

#include "adapters/codecs/rfc3339.hpp"
#include "tests/e2e/stack.hpp"

namespace kidnapwatch::test {
namespace {

class FirstLight : public ::testing::Test {
 protected:
  /// Waits until the service has counted this many scans.
  void await_counted(std::uint64_t scans) {
    EXPECT_TRUE(eventually([&] { return stack_.counted() >= scans; }))
        << stack_.counted() << " of " << scans;
  }

  std::vector<Json> alerts(const std::string& type) const {
    std::vector<Json> found;
    for (const auto& message : stack_.received()) {
      const Json alert = Json::parse(message.payload, nullptr, false);
      if (alert.is_object() && alert.value("type", "") == type) {
        found.push_back(alert);
      }
    }
    return found;
  }

  Stack stack_;
};

TEST_F(FirstLight, AKidnappingReachesSubscribersRestAndTheStore) {
  stack_.subscribe("kidnapwatch/v1/+/alert");
  stack_.start_service();
  stack_.await_ready();
  const Json sent = stack_.robots({"simulate", "--robots", "1", "--rate", "5", "--duration", "60",
                                   "--kidnap-every", "40", "--speed", "10"});
  EXPECT_EQ(sent.at("kidnaps"), 1);
  await_counted(sent.at("scans"));
  ASSERT_TRUE(eventually([&] { return !alerts("opened").empty(); }));

  const Json alert = alerts("opened").front();
  EXPECT_EQ(alert.at("schema"), "kidnapwatch/alert/1");
  EXPECT_EQ(alert.at("robotId"), "sim-0001");
  EXPECT_EQ(alert.at("state"), "open");
  EXPECT_GT(alert.at("score"), alert.at("threshold"));

  const std::string id = alert.at("incidentId");
  ASSERT_TRUE(eventually([&] { return stack_.status_of("/api/v1/incidents/" + id) == 200; }));
  const Json evidence = stack_.get("/api/v1/incidents/" + id + "/evidence");
  EXPECT_EQ(evidence.at("before").at("ranges").size(), 360U);
  EXPECT_EQ(evidence.at("after").at("ranges").size(), 360U);
  EXPECT_EQ(stack_.get("/api/v1/robots/sim-0001").at("incidentId"), id);
}

TEST_F(FirstLight, EveryScanOfFiftyRobotsIsAccountedForAndAlertsAreQuick) {
  stack_.subscribe("kidnapwatch/v1/+/alert");
  stack_.start_service();
  stack_.await_ready();
  const Json sent = stack_.robots(
      {"simulate", "--robots", "50", "--rate", "5", "--duration", "60", "--kidnap-every", "50"});
  EXPECT_EQ(sent.at("scans"), 50 * 5 * 60);
  EXPECT_EQ(sent.at("unsent"), 0);
  await_counted(sent.at("scans"));
  EXPECT_EQ(stack_.counted(), sent.at("scans").get<std::uint64_t>());
  EXPECT_EQ(stack_.counted("first"), 50U);

  std::map<std::string, int> opened;
  std::vector<double> latencies_s;
  for (const auto& message : stack_.received()) {
    const Json alert = Json::parse(message.payload, nullptr, false);
    if (!alert.is_object() || alert.value("type", "") != "opened") {
      continue;
    }
    ++opened[alert.at("robotId")];
    const Json& stamp = alert.at("scanStamp");
    latencies_s.push_back(message.at_s - stamp.at("sec").get<double>() -
                          1e-9 * stamp.at("nanosec").get<double>());
  }
  EXPECT_EQ(opened.size(), 50U);  // each robot is kidnapped
  ASSERT_FALSE(latencies_s.empty());
  std::ranges::sort(latencies_s);
  const double median_s = latencies_s[latencies_s.size() / 2];
  EXPECT_GT(latencies_s.front(), 0.0);  // no alert before its scan
  RecordProperty("median_alert_latency_us", static_cast<int>(1e6 * median_s));
  std::cout << latencies_s.size() << " alerts; from scan to subscriber: median " << 1e3 * median_s
            << " ms, longest " << 1e3 * latencies_s.back() << " ms\n";
}

TEST_F(FirstLight, BadScansAreCountedUnderTheirReasonsAndHurtNobody) {
  stack_.start_service();
  stack_.await_ready();
  const std::string head =
      R"({"header":{"stamp":{"sec":5,"nanosec":0}},"angle_min":0,"range_min":0.1,"range_max":9,)";
  const std::string good = head + R"("angle_increment":0.1,)";
  stack_.publish("kidnapwatch/v1/bad/scan", "\x01\x02 garbage \xff\xfe");
  std::string ten_megabytes;
  ten_megabytes.resize(10'000'000, '1');
  stack_.publish("kidnapwatch/v1/bad/scan", ten_megabytes);
  stack_.publish("kidnapwatch/v1/bad/scan", good + R"("ranges":[]})");
  stack_.publish("kidnapwatch/v1/bad/scan", good + R"("ranges":"far"})");
  stack_.publish("kidnapwatch/v1/bad/scan", head + R"("angle_increment":0,"ranges":[1,2,3]})");
  stack_.publish("kidnapwatch/v1/bad/scan", good + R"("ranges":[NaN,NaN,NaN,NaN]})");
  stack_.publish("kidnapwatch/v1/bad/scan/deeper", good + R"("ranges":[1,2,3]})");
  stack_.publish("kidnapwatch/v1/not a robot/scan", good + R"("ranges":[1,2,3]})");
  const Json sent = stack_.robots(
      {"simulate", "--robots", "2", "--rate", "5", "--duration", "20", "--speed", "10"});
  await_counted(sent.at("scans").get<std::uint64_t>() + 8);
  for (const char* reason : {"malformed", "too_large", "no_beams", "wrong_type", "bad_geometry",
                             "not_comparable", "unknown_topic", "bad_robot_id"}) {
    EXPECT_EQ(stack_.counted(reason), 1U) << reason;
  }
  EXPECT_EQ(stack_.counted("scored") + stack_.counted("first"), sent.at("scans"));
  EXPECT_TRUE(stack_.service->running());
}

TEST_F(FirstLight, HistorySurvivesKillMinusNineAndSessionsResume) {
  stack_.subscribe("kidnapwatch/v1/+/alert");
  stack_.start_service();
  stack_.await_ready();
  (void)stack_.robots({"simulate", "--robots", "2", "--rate", "5", "--duration", "60",
                       "--kidnap-every", "40", "--speed", "10"});
  ASSERT_TRUE(
      eventually([&] { return stack_.get("/api/v1/incidents").at("incidents").size() == 2; }));
  stack_.service->signal(SIGKILL);
  EXPECT_EQ(stack_.service->wait(), 128 + SIGKILL);
  stack_.start_service();
  stack_.await_ready();

  EXPECT_EQ(stack_.get("/api/v1/incidents").at("incidents").size(), 2U);
  const Json robot = stack_.get("/api/v1/robots/sim-0001");
  EXPECT_TRUE(robot.contains("incidentId"));
  EXPECT_TRUE(robot.contains("threshold"));  // calibrated from what it had seen before
  EXPECT_GE(stack_.get("/api/v1/robots/sim-0001/scores?limit=1000").at("scores").size(), 200U);
  const Json sent = stack_.robots({"simulate", "--robots", "2", "--rate", "5", "--duration", "60",
                                   "--seed", "2", "--speed", "10"});
  await_counted(sent.at("scans"));
  EXPECT_EQ(stack_.counted("first"), 2U);
  EXPECT_TRUE(eventually([&] { return alerts("resolved").size() == 2; }));  // by rule, both
}

TEST_F(FirstLight, AStopLosesNothingThatIsQueued) {
  stack_.start_service();
  stack_.await_ready();
  const Json sent = stack_.robots(
      {"simulate", "--robots", "20", "--rate", "10", "--duration", "20", "--speed", "10"});
  await_counted(sent.at("scans"));
  const auto scored = stack_.counted("scored");
  stack_.service->signal(SIGTERM);
  EXPECT_EQ(stack_.service->wait(), 0) << stack_.service_log();
  const std::string rows =
      output_of({"sqlite3", stack_.database().string(),
                 "SELECT (SELECT count(*) FROM score_even) + (SELECT count(*) FROM score_odd)"});
  EXPECT_EQ(std::stoull(rows), scored);
}

TEST_F(FirstLight, TheBrokerMayComeLaterAndGoAway) {
  stack_.broker.stop();
  stack_.start_service();
  EXPECT_EQ(stack_.status_of("/healthz"), 200);
  EXPECT_EQ(stack_.status_of("/readyz"), 503);
  stack_.broker.start();
  EXPECT_TRUE(eventually([&] { return stack_.status_of("/readyz") == 200; }));
  stack_.broker.kill();
  EXPECT_TRUE(eventually([&] { return stack_.status_of("/readyz") == 503; }));
  stack_.broker.start();
  EXPECT_TRUE(eventually([&] { return stack_.status_of("/readyz") == 200; }));
  const Json sent = stack_.robots(
      {"simulate", "--robots", "1", "--rate", "5", "--duration", "5", "--speed", "10"});
  await_counted(sent.at("scans"));
}

}  // namespace
}  // namespace kidnapwatch::test
