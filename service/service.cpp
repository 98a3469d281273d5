// SPDX-License-Identifier: Apache-2.0
// Wires broker, fleet, store and REST; starts and stops them in order.
#include "service/service.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>

#include <spdlog/spdlog.h>

#include "adapters/codecs/messages.hpp"
#include "adapters/mqtt/link.hpp"
#include "api/routes.hpp"
#include "api/server.hpp"
#include "service/announcements.hpp"
#include "service/command_desk.hpp"
#include "service/configs.hpp"
#include "service/fleet.hpp"
#include "service/health.hpp"
#include "service/ids.hpp"
#include "service/orders.hpp"
#include "service/outbox.hpp"
#include "service/refusal_log.hpp"
#include "service/rounds.hpp"
#include "service/stored_history.hpp"
#include "service/token_file.hpp"
#include "storage/archive.hpp"
#include "storage/upkeep.hpp"
#include "storage/writer.hpp"

namespace kidnapwatch::service {
namespace {

namespace codecs = adapters::codecs;
namespace mqtt = adapters::mqtt;
using core::Outcome;

constexpr std::chrono::seconds kRoundEvery{1};
constexpr std::uint64_t kRoundsBetweenRepeats = 5;

core::Stamp now() {
  return std::chrono::time_point_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now());
}

double monotonic_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

api::RateLimitConfig rate_limit(const Settings& settings) {
  const auto per_s = static_cast<double>(settings.http_rate_limit_per_s);
  return {.per_s = per_s, .burst = 2.0 * per_s};
}

storage::RetentionConfig retention(const Settings& settings) {
  return {.keep_scores = std::chrono::days(settings.store_keep_scores_days),
          .keep_minutes = std::chrono::days(settings.store_keep_minutes_days),
          .keep_hours = std::chrono::days(settings.store_keep_hours_days),
          .keep_incidents = std::chrono::days(settings.store_keep_incidents_days),
          .max_bytes = std::uint64_t{1'000'000} * settings.store_max_mb};
}

core::Stamp uptime() { return core::Stamp(std::chrono::steady_clock::now().time_since_epoch()); }

MessageKind message_kind(mqtt::TopicKind topic) {
  if (topic == mqtt::TopicKind::odom) return MessageKind::odometry;
  return topic == mqtt::TopicKind::particles ? MessageKind::particles : MessageKind::scan;
}

}  // namespace

class Service::Parts final : public api::Fleet {
 public:
  explicit Parts(const Settings& settings);

  [[nodiscard]] std::uint16_t http_port() const { return server_->port(); }
  void stop();

  [[nodiscard]] std::vector<core::RobotStatus> robots() const override { return fleet_.robots(); }
  [[nodiscard]] std::optional<core::RobotStatus> robot(const std::string& id) const override {
    return fleet_.robot(id);
  }
  [[nodiscard]] core::ServiceStatus status() const override;
  [[nodiscard]] api::ConfigView config(const std::string& robot) const override {
    return configs_.view(robot);
  }
  api::ConfigView put_config(const std::string& robot, const api::Json& values,
                             std::int64_t seen_version, const std::string& author) override {
    return configs_.put(robot, values, seen_version, author);
  }
  std::vector<core::Scan> last_scans(const std::string& robot) override {
    return orders_.last_scans(robot);
  }
  std::optional<core::Incident> change_incident(const std::string& id,
                                                const core::IncidentCommand& command) override {
    return orders_.change(id, command);
  }

 private:
  [[nodiscard]] mqtt::LinkConfig link_config() const;
  [[nodiscard]] mqtt::LinkEvents link_events();
  [[nodiscard]] Outbox::Ways outbox_ways();
  [[nodiscard]] service::Fleet::Outside outside();
  [[nodiscard]] CommandDesk::Ways desk_ways();
  [[nodiscard]] api::Guard::Lookup token_lookup() const;
  void resume_robots();
  void receive(const mqtt::Topic& topic, const mqtt::Received& message);
  void say_again();
  [[nodiscard]] std::vector<core::Degradation> degraded(const core::ServiceStatus& status) const;
  void make_round(bool reconnected);
  void tell(const std::vector<core::Degradation>& degraded);

  const Settings settings_;
  const core::Stamp started_ = now();
  RefusalLog log_refusal_;
  Ids ids_{random_seed()};
  storage::Writer writer_;
  const storage::Archive archive_;
  const StoredHistory history_{archive_};
  mqtt::Link link_;
  Outbox outbox_;
  Announcements announcements_;
  Configs configs_;
  service::Fleet fleet_;
  Orders orders_{fleet_, archive_, writer_};
  CommandDesk desk_{desk_ways()};
  mutable std::mutex health_mutex_;  // over health_
  mutable Health health_;
  std::vector<core::Degradation> degraded_;  // as last told; used by rounds_ only
  std::uint64_t round_ = 0;                  // used by rounds_ only
  const TokenFile tokens_{settings_.http_tokens_file};
  api::Guard guard_;
  api::LiveRobots live_{*this, monotonic_s};
  const api::Ports ports_{*this, history_, guard_, live_};
  std::unique_ptr<api::Server> server_;
  Rounds rounds_{kRoundEvery, [this](bool reconnected) { make_round(reconnected); }};
};

