// SPDX-License-Identifier: Apache-2.0
// One client against a real broker that is killed, comes late, refuses, or hangs.
#include "adapters/mqtt/client.hpp"

#include <array>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <latch>
#include <numeric>

#include <gtest/gtest.h>
#include <sys/socket.h>

#include "core/bad_input.hpp"
#include "tests/adapters/mqtt/inbox.hpp"
#include "tests/support/mosquitto.hpp"
#include "tests/support/proxy.hpp"

namespace kidnapwatch::adapters::mqtt {
namespace {

using namespace std::chrono_literals;
using test::Mosquitto;
using test::Proxy;

ClientConfig config_for(const std::string& url) {
  ClientConfig config;
  config.broker.url = url;
  config.broker.backoff_min = 10ms;
  config.broker.backoff_max = 100ms;
  return config;
}

ClientConfig subscribed(const std::string& url, const std::string& filter = "#") {
  ClientConfig config = config_for(url);
  config.subscriptions = {{.filter = filter, .qos = 1}};
  return config;
}

Message message(std::string topic, std::string payload, int qos = 1) {
  Message message;
  message.topic = std::move(topic);
  message.payload = std::move(payload);
  message.qos = qos;
  return message;
}

/// A client that is at the broker; its subscription may lag behind.
struct Connected {
  Inbox inbox;
  Client client;

