// SPDX-License-Identifier: Apache-2.0
// The broker as deploy/mosquitto-tls.conf sets it up: who can say what, and in whose name.
#include <csignal>
#include <fstream>
#include <regex>

#include <gtest/gtest.h>

#include "tests/e2e/stack.hpp"
#include "tests/support/sockets.hpp"

namespace kidnapwatch::test {
namespace {

class BrokerAccess : public ::testing::Test {
 protected:
  void SetUp() override {
    sh("for ca in robots operators strangers; do openssl req -x509 -newkey ec -pkeyopt "
       "ec_paramgen_curve:P-256 -nodes -days 2 -subj /CN=$ca -keyout $ca-ca.key -out $ca-ca.crt; "
       "done; cat robots-ca.crt operators-ca.crt > trusted.crt");
    certify("broker", "operators", "127.0.0.1");
    for (const char* robot : {"r1", "r2", "kidnapwatch-out"}) certify(robot, "robots", robot);
    for (const char* user : {"kidnapwatch", "dashboard", "controller"})
      certify(user, "operators", user);
    start_broker();
  }

  void sh(const std::string& script) const {
    (void)output_of({"sh", "-c", "cd " + folder().string() + " && (" + script + ") 2>>sh.log"});
  }
  /// `name`.key and `name`.crt of `cn`, signed by this authority.
  void certify(const std::string& name, const std::string& ca, const std::string& cn) const {
    sh("openssl req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -subj /CN=" + cn +
       " -keyout " + name + ".key -out " + name +
       ".csr && printf subjectAltName=IP:127.0.0.1 >san" + " && openssl x509 -req -in " + name +
       ".csr -CA " + ca + "-ca.crt -CAkey " + ca +
       "-ca.key -CAcreateserial -days 2 -extfile san -out " + name + ".crt");
  }

  /// The shipped files, with paths and ports of this test.
  void start_broker() {
    std::string text = content_of(KW_DEPLOY "/mosquitto-tls.conf");
    const std::string here = folder().string();
    for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
             {"/etc/mosquitto/certs", here},
             {"/etc/mosquitto/mosquitto.acl", KW_DEPLOY "/mosquitto.acl"},
             {"/var/lib/mosquitto/", here + "/"},
             {"listener 8883", "listener " + std::to_string(robots_port_) + " 127.0.0.1"},
             {"listener 8884", "listener " + std::to_string(operators_port_) + " 127.0.0.1"}}) {
      text = std::regex_replace(text, std::regex(from), to);
    }
    std::ofstream(folder() / "mosquitto.conf") << "user root\n" << text;
    const char* program =
        std::filesystem::exists("/usr/sbin/mosquitto") ? "/usr/sbin/mosquitto" : "mosquitto";
    broker_ = std::make_unique<Process>(
        std::vector<std::string>{program, "-c", (folder() / "mosquitto.conf").string()},
        folder() / "broker.out", folder() / "broker.log");
    ASSERT_TRUE(eventually([&] { return static_cast<bool>(connected_to(operators_port_)); }))
        << content_of(folder() / "broker.log");
  }

  [[nodiscard]] std::vector<std::string> tls(const std::string& program, const std::string& user,
                                             std::uint16_t port) const {
    const std::string here = folder().string() + "/";
    return {program,
            "-h",
            "127.0.0.1",
            "-p",
            std::to_string(port),
            "--cafile",
            here + "trusted.crt",
            "--cert",
            here + user + ".crt",
            "--key",
            here + user + ".key",
            "-q",
            "1"};
  }
  /// Whether the broker lets `user` in to publish this; where it is not allowed to, silently drops.
  bool publish(const std::string& user, std::uint16_t port, const std::string& topic,
               const std::string& payload) const {
    auto words = tls("mosquitto_pub", user, port);
    words.insert(words.end(), {"-t", topic, "-m", payload});
    Process process(words, folder() / "pub.out", folder() / "pub.log");
    return process.wait() == 0;
  }
  /// Everything from now on, by who may hear everything.
  void listen() {
    auto words = tls("mosquitto_sub", "dashboard", operators_port_);
    words.insert(words.end(), {"-t", "kidnapwatch/v1/#", "-F", "%t %p"});
    listener_ = std::make_unique<Process>(words, folder() / "heard", folder() / "sub.log");
    ASSERT_TRUE(eventually([&] {
      EXPECT_TRUE(publish("kidnapwatch", operators_port_, "kidnapwatch/v1/ping", "ping"));
      return heard("kidnapwatch/v1/ping ping");
    }));
  }
  [[nodiscard]] bool heard(const std::string& line) const {
    return content_of(folder() / "heard").find(line) != std::string::npos;
  }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }

  TemporaryFolder folder_;
  const std::uint16_t robots_port_ = free_port();
  const std::uint16_t operators_port_ = free_port();
  std::unique_ptr<Process> broker_;
  std::unique_ptr<Process> listener_;
};

