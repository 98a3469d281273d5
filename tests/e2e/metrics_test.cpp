// SPDX-License-Identifier: Apache-2.0
// What Prometheus itself thinks of the metrics and of the alert rules for them.
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/e2e/stack.hpp"

namespace kidnapwatch::test {
namespace {

class Metrics : public ::testing::Test {
 protected:
  void SetUp() override {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): one thread
    if (std::system("command -v promtool > /dev/null") != 0) {
      GTEST_SKIP() << "promtool (Debian's prometheus) is not installed";
    }
  }
};

TEST_F(Metrics, ArePlainToPrometheus) {
  Stack stack;
  stack.start_service();
  stack.await_ready();
  const Json sent = stack.robots(
      {"simulate", "--robots", "2", "--rate", "5", "--duration", "20", "--speed", "10"});
  ASSERT_TRUE(eventually([&] { return stack.counted() >= sent.at("scans"); }));
  const std::string metrics = stack.get_text("/metrics");
  const auto count = "\nkidnapwatch_scan_judging_seconds_count " + sent.at("scans").dump() + "\n";
  EXPECT_NE(metrics.find(count), std::string::npos) << metrics;
  const auto file = stack.broker.folder() / "metrics";
  std::ofstream(file) << metrics;
  EXPECT_EQ(output_of({"sh", "-c", "promtool check metrics < " + file.string() + " 2>&1"}), "");
}

TEST_F(Metrics, RaiseTheAlertsThatTheRulesPromise) {
  const auto said =
      output_of({"promtool", "test", "rules", KW_SOURCE "/tests/e2e/kidnapwatch.rules_test.yml"});
  EXPECT_NE(said.find("SUCCESS"), std::string::npos) << said;
}

}  // namespace
}  // namespace kidnapwatch::test
