// SPDX-License-Identifier: Apache-2.0
// The outgoing queue keeps order and bounds, and loses only what it counts.
#include "adapters/mqtt/send_queue.hpp"

#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kidnapwatch::adapters::mqtt {
namespace {

std::shared_ptr<const Message> message(const std::string& payload, int qos = 1) {
  Message message;
  message.payload = payload;
  message.qos = qos;
  return std::make_shared<const Message>(std::move(message));
}

/// Payloads of all that the queue gives out now, in order.
std::string sent(SendQueue& queue) {
  std::string payloads;
  while (const auto sending = queue.next()) {
    payloads += sending->message->payload;
  }
  return payloads;
}

TEST(SendQueue, GivesOutInOrder) {
  SendQueue queue({});
  queue.connection_made();
  for (const char* payload : {"a", "b", "c"}) {
    queue.push(message(payload));
  }
  EXPECT_EQ(sent(queue), "abc");
  EXPECT_EQ(queue.in_flight(), 3U);
}

TEST(SendQueue, GivesOutNothingWithoutConnection) {
  SendQueue queue({});
  queue.push(message("a"));
  EXPECT_EQ(sent(queue), "");
  queue.connection_made();
  EXPECT_EQ(sent(queue), "a");
}

TEST(SendQueue, KeepsToItsWindow) {
  SendQueue queue({.max_queued = 10, .max_in_flight = 2});
  queue.connection_made();
  for (const char* payload : {"a", "b", "c"}) {
    queue.push(message(payload));
  }
  const auto first = queue.next();
  (void)queue.next();
  EXPECT_FALSE(queue.can_send());
  EXPECT_EQ(queue.finish(first->ticket)->payload, "a");
  EXPECT_EQ(sent(queue), "c");
}

TEST(SendQueue, DropsAndCountsTheOldestWhenFull) {
  SendQueue queue({.max_queued = 2, .max_in_flight = 1});
  for (const char* payload : {"a", "b", "c"}) {
    queue.push(message(payload));
  }
  EXPECT_TRUE(queue.full());
  EXPECT_EQ(queue.dropped(), 1U);
  queue.connection_made();
  EXPECT_EQ(sent(queue), "b");
}

TEST(SendQueue, SendsAgainWhatWasInFlightWhenTheConnectionWasLost) {
  SendQueue queue({.max_queued = 10, .max_in_flight = 2});
  queue.connection_made();
  for (const char* payload : {"a", "b", "c"}) {
    queue.push(message(payload));
  }
  const auto first = queue.next();
  (void)queue.next();
  queue.connection_lost();
  EXPECT_EQ(queue.finish(first->ticket), nullptr);
  queue.connection_made();
  EXPECT_EQ(sent(queue), "ab");
  EXPECT_EQ(queue.queued(), 1U);
}

TEST(SendQueue, DropsQos0WithTheConnection) {
  SendQueue queue({.max_queued = 10, .max_in_flight = 1});
  queue.push(message("a", 0));
  EXPECT_EQ(queue.dropped(), 1U);
  queue.connection_made();
  for (const char* payload : {"b", "c"}) {
    queue.push(message(payload, 0));
  }
  queue.push(message("d", 1));
  EXPECT_EQ(sent(queue), "b");
  queue.connection_lost();
  EXPECT_EQ(queue.dropped(), 3U);
  queue.connection_made();
  EXPECT_EQ(sent(queue), "d");
}

TEST(SendQueue, EndsAFlightOnce) {
  SendQueue queue({});
  queue.connection_made();
  queue.push(message("a"));
  const auto sending = queue.next();
  EXPECT_NE(queue.finish(sending->ticket), nullptr);
  EXPECT_EQ(queue.finish(sending->ticket), nullptr);
  EXPECT_EQ(queue.finish(12345), nullptr);
  EXPECT_TRUE(queue.empty());
}

/// A broker that confirms what it likes, when it likes, over a connection that comes and goes.
struct Storm {
  SendQueue queue{{.max_queued = 8, .max_in_flight = 3}};
  std::vector<std::uint64_t> unconfirmed;
  std::vector<int> arrived;  // numbers of messages, as the broker saw them
  int pushed = 0;
  std::uint64_t finished = 0;

  void step(int action) {
    switch (action) {
      case 0:
        queue.connection_made();
        break;
      case 1:
        queue.connection_lost();
        unconfirmed.clear();
        break;
      case 2:
      case 3:
      case 4:
        queue.push(message(std::to_string(pushed++)));
        break;
      case 5:
      case 6:
        send();
        break;
      default:
        confirm();
        break;
    }
  }
  void send() {
    if (const auto sending = queue.next()) {
      arrived.push_back(std::stoi(sending->message->payload));
      unconfirmed.push_back(sending->ticket);
    }
  }
  void confirm() {
    if (!unconfirmed.empty()) {
      RC_ASSERT(queue.finish(unconfirmed.front()) != nullptr);
      unconfirmed.erase(unconfirmed.begin());
      ++finished;
    }
  }
};

RC_GTEST_PROP(SendQueue, LosesOnlyWhatItCountsAndKeepsOrder, ()) {
  Storm storm;
  for (const int action : *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 9))) {
    storm.step(action);
    RC_ASSERT(storm.queue.in_flight() <= 3U);
    RC_ASSERT(storm.queue.queued() <= 8U + 3U);
  }
  storm.queue.connection_made();
  while (!storm.queue.empty()) {
    storm.send();
    storm.confirm();
  }
  RC_ASSERT(storm.finished + storm.queue.dropped() == static_cast<std::uint64_t>(storm.pushed));
  // Without repetitions, the broker saw the messages in the order of publishing.
  std::set<int> seen;
  int last = -1;
  for (const int number : storm.arrived) {
    if (seen.insert(number).second) {
      RC_ASSERT(number > last);
      last = number;
    }
  }
}

}  // namespace
}  // namespace kidnapwatch::adapters::mqtt
