// SPDX-License-Identifier: Apache-2.0
// The broker as deploy/mosquitto-tls.conf sets it up: who can say what, and in whose name.
#include <gtest/gtest.h>

#include "tests/e2e/stack.hpp"
#include "tests/e2e/tls_broker.hpp"

namespace kidnapwatch::test {
namespace {

class BrokerAccess : public ::testing::Test {
 protected:
  /// Whether the broker lets `user` in to publish this; where it is not allowed to, silently drops.
  bool publish(const std::string& user, std::uint16_t port, const std::string& topic,
               const std::string& payload) const {
    auto words = broker_.words("mosquitto_pub", user, port);
    words.insert(words.end(), {"-t", topic, "-m", payload});
    Process process(words, folder_.path() / "pub.out", folder_.path() / "pub.log");
    return process.wait() == 0;
  }
  /// Everything from now on, by who may hear everything.
  void listen() {
    auto words = broker_.words("mosquitto_sub", "dashboard", broker_.operators_port);
    words.insert(words.end(), {"-t", "kidnapwatch/v1/#", "-F", "%t %p"});
    listener_ =
        std::make_unique<Process>(words, folder_.path() / "heard", folder_.path() / "sub.log");
    ASSERT_TRUE(eventually([&] {
      EXPECT_TRUE(publish("kidnapwatch", broker_.operators_port, "kidnapwatch/v1/ping", "ping"));
      return heard("kidnapwatch/v1/ping ping");
    }));
  }
  [[nodiscard]] bool heard(const std::string& line) const {
    return content_of(folder_.path() / "heard").find(line) != std::string::npos;
  }

  TemporaryFolder folder_;
  const TlsBroker broker_{{"r1", "r2", "kidnapwatch-out"}};
  std::unique_ptr<Process> listener_;
};

TEST_F(BrokerAccess, ARobotSpeaksForItselfAndForNobodyElse) {
  listen();
  EXPECT_TRUE(publish("r1", broker_.robots_port, "kidnapwatch/v1/r2/scan", "as another"));
  EXPECT_TRUE(publish("r1", broker_.robots_port, "kidnapwatch/v1/r1/alert", "forged"));
  EXPECT_TRUE(publish("r1", broker_.robots_port, "kidnapwatch/v1/service/status", "forged"));
  EXPECT_TRUE(publish("r1", broker_.robots_port, "kidnapwatch/v1/r1/scan", "its own"));
  ASSERT_TRUE(eventually([&] { return heard("kidnapwatch/v1/r1/scan its own"); }));
  EXPECT_FALSE(heard("as another"));
  EXPECT_FALSE(heard("forged"));
}

TEST_F(BrokerAccess, CommandsComeFromTheRobotItselfAndTheController) {
  listen();
  EXPECT_TRUE(publish("r1", broker_.robots_port, "kidnapwatch/v1/r2/command", "as another"));
  EXPECT_TRUE(
      publish("dashboard", broker_.operators_port, "kidnapwatch/v1/r1/command", "as a watcher"));
  EXPECT_TRUE(publish("r1", broker_.robots_port, "kidnapwatch/v1/r1/response", "forged"));
  EXPECT_TRUE(publish("r1", broker_.robots_port, "kidnapwatch/v1/r1/command", "its own"));
  EXPECT_TRUE(
      publish("controller", broker_.operators_port, "kidnapwatch/v1/r1/command", "from above"));
  ASSERT_TRUE(eventually([&] { return heard("kidnapwatch/v1/r1/command from above"); }));
  EXPECT_TRUE(heard("kidnapwatch/v1/r1/command its own"));
  EXPECT_FALSE(heard("as another"));
  EXPECT_FALSE(heard("as a watcher"));
  EXPECT_FALSE(heard("forged"));
}

TEST_F(BrokerAccess, ARobotCannotEvictTheService) {
  Stack stack;
  stack.broker_url = broker_.service_url();
  stack.start_service(broker_.service_flags());
  stack.await_ready();
  for (const auto port : {broker_.robots_port, broker_.operators_port}) {
    auto words = broker_.words("mosquitto_pub", "r1", port);
    words.insert(words.end(), {"-i", "kidnapwatch-out", "-t", "kidnapwatch/v1/r1/scan", "-m", "x"});
    Process evictor(words, folder_.path() / "evict.out", folder_.path() / "evict.log");
    EXPECT_EQ(evictor.wait() == 0,
              port == broker_.robots_port);  // the operators' port refuses robots
  }
  // Even one that an authority for robots named so stays away from the service's connections.
  (void)publish("kidnapwatch-out", broker_.operators_port, "kidnapwatch/v1/x/scan", "x");
  EXPECT_EQ(stack.service_log().find("connection lost"), std::string::npos) << stack.service_log();
  EXPECT_EQ(stack.status_of("/readyz"), 200);
}

TEST_F(BrokerAccess, TheServiceRefusesABrokerWithAWrongCertificate) {
  Stack stack;
  stack.broker_url = broker_.service_url();
  stack.start_service(broker_.service_flags("strangers"));
  EXPECT_TRUE(
      eventually([&] { return stack.service_log().find("connecting") != std::string::npos; }));
  EXPECT_EQ(stack.status_of("/readyz"), 503);
}

}  // namespace
}  // namespace kidnapwatch::test
