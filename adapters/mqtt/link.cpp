// SPDX-License-Identifier: Apache-2.0
// Which topics the service subscribes to, and how each of its messages is published.
#include "adapters/mqtt/link.hpp"

#include <utility>

namespace kidnapwatch::adapters::mqtt {

Link::Link(LinkConfig config, LinkEvents events)
    : config_(std::move(config)),
      events_(std::move(events)),
      topics_(config_.topics),
      online_(config_.online),
      out_(outgoing_config(), {.on_message = {},
                               .on_connected =
                                   [this] {
                                     out_.publish(status(online()));
                                     if (events_.on_connected) {
                                       events_.on_connected();
                                     }
                                   },
                               .on_trouble = events_.on_trouble}),
      in_(incoming_config(), {.on_message = [this](const Received& received) { pass_on(received); },
                              .on_connected = {},
                              .on_trouble = events_.on_trouble}) {}

void Link::start() {
  out_.start();
  in_.start();
}

ClientConfig Link::incoming_config() const {
  ClientConfig client{.broker = config_.broker,
                      .id = config_.client_id + "-in",
                      .subscriptions = {},
                      .last_will = {},
                      .queue = config_.queue};
  for (auto& filter : topics_.filters()) {
    client.subscriptions.push_back({.filter = std::move(filter), .qos = 1});
  }
  return client;
}

ClientConfig Link::outgoing_config() const {
  return {.broker = config_.broker,
          .id = config_.client_id + "-out",
          .subscriptions = {},
          .last_will = status(config_.offline),
          .queue = config_.queue};
}

Message Link::status(const std::string& payload) const {
  Message message;
  message.topic = topics_.service_status();
  message.payload = payload;
  message.qos = 1;
  message.retain = true;
  message.content_type = config_.content_type;
  message.schema = config_.status_schema;
  return message;
}

std::string Link::online() const {
  const std::lock_guard lock(mutex_);
  return online_;
}

void Link::publish_online(std::string payload) noexcept {
  {
    const std::lock_guard lock(mutex_);
    online_ = std::move(payload);
  }
  if (out_.connected()) {  // else it is said after the connect
    out_.publish(status(online()));
  }
}

void Link::publish_alert(std::string_view robot, std::string payload, std::string schema,
                         std::function<void()> on_delivered) noexcept {
  out_.publish({.topic = topics_.alert(robot),
                .payload = std::move(payload),
                .qos = 1,
                .retain = false,
                .content_type = config_.content_type,
                .schema = std::move(schema),
                .correlation = {},
                .expiry = config_.alert_expiry,
                .on_delivered = std::move(on_delivered)});
}

void Link::publish_state(std::string_view robot, std::string payload, std::string schema) noexcept {
  out_.publish({.topic = topics_.state(robot),
                .payload = std::move(payload),
                .qos = 1,
                .retain = true,
                .content_type = config_.content_type,
                .schema = std::move(schema),
                .correlation = {},
                .expiry = {},
                .on_delivered = {}});
}

bool Link::publish_response(std::string_view robot, std::string_view topic, std::string payload,
                            std::string schema, std::string_view correlation) noexcept {
  if (!topics_.may_answer(robot, topic)) {
    return false;
  }
  out_.publish({.topic = std::string(topic),
                .payload = std::move(payload),
                .qos = 1,
                .retain = false,
                .content_type = config_.content_type,
                .schema = std::move(schema),
                .correlation = std::string(correlation),
                .expiry = {},
                .on_delivered = {}});
  return true;
}

void Link::publish_score(std::string_view robot, std::string payload, std::string schema) noexcept {
  out_.publish({.topic = topics_.score(robot),
                .payload = std::move(payload),
                .qos = 0,
                .retain = false,
                .content_type = config_.content_type,
                .schema = std::move(schema),
                .correlation = {},
                .expiry = {},
                .on_delivered = {}});
}

bool Link::wait_connected(std::chrono::milliseconds timeout) {
  return out_.wait_connected(timeout) && in_.wait_connected(timeout);
}

void Link::stop_receiving() { in_.stop(std::chrono::milliseconds{0}); }

void Link::stop(std::chrono::milliseconds timeout) {
  stop_receiving();
  out_.publish(status(config_.stopped));
  out_.stop(timeout);
}

void Link::pass_on(const Received& received) const {
  const Topic topic = topics_.parse(received.topic);
  if (topic.kind != TopicKind::own && events_.on_message) {
    events_.on_message(topic, received);
  }
}

}  // namespace kidnapwatch::adapters::mqtt
