// SPDX-License-Identifier: Apache-2.0
// Paho C++ 1.2, wrapped. Its trap: callbacks run under its one global mutex.
#include "adapters/mqtt/connection.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <mqtt/async_client.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::mqtt {
namespace {

namespace paho = ::mqtt;

constexpr int kUnacceptableProtocol311 = 0x01;  // CONNACK of a broker that speaks 3.1.1 only
constexpr int kUnsupportedProtocol5 = 0x84;

/// What to do when an asynchronous call of Paho's ends.
class Listener final : public paho::iaction_listener {
 public:
  using Reaction = std::function<void(const paho::token&)>;
  Listener(Reaction success, Reaction failure)
      : success_(std::move(success)), failure_(std::move(failure)) {}
  void on_success(const paho::token& token) override { success_(token); }
  void on_failure(const paho::token& token) override { failure_(token); }

 private:
  Reaction success_;
  Reaction failure_;
};

[[nodiscard]] std::string reason(const paho::token& token) {
  const int code = token.get_return_code();
  const auto reason_code = static_cast<int>(token.get_reason_code());
  if (code < 0) {
    return "no connection (Paho " + std::to_string(code) + ")";
  }
  return "refused by the broker (code " + std::to_string(code != 0 ? code : reason_code) + ")";
}

[[nodiscard]] bool uses_tls(const std::string& url) {
  return url.starts_with("mqtts://") || url.starts_with("ssl://") || url.starts_with("wss://");
}

[[nodiscard]] paho::ssl_options tls_options(const BrokerConfig& broker) {
  paho::ssl_options tls;
  tls.set_trust_store(broker.ca_file);
  tls.set_key_store(broker.cert_file);
  tls.set_private_key(broker.key_file);
  tls.set_enable_server_cert_auth(true);
  tls.set_verify(true);  // the host's name, too
  return tls;
}

[[nodiscard]] paho::connect_options connect_options(const ClientConfig& config, int protocol) {
  const BrokerConfig& broker = config.broker;
  paho::connect_options options;
  options.set_mqtt_version(protocol);
  if (protocol >= MQTTVERSION_5) {
    options.set_clean_start(true);
  } else {
    options.set_clean_session(true);
  }
  options.set_keep_alive_interval(broker.keep_alive);
  options.set_connect_timeout(broker.connect_timeout);
  options.set_max_inflight(
      static_cast<int>(std::min<std::size_t>(config.queue.max_in_flight, 65535)));
  if (!broker.username.empty()) {
    options.set_user_name(broker.username);
    options.set_password(broker.password);
  }
  if (uses_tls(broker.url)) {
    options.set_ssl(tls_options(broker));
  }
  if (const auto& will = config.last_will) {
    options.set_will(paho::will_options(will->topic, will->payload, will->qos, will->retain));
  }
  return options;
}

[[nodiscard]] paho::properties properties(const Message& message) {
  paho::properties properties;
  if (!message.content_type.empty()) {
    properties.add({paho::property::CONTENT_TYPE, message.content_type});
  }
  if (!message.schema.empty()) {
    properties.add({paho::property::USER_PROPERTY, "schema", message.schema});
  }
  if (!message.correlation.empty()) {
    properties.add({paho::property::CORRELATION_DATA, message.correlation});
  }
  if (message.expiry) {
    properties.add({paho::property::MESSAGE_EXPIRY_INTERVAL,
                    static_cast<std::int32_t>(message.expiry->count())});
  }
  return properties;
}

/// The same message for Paho, without a copy of its payload.
[[nodiscard]] paho::const_message_ptr paho_message(const std::shared_ptr<const Message>& message) {
  const std::shared_ptr<const std::string> payload(message, &message->payload);
  return paho::message::create(message->topic, paho::binary_ref(payload), message->qos,
                               message->retain, properties(*message));
}

[[nodiscard]] bool is_topic(std::string_view topic) {
  constexpr std::string_view kForbidden("+#\0", 3);
  return !topic.empty() && topic.size() <= 65535 &&
         topic.find_first_of(kForbidden) == std::string_view::npos;
}

/// Empty where the message has none.
[[nodiscard]] std::string text(const paho::message& message, paho::property::code code) {
  const paho::properties& properties = message.get_properties();
  return properties.contains(code) ? paho::get<std::string>(properties, code) : std::string();
}

void pass_on(const paho::const_message_ptr& message,
             const std::function<void(const Received&)>& on_message) {
  static const auto kNothing = std::make_shared<const std::string>();
  const auto& payload = message->get_payload_ref().ptr();
  const std::string type = text(*message, paho::property::CONTENT_TYPE);
  const std::string response_topic = text(*message, paho::property::RESPONSE_TOPIC);
  const std::string correlation = text(*message, paho::property::CORRELATION_DATA);
  on_message({.topic = message->get_topic(),
              .payload = payload ? payload : kNothing,
              .content_type = type,
              .response_topic = response_topic,
              .correlation = correlation,
              .retained = message->is_retained()});
}

[[nodiscard]] void* as_context(std::uint64_t ticket) {
  return reinterpret_cast<void*>(ticket);  // NOLINT(performance-no-int-to-ptr): Paho hands it back
}

[[nodiscard]] std::uint64_t ticket_of(const paho::token& token) {
  return reinterpret_cast<std::uint64_t>(token.get_user_context());
}

}  // namespace

