// SPDX-License-Identifier: Apache-2.0
// Messages as they go to the broker and come from it.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace kidnapwatch::adapters::mqtt {

/// A message to publish. The last four fields before the callback are properties of MQTT 5, left
/// out where the broker speaks 3.1.1.
struct Message {
  std::string topic;
  std::string payload;
  int qos = 0;  ///< 0: may be lost; 1: arrives at least once
  bool retain = false;
  std::string content_type;
  std::string schema;       ///< user property `schema`
  std::string correlation;  ///< correlation data, with a response
  std::optional<std::chrono::seconds> expiry;
  /// Called once, on Paho's thread, when the broker has confirmed it (QoS 1) or it was sent (QoS
  /// 0); never if it was lost or refused. Does not block.
  std::function<void()> on_delivered;
};

/// A message that came. The views are valid during the call only, the payload as long as it is
/// held.
struct Received {
  std::string_view topic;
  std::shared_ptr<const std::string> payload;  ///< never null
  std::string_view content_type;               ///< empty unless by MQTT 5
  std::string_view response_topic;             ///< where an answer is awaited; MQTT 5
  std::string_view correlation;                ///< to be sent back with it; any bytes
  bool retained = false;                       ///< sent before we subscribed, or to be kept
};

}  // namespace kidnapwatch::adapters::mqtt