TEST_F(BrokerAccess, ARobotSpeaksForItselfAndForNobodyElse) {
  listen();
  EXPECT_TRUE(publish("r1", robots_port_, "kidnapwatch/v1/r2/scan", "as another"));
  EXPECT_TRUE(publish("r1", robots_port_, "kidnapwatch/v1/r1/alert", "forged"));
  EXPECT_TRUE(publish("r1", robots_port_, "kidnapwatch/v1/service/status", "forged"));
  EXPECT_TRUE(publish("r1", robots_port_, "kidnapwatch/v1/r1/scan", "its own"));
  ASSERT_TRUE(eventually([&] { return heard("kidnapwatch/v1/r1/scan its own"); }));
  EXPECT_FALSE(heard("as another"));
  EXPECT_FALSE(heard("forged"));
}

TEST_F(BrokerAccess, CommandsComeFromTheRobotItselfAndTheController) {
  listen();
  EXPECT_TRUE(publish("r1", robots_port_, "kidnapwatch/v1/r2/command", "as another"));
  EXPECT_TRUE(publish("dashboard", operators_port_, "kidnapwatch/v1/r1/command", "as a watcher"));
  EXPECT_TRUE(publish("r1", robots_port_, "kidnapwatch/v1/r1/response", "forged"));
  EXPECT_TRUE(publish("r1", robots_port_, "kidnapwatch/v1/r1/command", "its own"));
  EXPECT_TRUE(publish("controller", operators_port_, "kidnapwatch/v1/r1/command", "from above"));
  ASSERT_TRUE(eventually([&] { return heard("kidnapwatch/v1/r1/command from above"); }));
  EXPECT_TRUE(heard("kidnapwatch/v1/r1/command its own"));
  EXPECT_FALSE(heard("as another"));
  EXPECT_FALSE(heard("as a watcher"));
  EXPECT_FALSE(heard("forged"));
}

TEST_F(BrokerAccess, ARobotCannotEvictTheService) {
  Stack stack;
  stack.broker_url = "mqtts://127.0.0.1:" + std::to_string(operators_port_);
  const std::string here = folder().string() + "/";
  stack.start_service({"--mqtt-ca-file", here + "operators-ca.crt", "--mqtt-cert-file",
                       here + "kidnapwatch.crt", "--mqtt-key-file", here + "kidnapwatch.key"});
  stack.await_ready();
  for (const auto port : {robots_port_, operators_port_}) {
    auto words = tls("mosquitto_pub", "r1", port);
    words.insert(words.end(), {"-i", "kidnapwatch-out", "-t", "kidnapwatch/v1/r1/scan", "-m", "x"});
    Process evictor(words, folder() / "evict.out", folder() / "evict.log");
    EXPECT_EQ(evictor.wait() == 0, port == robots_port_);  // the operators' port refuses robots
  }
  // Even one that an authority for robots named so stays away from the service's connections.
  (void)publish("kidnapwatch-out", operators_port_, "kidnapwatch/v1/x/scan", "x");
  EXPECT_EQ(stack.service_log().find("connection lost"), std::string::npos) << stack.service_log();
  EXPECT_EQ(stack.status_of("/readyz"), 200);
}

TEST_F(BrokerAccess, TheServiceRefusesABrokerWithAWrongCertificate) {
  Stack stack;
  stack.broker_url = "mqtts://127.0.0.1:" + std::to_string(operators_port_);
  const std::string here = folder().string() + "/";
  stack.start_service({"--mqtt-ca-file", here + "strangers-ca.crt", "--mqtt-cert-file",
                       here + "kidnapwatch.crt", "--mqtt-key-file", here + "kidnapwatch.key"});
  EXPECT_TRUE(
      eventually([&] { return stack.service_log().find("connecting") != std::string::npos; }));
  EXPECT_EQ(stack.status_of("/readyz"), 503);
}

}  // namespace
}  // namespace kidnapwatch::test