struct Connection::Paho {
  Paho(const ClientConfig& client_config, int protocol, const ConnectionEvents& events)
      : config(client_config),
        connecting([events](const paho::token&) { events.on_connect_ended({}, false); },
                   [events](const paho::token& token) {
                     const int code = token.get_return_code();
                     events.on_connect_ended(reason(token), code == kUnacceptableProtocol311 ||
                                                                code == kUnsupportedProtocol5);
                   }),
        publishing([events](const paho::token& token) { events.on_delivered(ticket_of(token)); },
                   [events](const paho::token& token) {
                     if (token.get_return_code() >= 0) {  // else the connection was lost
                       events.on_refused(ticket_of(token), reason(token));
                     }
                   }),
        subscribing(
            [](const paho::token&) {},
            [events](const paho::token& token) { events.on_subscription_refused(reason(token)); }),
        // Twice the window: Paho counts what its sending thread has not fetched yet.
        client(paho_url(config.broker.url), config.id,
               paho::create_options(protocol, static_cast<int>(2 * config.queue.max_in_flight))) {
    client.set_connection_lost_handler([events](const std::string&) { events.on_lost(); });
    client.set_message_callback(
        [events](const paho::const_message_ptr& message) { pass_on(message, events.on_message); });
  }

  const ClientConfig& config;
  Listener connecting;
  Listener publishing;
  Listener subscribing;
  paho::async_client client;  // last: destroyed before what it calls
};

Connection::Connection(const ClientConfig& config, int protocol, const ConnectionEvents& events)
    : paho_(std::make_unique<Paho>(config, protocol, events)) {
  try {
    paho_->client.connect(connect_options(config, protocol), nullptr, paho_->connecting);
  } catch (const paho::exception& error) {
    events.on_connect_ended(error.what(), false);
  }
}

Connection::~Connection() = default;

void Connection::subscribe() {
  const paho::subscribe_options as_sent(false, true);  // keeps `retained`; of MQTT 5 only
  for (const auto& [filter, qos] : paho_->config.subscriptions) {
    try {
      paho_->client.subscribe(filter, qos, nullptr, paho_->subscribing, as_sent);
    } catch (const paho::exception&) {
      return;  // the connection is gone again, which its own event tells
    }
  }
}

Connection::Sent Connection::publish(std::uint64_t ticket,
                                     const std::shared_ptr<const Message>& message) {
  if (!is_topic(message->topic)) {  // brokers end the connection for it, again and again
    return Sent::unsendable;
  }
  try {
    paho_->client.publish(paho_message(message), as_context(ticket), paho_->publishing);
    return Sent::yes;
  } catch (const paho::exception& error) {
    const bool lost = error.get_return_code() == MQTTASYNC_DISCONNECTED;
    return lost ? Sent::disconnected : Sent::unsendable;
  }
}

void Connection::disconnect(std::chrono::milliseconds timeout) {
  try {
    paho_->client.disconnect(static_cast<int>(timeout.count()))->wait_for(timeout);
  } catch (const paho::exception&) {  // it was gone already
  }
}

std::string paho_url(const std::string& url) {
  constexpr std::array<std::string_view, 6> kSchemes = {"mqtt://", "tcp://", "mqtts://",
                                                        "ssl://",  "ws://",  "wss://"};
  const auto scheme = std::ranges::find_if(
      kSchemes, [&](std::string_view known) { return url.starts_with(known); });
  if (scheme == kSchemes.end() || url.size() == scheme->size()) {
    throw core::BadInput("broker", "\"" + url + "\" is not like mqtt://host:1883");
  }
  return url;
}

}  // namespace kidnapwatch::adapters::mqtt