Service::Parts::Parts(const Settings& settings)
    : settings_(settings),
      writer_({.file = settings.store_file,
               .commit_every = std::chrono::milliseconds(settings.store_commit_every_ms),
               .retention = retention(settings)}),
      archive_(settings.store_file, writer_.recent()),
      link_(link_config(), link_events()),
      outbox_(outbox_ways()),
      announcements_(link_, writer_, outbox_, settings.mqtt_scores_per_s),
      configs_(
          settings.detection, latest_changes(archive_),
          {.now = now,
           .save = [this](const auto& change) { writer_.add_config(config_text(change)).get(); }}),
      fleet_({.lanes = settings.service_lanes,
              .max_robots = settings.service_max_robots,
              .lane = {.queue_per_robot = settings.service_queue_per_robot,
                       .scans_per_s = settings.service_scans_per_s,
                       .payload = {.max_payload_bytes = settings.service_max_payload_bytes}}},
             outside()),
      guard_(token_lookup(), rate_limit(settings), monotonic_s) {
  if (!needs_tokens(settings)) {
    spdlog::warn("REST asks for no token: whoever reaches {} may read and configure everything",
                 settings.http_host);
  }
  if (writer_.quarantined()) {
    spdlog::error("the store was damaged; it is kept as {}, and a fresh one was started",
                  writer_.quarantined()->string());
  }
  resume_robots();
  server_ = std::make_unique<api::Server>(
      api::ServerConfig{.address = settings.http_host,
                        .port = settings.http_port,
                        .cert_file = settings.http_cert_file,
                        .key_file = settings.http_key_file,
                        .threads = 2,  // one may compute a threshold
                        .max_connections = settings.http_max_connections,
                        .max_connections_per_peer = (settings.http_max_connections + 1) / 2,
                        .max_feeds = (settings.http_max_connections + 1) / 2},
      [this](const api::Request& request) {
        return api::answer(ports_, request, [](const std::string& fault) {
          spdlog::error("a request failed: {}", fault);
        });
      });
  link_.start();
}

mqtt::LinkConfig Service::Parts::link_config() const {
  return {.broker = {.url = settings_.mqtt_url,
                     .username = settings_.mqtt_username,
                     .password = settings_.mqtt_password,
                     .ca_file = settings_.mqtt_ca_file,
                     .cert_file = settings_.mqtt_cert_file,
                     .key_file = settings_.mqtt_key_file,
                     .keep_alive = std::chrono::seconds(settings_.mqtt_keep_alive_s)},
          .client_id = settings_.mqtt_client_id,
          .topics = {.prefix = settings_.mqtt_prefix, .scan_filters = settings_.mqtt_scan_filters},
          .status_schema = std::string(codecs::kServiceStatusSchema),
          .online = codecs::service_status_message("online", KW_VERSION, started_),
          .stopped = codecs::service_status_message("stopped", KW_VERSION, started_),
          .offline = codecs::service_status_message("offline", KW_VERSION, started_)};
}

mqtt::LinkEvents Service::Parts::link_events() {
  return {.on_message = [this](const auto& topic, const auto& message) { receive(topic, message); },
          .on_connected = [this] { say_again(); },
          .on_trouble = [](const std::string& what) { spdlog::warn("broker: {}", what); }};
}

Outbox::Ways Service::Parts::outbox_ways() {
  return {.publish =
              [this](const auto& alert, auto on_delivered) {
                link_.publish_alert(alert.robot, alert.payload, std::string(codecs::kAlertSchema),
                                    std::move(on_delivered));
              },
          .confirm = [this](const auto& event_id) { writer_.confirm_delivery(event_id); },
          .stored = [this] { return archive_.outbox(); }};
}

service::Fleet::Outside Service::Parts::outside() {
  return {.announcer = announcements_,
          .now = now,
          .uptime = uptime,
          .new_id = [this](core::Stamp at) { return ids_.next(at); },
          .log_refusal = [this](const std::string& robot,
                                const core::BadInput& why) { log_refusal_(robot, why); },
          .config = [this](const std::string& robot) { return configs_.in_force(robot); }};
}

CommandDesk::Ways Service::Parts::desk_ways() {
  return {.knows = [this](const auto& robot) { return fleet_.robot(robot).has_value(); },
          .stored = [this](const auto& id) { return archive_.incident(id); },
          .change = [this](const auto& id, const auto& what) { return orders_.change(id, what); },
          .change_open = [this](const auto& robot,
                                const auto& what) { return orders_.change_open(robot, what); },
          .forget_scans = [this](const auto& robot) { orders_.forget_scans(robot); },
          .publish =
              [this](const auto& letter, const std::string& answer) {
                return link_.publish_response(letter.robot, letter.response_topic, answer,
                                              std::string(codecs::kAnswerSchema),
                                              letter.correlation);
              },
          .log_refusal = [this](const std::string& robot,
                                const core::BadInput& why) { log_refusal_(robot, why); }};
}

