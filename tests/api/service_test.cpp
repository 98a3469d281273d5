// SPDX-License-Identifier: Apache-2.0
// The service itself over REST: status, health, readiness, metrics.
#include "api/service.hpp"

#include "memory_ports.hpp"

namespace kidnapwatch::api {
namespace {

class ServiceTest : public ApiTest {
 protected:
  /// Whether the metrics have exactly this line.
  bool has_metric(const std::string& line) {
    return ("\n" + get("/metrics").body).find("\n" + line + "\n") != std::string::npos;
  }
};

TEST_F(ServiceTest, TellsItsStatusWithCountsByName) {
  fleet.status_now.counts[static_cast<std::size_t>(core::Outcome::malformed)] = 3;
  const auto status = body(get("/api/v1/service"));
  EXPECT_EQ(status["scans"]["malformed"], 3);
  EXPECT_EQ(status["brokerConnected"], false);
}

TEST_F(ServiceTest, TellsTheCallerWhatItMay) {
  EXPECT_EQ(body(get("/api/v1/me"))["role"], "admin");
}

TEST_F(ServiceTest, IsHealthyAsLongAsItAnswers) {
  EXPECT_EQ(get("/healthz").body, R"({"status":"ok"})");
}

TEST_F(ServiceTest, IsReadyWithBrokerAndStore) {
  fleet.status_now.broker_connected = true;
  fleet.status_now.store_healthy = true;
  const auto response = get("/readyz");
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.body, R"({"status":"ready","reasons":[]})");
}

TEST_F(ServiceTest, SaysWhyItIsNotReady) {
  fleet.status_now.degraded = {{"broker", "the broker is not connected"},
                               {"store", "the store does not take writes: full"}};
  for (const bool broker : {false, true}) {
    fleet.status_now.broker_connected = broker;
    const auto response = get("/readyz");
    EXPECT_EQ(response.status, 503);
    EXPECT_EQ(response.body, R"({"status":"not ready","reasons":["the broker is not connected",)"
                             R"("the store does not take writes: full"]})");
  }
}

TEST_F(ServiceTest, IsReadyButDegradedWhereItStillDoesItsWork) {
  fleet.status_now.broker_connected = true;
  fleet.status_now.store_healthy = true;
  fleet.status_now.degraded = {{"clock", "the clock jumped by 3600 s"}};
  const auto response = get("/readyz");
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.body, R"({"status":"degraded","reasons":["the clock jumped by 3600 s"]})");
}

TEST_F(ServiceTest, CountsInPrometheusWords) {
  auto& status = fleet.status_now;
  status.version = "0.1.0";
  status.started = at_s(5);
  status.counts[static_cast<std::size_t>(core::Outcome::scored)] = 7;
  status.queued_scans = 1;
  status.queued_writes = 2;
  status.lost_writes = 3;
  status.broker_connected = true;
  status.judging.add(0.0025);
  status.judging.add(9.0);
  status.commits.add(0.004);
  fleet.robots_now.resize(2);
  fleet.robots_now[0].state = core::RobotState::kidnapped;
  EXPECT_TRUE(has_metric("# TYPE kidnapwatch_scans_total counter"));
  for (const char* line :
       {R"(kidnapwatch_scans_total{outcome="scored"} 7)", R"(kidnapwatch_robots{state="stale"} 0)",
        R"(kidnapwatch_scans_total{outcome="failed"} 0)",
        R"(kidnapwatch_robots{state="kidnapped"} 1)", R"(kidnapwatch_robots{state="unknown"} 1)",
        R"(kidnapwatch_scan_judging_seconds_bucket{le="0.001"} 0)",
        R"(kidnapwatch_scan_judging_seconds_bucket{le="0.0025"} 1)",
        R"(kidnapwatch_scan_judging_seconds_bucket{le="+Inf"} 2)",
        "kidnapwatch_scan_judging_seconds_count 2", "kidnapwatch_scan_judging_seconds_sum 9.0025",
        "kidnapwatch_store_commit_seconds_count 1", "kidnapwatch_queued_scans 1",
        "kidnapwatch_queued_writes 2", "kidnapwatch_lost_writes_total 3",
        "kidnapwatch_broker_connected 1", "kidnapwatch_store_healthy 0",
        "kidnapwatch_config_version 0", "kidnapwatch_start_time_seconds 5",
        R"(kidnapwatch_build_info{version="0.1.0"} 1)"}) {
    EXPECT_TRUE(has_metric(line)) << line << "\n" << get("/metrics").body;
  }
}

}  // namespace
}  // namespace kidnapwatch::api
