// SPDX-License-Identifier: Apache-2.0
// The service's two connections, seen from a robot and from a dashboard.
#include "adapters/mqtt/link.hpp"

#include <latch>

#include <gtest/gtest.h>

#include "tests/adapters/mqtt/inbox.hpp"
#include "tests/support/mosquitto.hpp"
#include "tests/support/proxy.hpp"

namespace kidnapwatch::adapters::mqtt {
namespace {

using namespace std::chrono_literals;

LinkConfig config_for(const std::string& url) {
  LinkConfig config;
  config.broker.url = url;
  config.broker.backoff_min = 10ms;
  config.broker.backoff_max = 100ms;
  config.topics.scan_filters = {"+/scan"};
  config.online = "online";
  config.stopped = "stopped";
  config.offline = "offline";
  return config;
}

Message message(std::string topic, std::string payload) {
  Message message;
  message.topic = std::move(topic);
  message.payload = std::move(payload);
  message.qos = 1;
  return message;
}

class LinkTest : public testing::Test {
 protected:
  void SetUp() override { broker_.start(); }

  /// A client that sees everything.
  void start_peer() {
    ClientConfig config;
    config.broker.url = broker_.url();
    config.broker.backoff_min = 10ms;
    config.broker.backoff_max = 100ms;
    config.subscriptions = {{.filter = "kidnapwatch/v1/#", .qos = 1}};
    peer_ = std::make_unique<Client>(config, seen_.events());
    peer_->start();
    ASSERT_TRUE(peer_->wait_connected(kPatience));
  }
  /// Until the link's subscription is at the broker.
  void await_link(Link& link) {
    ASSERT_TRUE(link.wait_connected(kPatience));
    ASSERT_TRUE(seen_.wait_payload("online"));
    while (letters_.letters().empty()) {  // the subscription may lag behind the connection
      peer_->publish(message("kidnapwatch/v1/ready", "?"));
      ASSERT_TRUE(peer_->drain(kPatience));
    }
  }
  LinkEvents events() {
    return {.on_message =
                [this](const Topic& topic, const Received& received) {
                  robots_.add({.topic = topic.robot,
                               .payload = received.payload,
                               .content_type = {},
                               .retained = false});
                  letters_.add(received);
                },
            .on_connected = {},
            .on_trouble = [this](const std::string& what) { letters_.add_trouble(what); }};
  }