  explicit Connected(const ClientConfig& config) : client(config, inbox.events()) {
    client.start();
    EXPECT_TRUE(client.wait_connected(kPatience));
  }
  /// Returns with an empty inbox. `topic` passes the filter.
  void await_subscription(const std::string& topic = "subscribed") {
    client.publish(message(topic, "yes"));
    ASSERT_TRUE(inbox.wait_payload("yes"));
    inbox.clear();
  }
};

class ClientTest : public testing::Test {
 protected:
  Mosquitto broker_;
};

class RunningClientTest : public ClientTest {
 protected:
  void SetUp() override { broker_.start(); }
};

TEST_F(RunningClientTest, DeliversWithPropertiesByMqtt5) {
  Connected peer(subscribed(broker_.url()));
  peer.await_subscription();
  std::latch delivered{1};
  Message sent = message("a/b", std::string("\0\xFF", 2));
  sent.content_type = "application/cbor";
  sent.schema = "kidnapwatch/alert/1";
  sent.correlation = std::string("\0\x01", 2);
  sent.expiry = 60s;
  sent.on_delivered = [&] { delivered.count_down(); };
  peer.client.publish(std::move(sent));
  delivered.wait();
  ASSERT_TRUE(peer.inbox.wait_count(1));
  EXPECT_EQ(peer.inbox.letters()[0], (Letter{"a/b", std::string("\0\xFF", 2), "application/cbor",
                                             false, "", std::string("\0\x01", 2)}));
  EXPECT_EQ(peer.client.stats().protocol, 5);
}

TEST_F(RunningClientTest, DeliversEmptyPayloads) {
  Connected peer(subscribed(broker_.url()));
  peer.client.publish(message("a", ""));
  ASSERT_TRUE(peer.inbox.wait_payload(""));
}

TEST_F(ClientTest, ConnectsWhenTheBrokerComesLate) {
  Inbox inbox;
  Client client(subscribed(broker_.url()), inbox.events());
  client.start();
  client.publish(message("a", "early"));
  ASSERT_TRUE(inbox.wait_trouble("connecting"));
  EXPECT_FALSE(client.connected());
  broker_.start();
  EXPECT_TRUE(client.drain(kPatience));
  EXPECT_TRUE(inbox.wait_payload("early"));
}

TEST_F(ClientTest, TellsOfAnAbsentBrokerOnce) {
  std::atomic<int> told = 0;
  ClientEvents events;
  events.on_trouble = [&](const std::string& /*what*/) { ++told; };
  Client client(config_for(broker_.url()), std::move(events));
  client.start();
  EXPECT_FALSE(client.wait_connected(1s));  // some ten attempts
  EXPECT_EQ(told, 1);
}

TEST_F(RunningClientTest, ComesBackAfterTheBrokerWasKilled) {
  Connected peer(subscribed(broker_.url()));
  peer.await_subscription();
  for (int round = 0; round < 3; ++round) {
    broker_.kill();
    for (int i = 0; i < 10; ++i) {
      peer.client.publish(message("a", std::to_string(10 * round + i)));
    }
    broker_.start();
    ASSERT_TRUE(peer.client.drain(kPatience));
  }
  for (int i = 0; i < 30; ++i) {
    EXPECT_TRUE(peer.inbox.wait_payload(std::to_string(i))) << i;
  }
  EXPECT_EQ(peer.client.stats().dropped, 0U);
}

TEST_F(RunningClientTest, LosesNoQos1MessageWhileConnectionsAreCut) {
  Proxy proxy(broker_.port());
  Connected receiver(subscribed(broker_.url(), "a"));
  receiver.await_subscription("a");
  Connected sender(config_for(proxy.url()));
  constexpr int kCount = 2000;
  for (int i = 0; i < kCount; ++i) {
    sender.client.publish(message("a", std::to_string(i)));
    if (i % 250 == 100) {
      proxy.cut();
    }
  }
  ASSERT_TRUE(sender.client.drain(kPatience));
  EXPECT_EQ(sender.client.stats().delivered, static_cast<std::uint64_t>(kCount));
  ASSERT_TRUE(receiver.inbox.wait_payload(std::to_string(kCount - 1)));
  int next = 0;  // repetitions apart, all came, in order
  for (const Letter& letter : receiver.inbox.letters()) {
    const int number = std::stoi(letter.payload);
    ASSERT_LE(number, next);
    next = std::max(next, number + 1);
  }
  EXPECT_EQ(next, kCount);
}

TEST_F(RunningClientTest, NoticesAConnectionThatIsHalfOpen) {
  Proxy proxy(broker_.port());
  ClientConfig config = subscribed(proxy.url());
  config.broker.keep_alive = 1s;
  Connected peer(config);
  proxy.swallow(true);
  peer.client.publish(message("a", "into the void"));
  ASSERT_TRUE(peer.inbox.wait_trouble("connection lost"));
  proxy.swallow(false);
  EXPECT_TRUE(peer.inbox.wait_payload("into the void"));
}

TEST_F(RunningClientTest, LeavesALastWillIfItVanishes) {
  Proxy proxy(broker_.port());
  Connected receiver(subscribed(broker_.url(), "status"));
  receiver.await_subscription("status");
  ClientConfig config = config_for(proxy.url());
  config.last_will = message("status", "gone");
  config.broker.backoff_min = config.broker.backoff_max = 60s;  // and does not come back
  Connected sender(config);
  proxy.cut();
  EXPECT_TRUE(receiver.inbox.wait_payload("gone"));
}

TEST_F(RunningClientTest, LeavesNoLastWillIfItStops) {
  Connected receiver(subscribed(broker_.url(), "#"));
  receiver.await_subscription();
  ClientConfig config = config_for(broker_.url());
  config.last_will = message("status", "gone");
  Connected sender(config);
  sender.client.publish(message("status", "goodbye"));
  sender.client.stop(kPatience);
  ASSERT_TRUE(receiver.inbox.wait_payload("goodbye"));
  receiver.client.publish(message("status", "after"));
  ASSERT_TRUE(receiver.inbox.wait_payload("after"));
  EXPECT_EQ(receiver.inbox.letters().size(), 2U);
}

TEST_F(RunningClientTest, PassesAFloodThroughItsWindow) {
  Connected receiver(subscribed(broker_.url(), "+/scan"));
  receiver.await_subscription("r/scan");
  ClientConfig config = config_for(broker_.url());
  config.queue = {.max_queued = 200, .max_in_flight = 50};
  Connected sender(config);
  constexpr int kCount = 5'000;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kCount; ++i) {
    ASSERT_TRUE(sender.client.wait_for_room(kPatience));
    sender.client.publish(
        message("r" + std::to_string(i % 100) + "/scan", std::string(1500, 'x'), 0));
  }
  ASSERT_TRUE(sender.client.drain(kPatience));
  ASSERT_TRUE(receiver.inbox.wait_count(kCount));
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  std::cout << "flood: " << kCount / taken.count() << " messages of 1.5 kB per second\n";
  EXPECT_EQ(sender.client.stats().dropped, 0U);
}

TEST_F(RunningClientTest, DropsTheOldestOfAFloodThatDoesNotWait) {
  ClientConfig config = config_for(broker_.url());
  config.queue = {.max_queued = 100, .max_in_flight = 10};
  Connected sender(config);
  constexpr std::uint64_t kCount = 20'000;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    sender.client.publish(message("a", std::string(1500, 'x')));
  }
  ASSERT_TRUE(sender.client.drain(kPatience));
  const ClientStats stats = sender.client.stats();
  EXPECT_EQ(stats.delivered + stats.dropped, kCount);
}

