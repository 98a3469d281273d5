// SPDX-License-Identifier: Apache-2.0
// Scans of many robots, each published when it is due.
#include "service/commands/play.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <ctime>
#include <map>
#include <queue>
#include <thread>

#include <CLI/CLI.hpp>

#include "adapters/codecs/json.hpp"
#include "adapters/codecs/scan_encode.hpp"
#include "adapters/codecs/scan_payload.hpp"
#include "adapters/mqtt/client.hpp"
#include "adapters/mqtt/topics.hpp"
#include "service/settings.hpp"

namespace kidnapwatch::service {
namespace {

namespace codecs = adapters::codecs;
namespace mqtt = adapters::mqtt;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kPatience{10};  // for the broker to be there, and to take the last

/// A scan and the player whose it is; the earliest stamp comes first.
struct Due {
  Outgoing outgoing;
  std::size_t player;

  bool operator<(const Due& other) const { return outgoing.scan.stamp > other.outgoing.scan.stamp; }
};

mqtt::ClientConfig client_config(const PlayOptions& options) {
  mqtt::ClientConfig config;
  config.broker = {.url = options.url,
                   .username = options.username,
                   .ca_file = options.ca_file,
                   .cert_file = options.cert_file,
                   .key_file = options.key_file};
  if (!options.password_file.empty()) {
    config.broker.password = first_line_of("--password-file", options.password_file);
  }
  return config;
}

class Stage {
 public:
  Stage(std::vector<Player> players, const PlayOptions& options)
      : players_(std::move(players)),
        options_(options),
        topics_({.prefix = options.prefix}),
        client_(client_config(options), {}) {
    client_.start();
    if (!client_.wait_connected(kPatience)) {
      throw std::runtime_error("no broker at " + options.url);
    }
    for (std::size_t i = 0; i < players_.size(); ++i) {
      line_up(i);
    }
  }

  Played play(double span_s,
              const std::function<void(const std::string&, core::Stamp)>& on_kidnap) {
    const auto began = Clock::now();
    const auto now =
        std::chrono::time_point_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now());
    const auto start = core::later_by_s(now, -span_s * (1.0 - 1.0 / options_.speed));
    while (!due_.empty() && !stop_signal_came()) {
      Due next = due_.top();
      due_.pop();
      const auto since_start = next.outgoing.scan.stamp.time_since_epoch();
      const double at_s = std::chrono::duration<double>(since_start).count() / options_.speed;
      next.outgoing.scan.stamp = start + since_start;
      const auto due =
          began + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(at_s));
      std::this_thread::sleep_until(due);
      publish(next, on_kidnap);
      played_.latest_s =
          std::max(played_.latest_s, std::chrono::duration<double>(Clock::now() - due).count());
      line_up(next.player);
    }
    finish();
    played_.seconds = std::chrono::duration<double>(Clock::now() - began).count();
    return played_;
  }

 private:
  void line_up(std::size_t player) {
    if (auto outgoing = players_[player].next()) {
      due_.push({std::move(*outgoing), player});
    }
  }

  void publish(const Due& due, const std::function<void(const std::string&, core::Stamp)>& told) {
    const std::string& robot = players_[due.player].robot;
    mqtt::Message message{.topic = topics_.scan(robot)};
    encode(due.outgoing.scan, message);
    if (!client_.wait_for_room(kPatience)) {
      throw std::runtime_error("the broker takes no more messages");
    }
    client_.publish(std::move(message));
    ++played_.scans;
    if (due.outgoing.kidnapped) {
      ++played_.kidnaps;
      told(robot, due.outgoing.scan.stamp);
    }
  }

  void encode(const core::Scan& scan, mqtt::Message& message) const {
    if (options_.encoding == Encoding::cbor) {
      message.content_type = codecs::kCborContentType;
      codecs::append_cbor(message.payload, scan);
    } else {
      message.content_type = codecs::kJsonContentType;
      codecs::append_json(message.payload, scan);
    }
  }

  void finish() {
    (void)client_.drain(kPatience);
    const mqtt::ClientStats stats = client_.stats();
    played_.unsent = played_.scans - stats.delivered;
    client_.stop(std::chrono::seconds(1));
  }

  static bool stop_signal_came() {
    sigset_t pending;
    sigpending(&pending);
    return sigismember(&pending, SIGTERM) == 1 || sigismember(&pending, SIGINT) == 1;
  }

  std::vector<Player> players_;
  const PlayOptions& options_;
  const mqtt::Topics topics_;
  mqtt::Client client_;
  std::priority_queue<Due> due_;
  Played played_;
};

/// From now on the two wait to be looked for, in this thread and those that it starts.
void hold_back_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

}  // namespace

void PlayOptions::add_to(CLI::App& command) {
  command.add_option("--broker", url, "mqtt://host:port or mqtts://host:port");
  command.add_option("--prefix", prefix, "First levels of every topic");
  command.add_option("--username", username, "If the broker asks for one");
  command.add_option("--password-file", password_file, "File with the password");
  command.add_option("--ca-file", ca_file, "Certificate authority of the broker");
  command.add_option("--cert-file", cert_file, "Own certificate");
  command.add_option("--key-file", key_file, "The key of that certificate");
  static const std::map<std::string, Encoding> kEncodings{{"json", Encoding::json},
                                                          {"cbor", Encoding::cbor}};
  command.add_option("--encoding", encoding, "json, or cbor with a typed array of ranges")
      ->transform(CLI::CheckedTransformer(kEncodings, CLI::ignore_case));
  command.add_option("--speed", speed, "How many times faster than real time")
      ->check(CLI::Range(0.001, 1e6));
}

Played play(std::vector<Player> players, const PlayOptions& options, double span_s,
            const std::function<void(const std::string& robot, core::Stamp)>& on_kidnap) {
  hold_back_stop_signals();
  return Stage(std::move(players), options).play(span_s, on_kidnap);
}

std::string to_json(const Played& played) {
  return codecs::text(codecs::Json{{"scans", played.scans},
                                   {"unsent", played.unsent},
                                   {"kidnaps", played.kidnaps},
                                   {"seconds", played.seconds},
                                   {"latest_s", played.latest_s}});
}

}  // namespace kidnapwatch::service