  test::Mosquitto broker_;
  Inbox seen_;     // by the peer
  Inbox letters_;  // by the link
  Inbox robots_;   // by the link, with the robot's id for the topic
  std::unique_ptr<Client> peer_;
};

TEST_F(LinkTest, HandsOverScansWithTheRobotsId) {
  start_peer();
  Link link(config_for(broker_.url()), events());
  link.start();
  await_link(link);
  peer_->publish(message("kidnapwatch/v1/r1/scan", "by the standard topic"));
  peer_->publish(message("r2/scan", "by a further filter"));
  ASSERT_TRUE(robots_.wait_payload("by a further filter"));
  const auto letters = robots_.letters();
  ASSERT_GE(letters.size(), 3U);
  EXPECT_EQ(letters[letters.size() - 2].topic, "r1");
  EXPECT_EQ(letters.back().topic, "r2");
}

TEST_F(LinkTest, HandsOverWhatIsUnknownButNothingOfItsOwn) {
  start_peer();
  Link link(config_for(broker_.url()), events());
  link.start();
  await_link(link);
  link.publish_alert("r1", "alert", "kidnapwatch/alert/1");
  link.publish_state("r1", "state", "kidnapwatch/state/1");
  link.publish_score("r1", "score", "kidnapwatch/score/1");
  ASSERT_TRUE(seen_.wait_payload("score"));
  peer_->publish(message("kidnapwatch/v1/r1/map", "unknown"));
  ASSERT_TRUE(letters_.wait_payload("unknown"));
  for (const Letter& letter : letters_.letters()) {
    EXPECT_TRUE(letter.topic == "kidnapwatch/v1/ready" || letter.payload == "unknown")
        << letter.topic;
  }
}

TEST_F(LinkTest, PublishesInOrderAndTellsOfDelivery) {
  start_peer();
  Link link(config_for(broker_.url()), events());
  link.start();
  std::latch delivered{1};
  link.publish_state("r1", "suspect", "kidnapwatch/state/1");
  link.publish_alert("r1", "opened", "kidnapwatch/alert/1", [&] { delivered.count_down(); });
  link.publish_state("r1", "kidnapped", "kidnapwatch/state/1");
  delivered.wait();
  ASSERT_TRUE(seen_.wait_payload("kidnapped"));
  std::vector<std::string> payloads;
  for (const Letter& letter : seen_.letters()) {
    if (letter.topic != "kidnapwatch/v1/service/status") {
      payloads.push_back(letter.payload);
      EXPECT_EQ(letter.content_type, "application/json");
    }
  }
  EXPECT_EQ(payloads, (std::vector<std::string>{"suspect", "opened", "kidnapped"}));
}

TEST_F(LinkTest, TellsWhatIsRetainedEvenAsItIsSaid) {
  start_peer();
  Link link(config_for(broker_.url()), events());
  link.start();
  await_link(link);
  Message kept = message("kidnapwatch/v1/r1/command", "kept");
  kept.retain = true;
  peer_->publish(std::move(kept));
  ASSERT_TRUE(letters_.wait_payload("kept"));
  EXPECT_TRUE(letters_.letters().back().retained);
}

TEST_F(LinkTest, AnswersWhereThatIsAllowed) {
  start_peer();
  Link link(config_for(broker_.url()), events());
  link.start();
  await_link(link);
  EXPECT_FALSE(link.publish_response("r1", "kidnapwatch/v1/r2/alert", "forged", "s", "7"));
  EXPECT_TRUE(link.publish_response("r1", "kidnapwatch/v1/r1/response", "done", "s", "7"));
  ASSERT_TRUE(seen_.wait_payload("done"));
  EXPECT_EQ(seen_.letters().back().correlation, "7");
  EXPECT_EQ(std::ranges::count(seen_.letters(), "forged", &Letter::payload), 0);
}

TEST_F(LinkTest, RetainsStateAndStatusForThoseWhoComeLater) {
  Link link(config_for(broker_.url()), events());
  link.start();
  link.publish_state("r1", "normal", "kidnapwatch/state/1");
  link.publish_alert("r1", "alert", "kidnapwatch/alert/1");
  ASSERT_TRUE(link.wait_connected(kPatience));
  link.stop(kPatience);
  start_peer();
  ASSERT_TRUE(seen_.wait_count(2));
  for (const Letter& letter : seen_.letters()) {
    EXPECT_TRUE(letter.retained);
    EXPECT_EQ(letter.payload, letter.topic == "kidnapwatch/v1/r1/state" ? "normal" : "stopped");
  }
}

TEST_F(LinkTest, IsOfflineWhenItVanishesAndOnlineWhenItIsBack) {
  start_peer();
  test::Proxy proxy(broker_.port());
  Link link(config_for(proxy.url()), events());
  link.start();
  ASSERT_TRUE(seen_.wait_payload("online"));
  proxy.cut();
  ASSERT_TRUE(seen_.wait([](const std::vector<Letter>& letters) {
    const auto offline = std::ranges::find(letters, "offline", &Letter::payload);
    return std::find_if(offline, letters.end(), [](const Letter& letter) {
             return letter.payload == "online";
           }) != letters.end();
  }));
}

TEST_F(LinkTest, TellsOfEveryConnectSoThatAlertsCanBeRepeated) {
  start_peer();
  test::Proxy proxy(broker_.port());
  Link* link = nullptr;
  std::atomic<int> connects = 0;
  LinkEvents repeating = events();
  repeating.on_connected = [&] {
    link->publish_alert("r1", "announcement " + std::to_string(++connects), "s");
  };
  Link owned(config_for(proxy.url()), repeating);
  link = &owned;
  owned.start();
  ASSERT_TRUE(seen_.wait_payload("announcement 1"));
  proxy.cut();
  ASSERT_TRUE(seen_.wait_payload("announcement 2"));
}

TEST_F(LinkTest, SurvivesAnAgitatedBroker) {
  start_peer();
  Link link(config_for(broker_.url()), events());
  link.start();
  std::atomic<int> delivered = 0;
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < 20; ++i) {
      link.publish_alert("r1", std::to_string(20 * round + i), "s", [&] { ++delivered; });
    }
    broker_.kill();
    broker_.start();
  }
  ASSERT_TRUE(link.wait_connected(kPatience));
  link.stop(kPatience);
  EXPECT_EQ(delivered, 100);
}

}  // namespace
}  // namespace kidnapwatch::adapters::mqtt