TEST_F(RunningClientTest, ConfirmsQos1WithoutWaitingForNagle) {
  Connected sender(config_for(broker_.url()));
  std::vector<double> took_ms;
  for (int i = 0; i < 50; ++i) {
    const auto start = std::chrono::steady_clock::now();
    sender.client.publish(message("a", std::string(600, 'x')));
    ASSERT_TRUE(sender.client.drain(kPatience));
    took_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
            .count());
  }
  EXPECT_EQ(sender.client.stats().delivered, 50U);
  std::ranges::sort(took_ms);
  std::cout << "QoS 1 confirmed after " << took_ms[25] << " ms (median of 50)\n";
}

TEST_F(RunningClientTest, CountsAndTellsWhatCannotBeSent) {
  Connected peer(config_for(broker_.url()));
  for (const std::string& topic : {std::string("wild/#"), std::string("wild/+"), std::string(),
                                   std::string("a\0b", 3), std::string("\xFF")}) {
    peer.client.publish(message(topic, "never sent"));
  }
  peer.client.publish(message("a", "sent"));
  ASSERT_TRUE(peer.client.drain(kPatience));
  EXPECT_TRUE(peer.inbox.wait_trouble("not sendable"));
  EXPECT_EQ(peer.client.stats().refused, 5U);
  EXPECT_EQ(peer.client.stats().delivered, 1U);
  EXPECT_EQ(peer.client.stats().connects, 1U);
}

TEST(Client, TellsWhatTheBrokerForbids) {
  Mosquitto broker;
  const std::string file = broker.folder() / "acl";
  std::ofstream(file) << "topic readwrite allowed\n";
  std::ofstream(broker.folder() / "mosquitto.conf", std::ios::app) << "acl_file " << file << "\n";
  broker.start();
  Connected peer(config_for(broker.url()));
  peer.client.publish(message("forbidden", ""));
  peer.client.publish(message("allowed", ""));
  ASSERT_TRUE(peer.client.drain(kPatience));
  EXPECT_TRUE(peer.inbox.wait_trouble("message on forbidden refused by the broker (code 135)"));
  EXPECT_EQ(peer.client.stats().refused, 1U);
  EXPECT_EQ(peer.client.stats().delivered, 1U);
}

TEST_F(ClientTest, StopsAtOnceWithoutABroker) {
  Client client(config_for(broker_.url()), {});
  client.start();
  client.publish(message("a", "never sent"));
  client.stop(kPatience);
  EXPECT_EQ(client.stats().queued, 1U);
}

TEST_F(ClientTest, NeedNotBeStarted) { const Client client(config_for(broker_.url()), {}); }

TEST(Client, RefusesUrlsThatAreNone) {
  for (const char* url : {"", "localhost:1883", "http://localhost", "mqtt://"}) {
    EXPECT_THROW(Client(config_for(url), {}), core::BadInput) << url;
  }
}

TEST(Client, RefusesNothingButReportsAHostThatIsNone) {
  Inbox inbox;
  Client client(config_for("mqtt://no.such.host.invalid:1883"), inbox.events());
  client.start();
  EXPECT_TRUE(inbox.wait_trouble("connecting"));
}

