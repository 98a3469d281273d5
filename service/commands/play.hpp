// SPDX-License-Identifier: Apache-2.0
// Robots that play their scans to a broker in real time, or faster.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/scan.hpp"

namespace CLI {
class App;
}

namespace kidnapwatch::service {

enum class Encoding : std::uint8_t { json, cbor };

/// Where to publish, and how.
struct PlayOptions {
  std::string url = "mqtt://127.0.0.1:1883";
  std::string prefix = "kidnapwatch/v1";
  std::string username;
  std::string password_file;
  std::string ca_file;
  std::string cert_file;
  std::string key_file;
  Encoding encoding = Encoding::json;
  double speed = 1.0;  ///< stamps run this many times faster than the clock

  void add_to(CLI::App& command);
};

/// One scan on its way to the broker.
struct Outgoing {
  core::Scan scan;         ///< its stamp counts from 1970 as from the start of the play
  bool kidnapped = false;  ///< the first one elsewhere
};

/// A robot that yields its scans in order of stamps, and nothing when it is done.
struct Player {
  std::string robot;
  std::function<std::optional<Outgoing>()> next;
};

struct Played {
  std::uint64_t scans = 0;   ///< taken by the broker's connection
  std::uint64_t unsent = 0;  ///< not taken, because it was gone or full
  std::uint64_t kidnaps = 0;
  double seconds = 0.0;
  double latest_s = 0.0;  ///< how far behind its time the latest scan was published
};

/// Publishes each scan when it is due, in order of stamps over all robots, until all are done or
/// SIGTERM or SIGINT comes. Stamps begin now; played faster than the clock they end when the play
/// does, if it lasts `span_s` (of stamps), so that none is in the future. `on_kidnap` is told of
/// each kidnapping as its scan is published.
Played play(std::vector<Player> players, const PlayOptions& options, double span_s,
            const std::function<void(const std::string& robot, core::Stamp)>& on_kidnap);

/// {"scans":...}: one line of JSON.
[[nodiscard]] std::string to_json(const Played& played);

}  // namespace kidnapwatch::service