api::Guard::Lookup Service::Parts::token_lookup() const {
  if (!needs_tokens(settings_)) {
    return nullptr;
  }
  return [this](std::string_view secret) {
    try {
      return tokens_.caller(secret);
    } catch (const core::BadInput& unusable) {  // our fault, not the client's
      throw std::runtime_error(unusable.what());
    }
  };
}

void Service::Parts::resume_robots() {
  std::map<std::string, Past> pasts;
  for (auto& robot : archive_.robots(configs_.window_pairs())) {
    pasts[robot.robot].natural_scores = std::move(robot.natural_scores);
    pasts[robot.robot].learned = std::move(robot.learned);
  }
  for (auto& incident : archive_.unresolved_incidents()) {
    const std::string robot = incident.robot;
    pasts[robot].open_incident = std::move(incident);
  }
  for (const auto& [robot, past] : pasts) {
    fleet_.resume(robot, past);
  }
}

void Service::Parts::receive(const mqtt::Topic& topic, const mqtt::Received& message) {
  switch (topic.kind) {
    case mqtt::TopicKind::scan:
    case mqtt::TopicKind::odom:
    case mqtt::TopicKind::particles:
      fleet_.receive(std::string(topic.robot), {.payload = message.payload,
                                                .content_type = std::string(message.content_type),
                                                .arrival = now(),
                                                .kind = message_kind(topic.kind)});
      break;
    case mqtt::TopicKind::bad_robot_id:
      fleet_.count(Outcome::bad_robot_id);
      break;
    case mqtt::TopicKind::unknown:
      fleet_.count(Outcome::unknown_topic);
      break;
    case mqtt::TopicKind::command:
      desk_.take({.robot = std::string(topic.robot),
                  .payload = message.payload,
                  .response_topic = std::string(message.response_topic),
                  .correlation = std::string(message.correlation),
                  .retained = message.retained});
      break;
    case mqtt::TopicKind::own:
      break;
  }
}

/// A broker that was restarted may have forgotten what was retained.
void Service::Parts::say_again() {
  for (const auto& robot : fleet_.robots()) {
    announcements_.announce_state(robot, now());
  }
  rounds_.ask();
}

/// Sends what has not arrived, and tells what has changed for the worse or the better.
void Service::Parts::make_round(bool reconnected) {
  tell(status().degraded);
  if (!reconnected && ++round_ % kRoundsBetweenRepeats != 0) {
    return;
  }
  try {
    outbox_.send_again(reconnected);
  } catch (const storage::StorageError& error) {
    spdlog::warn("undelivered alerts could not be read: {}", error.what());
  }
}

void Service::Parts::tell(const std::vector<core::Degradation>& degraded) {
  const auto is_in = [](const auto& list) {
    return [&](const core::Degradation& one) {
      return std::ranges::find(list, one.name, &core::Degradation::name) != list.end();
    };
  };
  bool is_news = degraded.size() != degraded_.size();
  for (const auto& one : degraded) {
    if (!is_in(degraded_)(one)) {
      spdlog::warn("degraded: {}", one.what);
      is_news = true;
    }
  }
  for (const auto& one : degraded_) {
    if (!is_in(degraded)(one)) {
      spdlog::info("no longer degraded ({})", one.name);
    }
  }
  degraded_ = degraded;
  if (is_news) {
    link_.publish_online(codecs::service_status_message("online", KW_VERSION, started_, degraded_));
  }
}

std::vector<core::Degradation> Service::Parts::degraded(const core::ServiceStatus& status) const {
  const auto& aside = writer_.quarantined();
  const std::lock_guard lock(health_mutex_);
  return health_.look({.time = std::chrono::steady_clock::now(),
                       .clock = now(),
                       .broker_connected = status.broker_connected,
                       .store_problem = writer_.problem(),
                       .quarantined = aside ? aside->string() : "",
                       .dropped = status.counts.at(static_cast<std::size_t>(Outcome::overload)),
                       .lost_writes = status.lost_writes});
}

core::ServiceStatus Service::Parts::status() const {
  core::ServiceStatus status;
  fleet_.describe(status);
  status.version = KW_VERSION;
  status.commands = desk_.counts();
  status.started = started_;
  status.broker_connected = link_.connected();
  status.store_healthy = writer_.healthy();
  status.queued_writes = writer_.queued();
  status.lost_writes = writer_.lost();
  status.store_bytes = storage::size_of(settings_.store_file);
  status.commits = writer_.commits();
  status.degraded = degraded(status);
  return status;
}

void Service::Parts::stop() {
  rounds_.stop();
  link_.stop_receiving();
  desk_.stop();
  fleet_.stop();
  link_.stop(std::chrono::seconds(5));
  server_.reset();
}

Service::Service(const Settings& settings) : parts_(std::make_unique<Parts>(settings)) {}

Service::~Service() { stop(); }

std::uint16_t Service::http_port() const { return parts_->http_port(); }

void Service::stop() {
  if (parts_) {
    parts_->stop();
    parts_.reset();  // the writer finishes its queue
  }
}

}  // namespace kidnapwatch::service
