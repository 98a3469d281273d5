// SPDX-License-Identifier: Apache-2.0
// How the service is set up: every setting with its default, and where its value came from.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/session.hpp"

namespace kidnapwatch::service {

struct Settings {
  std::string mqtt_url = "mqtt://127.0.0.1:1883";
  std::string mqtt_prefix = "kidnapwatch/v1";
  std::string mqtt_client_id = "kidnapwatch";
  std::vector<std::string> mqtt_scan_filters;  ///< more topic filters, such as "+/scan"
  std::string mqtt_username;
  std::string mqtt_password;
  std::string mqtt_ca_file;
  std::string mqtt_cert_file;
  std::string mqtt_key_file;
  std::size_t mqtt_keep_alive_s = 10;
  std::size_t mqtt_scores_per_s = 0;

  std::string http_host = "127.0.0.1";
  std::uint16_t http_port = 8080;
  std::string http_cert_file;  ///< PEM; with a key: REST over TLS
  std::string http_key_file;
  std::size_t http_max_connections = 256;
  std::string http_auth = "auto";  ///< tokens, off; auto: tokens unless REST is on loopback alone
  std::string http_tokens_file = "/var/lib/kidnapwatch/tokens.json";
  std::size_t http_rate_limit_per_s = 50;

  std::string store_file = "/var/lib/kidnapwatch/kidnapwatch.db";
  std::size_t store_commit_every_ms = 50;
  std::size_t store_keep_scores_days = 30;
  std::size_t store_keep_minutes_days = 60;
  std::size_t store_keep_hours_days = 730;
  std::size_t store_keep_incidents_days = 365;
  std::size_t store_max_mb = 8000;

  std::size_t service_lanes = 2;
  std::size_t service_queue_per_robot = 64;
  std::size_t service_scans_per_s = 500;
  std::size_t service_max_robots = 10'000;
  std::size_t service_max_payload_bytes = 262'144;
  std::string service_log_level = "info";

  core::DetectionConfig detection;  ///< until somebody sets another one over REST
};

/// Whether REST asks for a token.
[[nodiscard]] bool needs_tokens(const Settings& settings);

/// One setting: how it is called and read and shown. Texts are as in an environment variable.
struct Setting {
  std::string key;  ///< as in the TOML file: "mqtt.url"
  std::string help;
  bool secret = false;  ///< never shown; also read from KEY_FILE and systemd credentials
  std::function<void(Settings&, const std::string& text)> read;  ///< throws BadInput naming the key
  std::function<std::string(const Settings&)> show;
};

/// All settings, in the order of the documentation.
[[nodiscard]] std::span<const Setting> all_settings();

/// "KIDNAPWATCH_MQTT_URL" for "mqtt.url".
[[nodiscard]] std::string environment_name(const Setting& setting);

struct Sources {
  std::optional<std::filesystem::path> file;  ///< must exist if given
  std::function<std::optional<std::string>(const std::string& name)> environment;
  std::map<std::string, std::string> flags;  ///< by key
};

struct LoadedSettings {
  Settings settings;
  std::map<std::string, std::string> origins;  ///< by key: "default", "flag --mqtt-url", ...
};

/// flag > environment > file > default. Throws BadInput naming the key, and the file and line where
/// it has one, for anything unknown or out of range.
[[nodiscard]] LoadedSettings load_settings(const Sources& sources);

/// Where secrets are kept. Throws BadInput naming `field` if there is none.
[[nodiscard]] std::string first_line_of(const std::string& field,
                                        const std::filesystem::path& file);

/// The process's environment.
[[nodiscard]] std::optional<std::string> process_environment(const std::string& name);

}  // namespace kidnapwatch::service