TEST(Client, ShowsItsPassword) {
  Mosquitto broker("allow_anonymous false");
  const std::string file = broker.folder() / "passwords";
  ASSERT_EQ(std::system(("mosquitto_passwd -b -c " + file + " service secret").c_str()), 0);
  std::ofstream(broker.folder() / "mosquitto.conf", std::ios::app)
      << "password_file " << file << "\n";
  broker.start();
  ClientConfig config = config_for(broker.url());
  config.broker.username = "service";
  config.broker.password = "wrong";
  Inbox inbox;
  Client stranger(config, inbox.events());
  stranger.start();
  EXPECT_TRUE(inbox.wait_trouble("refused by the broker"));
  config.broker.password = "secret";
  const Connected friendly(config);
}

/// Keys and certificates in `folder`: an authority's (ca), and 127.0.0.1's by it (broker).
void make_certificates(const std::filesystem::path& folder) {
  const std::string command =
      "cd " + folder.string() +
      " && exec >openssl.log 2>&1"
      " && openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2"
      "    -subj /CN=ca -keyout ca.key -out ca.crt"
      " && openssl req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -subj /CN=127.0.0.1"
      "    -keyout broker.key -out broker.csr"
      " && printf 'subjectAltName=IP:127.0.0.1' >san"
      " && openssl x509 -req -in broker.csr -CA ca.crt -CAkey ca.key -CAcreateserial -days 2"
      "    -extfile san -out broker.crt";
  ASSERT_EQ(std::system(command.c_str()), 0);
}

TEST(Client, SpeaksTlsWithABrokerItTrusts) {
  Mosquitto broker;
  make_certificates(broker.folder());
  std::ofstream(broker.folder() / "mosquitto.conf", std::ios::app)
      << "certfile " << (broker.folder() / "broker.crt").string() << "\nkeyfile "
      << (broker.folder() / "broker.key").string() << "\n";
  broker.start();
  ClientConfig config = subscribed("mqtts://127.0.0.1:" + std::to_string(broker.port()));
  Inbox inbox;
  Client suspicious(config, inbox.events());
  suspicious.start();
  EXPECT_TRUE(inbox.wait_trouble("connecting"));
  config.broker.ca_file = broker.folder() / "ca.crt";
  Connected trusting(config);
  trusting.client.publish(message("a", "secret"));
  EXPECT_TRUE(trusting.inbox.wait_payload("secret"));
  EXPECT_FALSE(suspicious.connected());
}

/// A broker of 2015: refuses MQTT 5 as version 3.1.1 says, and accepts 3.1.1.
class OldBroker {
 public:
  OldBroker() : listener_(test::listening(0)), port_(test::port_of(listener_)) {
    thread_ = std::thread([this] { run(); });
  }
  ~OldBroker() { thread_.join(); }
  [[nodiscard]] std::string url() const { return "mqtt://127.0.0.1:" + std::to_string(port_); }
  [[nodiscard]] std::string levels() const { return levels_; }

 private:
  void run() {
    for (bool accepted = false; !accepted;) {
      const test::Socket peer(::accept(listener_.fd(), nullptr, nullptr));
      std::array<char, 256> connect{};
      ::recv(peer.fd(), connect.data(), connect.size(), 0);
      const char level = connect[8];  // fixed header 2, "MQTT" 6
      levels_ += static_cast<char>('0' + level);
      accepted = level == 4;
      const std::array<char, 4> answer = {0x20, 0x02, 0x00, static_cast<char>(accepted ? 0 : 1)};
      ::send(peer.fd(), answer.data(), answer.size(), MSG_NOSIGNAL);
      while (accepted && ::recv(peer.fd(), connect.data(), connect.size(), 0) > 0) {
      }
    }
  }

  test::Socket listener_;
  std::uint16_t port_;
  std::string levels_;
  std::thread thread_;
};

TEST(Client, FallsBackToMqtt311) {
  OldBroker broker;
  {
    Connected peer(config_for(broker.url()));
    EXPECT_EQ(peer.client.stats().protocol, 4);
  }
  EXPECT_EQ(broker.levels(), "54");
}

}  // namespace
}  // namespace kidnapwatch::adapters::mqtt
