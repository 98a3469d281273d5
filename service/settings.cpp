// SPDX-License-Identifier: Apache-2.0
// The table of settings, and the four places that they come from.
#include "service/settings.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>

#include <toml++/toml.h>

#include "adapters/codecs/config_json.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::service {
namespace {

using core::BadInput;
namespace codecs = adapters::codecs;

// --- one reader and one writer per type ---------------------------------------------------------

void parse(const std::string& key, const std::string& text, std::string& value) {
  if (text.find('\0') != std::string::npos) {
    throw BadInput(key, "must not contain a zero byte");
  }
  value = text;
}

template <typename Number>
requires std::is_arithmetic_v<Number>
void parse(const std::string& key, const std::string& text, Number& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) {
    throw BadInput(key, "must be a number in range, not '" + text + "'");
  }
}

void parse(const std::string&, const std::string& text, std::vector<std::string>& values) {
  values.clear();
  std::istringstream list(text);
  for (std::string one; std::getline(list, one, ',');) {
    values.push_back(one);
  }
}

std::string shown(const std::string& value) { return value; }
std::string shown(const std::vector<std::string>& values) {
  std::string text;
  for (const auto& value : values) {
    text += (text.empty() ? "" : ",") + value;
  }
  return text;
}
template <typename Number>
requires std::is_arithmetic_v<Number> std::string shown(Number value) {
  return std::to_string(value);
}

template <typename Value>
Setting setting(const char* key, Value Settings::*member, const char* help) {
  return {key, help, false,
          [=](Settings& settings, const std::string& text) { parse(key, text, settings.*member); },
          [=](const Settings& settings) { return shown(settings.*member); }};
}

Setting secret(const char* key, std::string Settings::*member, const char* help) {
  Setting one = setting(key, member, help);
  one.secret = true;
  one.show = [=](const Settings& settings) {
    return std::string((settings.*member).empty() ? "" : "(hidden)");
  };
  return one;
}

std::size_t checked(const char* key, std::size_t value, std::size_t low, std::size_t high) {
  if (value < low || value > high) {
    throw BadInput(key, "must be from " + std::to_string(low) + " to " + std::to_string(high));
  }
  return value;
}

Setting bounded(const char* key, std::size_t Settings::*member, std::size_t low, std::size_t high,
                const char* help) {
  Setting one = setting(key, member, help);
  one.read = [=](Settings& settings, const std::string& text) {
    std::size_t value = 0;
    parse(key, text, value);
    settings.*member = checked(key, value, low, high);
  };
  return one;
}

Setting auth() {
  Setting one = setting("http.auth", &Settings::http_auth,
                        "tokens, off, or auto: tokens unless only this machine can connect");
  one.read = [](Settings& settings, const std::string& text) {
    if (text != "auto" && text != "tokens" && text != "off") {
      throw BadInput("http.auth", "must be auto, tokens or off, not '" + text + "'");
    }
    settings.http_auth = text;
  };
  return one;
}

Setting detection() {
  return {"detection",
          "how kidnappings are detected until REST sets another configuration, as in PUT /config",
          false,
          [](Settings& settings, const std::string& text) {
            try {
              settings.detection = codecs::detection_config(codecs::parsed(text, "detection"));
              core::check(settings.detection);
            } catch (const BadInput& e) {
              throw BadInput("detection." + e.field(), e.reason());
            }
          },
          [](const Settings& settings) { return codecs::text(codecs::json(settings.detection)); }};
}

constexpr std::size_t kMaxDays = 36'500;

std::vector<Setting> table() {
  using S = Settings;
  return {
      setting("mqtt.url", &S::mqtt_url, "broker: mqtt://host:port or mqtts://host:port"),
      setting("mqtt.prefix", &S::mqtt_prefix, "first levels of every topic"),
      setting("mqtt.client_id", &S::mqtt_client_id, "client id, one per service"),
      setting("mqtt.scan_filters", &S::mqtt_scan_filters,
              "further topic filters with scans, comma-separated; '+' stands for the robot"),
      setting("mqtt.username", &S::mqtt_username, "user name, if the broker asks for one"),
      secret("mqtt.password", &S::mqtt_password, "password, if the broker asks for one"),
      setting("mqtt.ca_file", &S::mqtt_ca_file, "certificate authority of the broker (mqtts)"),
      setting("mqtt.cert_file", &S::mqtt_cert_file, "the service's own certificate (mqtts)"),
      setting("mqtt.key_file", &S::mqtt_key_file, "the key of that certificate"),
      bounded("mqtt.keep_alive_s", &S::mqtt_keep_alive_s, 1, 3600,
              "a dead connection is noticed within three of these"),
      bounded("mqtt.scores_per_s", &S::mqtt_scores_per_s, 0, 1000,
              "publish so many scores of each robot, and each that changes its state; 0: none"),
      setting("http.host", &S::http_host, "address to listen on"),
      setting("http.port", &S::http_port, "port to listen on; 0 takes a free one"),
      setting("http.cert_file", &S::http_cert_file, "certificate chain, PEM: REST over TLS"),
      setting("http.key_file", &S::http_key_file, "the key of that certificate"),
      bounded("http.max_connections", &S::http_max_connections, 1, 10'000, "at once"),
      auth(),
      setting("http.tokens_file", &S::http_tokens_file, "who may use REST: kidnapwatch token"),
      bounded("http.rate_limit_per_s", &S::http_rate_limit_per_s, 0, 100'000,
              "requests of one client in the long run; twice as many at once; 0: no limit"),
      setting("store.file", &S::store_file, "the database"),
      bounded("store.commit_every_ms", &S::store_commit_every_ms, 1, 10'000,
              "scores are made durable this often"),
      bounded("store.keep_scores_days", &S::store_keep_scores_days, 1, kMaxDays,
              "every score; those around an incident stay as long as it"),
      bounded("store.keep_minutes_days", &S::store_keep_minutes_days, 1, kMaxDays,
              "least, most and mean of every minute; not less than scores"),
      bounded("store.keep_hours_days", &S::store_keep_hours_days, 1, kMaxDays,
              "and of every hour; not less than minutes"),
      bounded("store.keep_incidents_days", &S::store_keep_incidents_days, 1, kMaxDays,
              "resolved ones, with both scans; not less than scores"),
      bounded("store.max_mb", &S::store_max_mb, 100, 10'000'000,
              "size of the database; from 7/8 of it on the oldest scores go, then rollups"),
      bounded("service.lanes", &S::service_lanes, 1, 256, "threads that score"),
      bounded("service.queue_per_robot", &S::service_queue_per_robot, 1, 100'000,
              "scans of one robot that may wait; beyond, its oldest is dropped"),
      bounded("service.scans_per_s", &S::service_scans_per_s, 1, 1'000'000,
              "of one robot; what it sends beyond is dropped and counted as overload"),
      bounded("service.max_robots", &S::service_max_robots, 1, 1'000'000, "robots at most"),
      bounded("service.max_payload_bytes", &S::service_max_payload_bytes, 1024, 67'108'864,
              "a larger message is refused"),
      setting("service.log_level", &S::service_log_level, "debug, info, warn or error"),
      detection(),
  };
}

// --- the file ------------------------------------------------------------------------------------

std::string where(const std::filesystem::path& file, const toml::source_region& source) {
  return file.string() + ":" + std::to_string(source.begin.line);
}

std::string json_of(const toml::node& node) {
  std::ostringstream out;
  node.visit([&](const auto& value) {
    if constexpr (toml::is_table<decltype(value)>) {
      out << toml::json_formatter(value);
    }
  });
  return out.str();
}

/// The text that an environment variable of the same meaning would hold.
std::string text_of(const std::string& key, const toml::node& node) {
  if (const auto* text = node.as_string()) {
    return text->get();
  }
  if (const auto* list = node.as_array()) {
    std::string text;
    for (const auto& one : *list) {
      text += (text.empty() ? "" : ",") + text_of(key, one);
    }
    return text;
  }
  if (const auto* flag = node.as_boolean()) {
    return flag->get() ? "true" : "false";
  }
  std::ostringstream out;
  if (const auto* number = node.as_integer()) {
    out << number->get();
  } else if (const auto* real = node.as_floating_point()) {
    out << real->get();
  } else {
    throw BadInput(key, "must be a string, a number, true or false, or a list of strings");
  }
  return out.str();
}

const Setting* find(const std::string& key) {
  const auto settings = all_settings();
  const auto found = std::ranges::find(settings, key, &Setting::key);
  return found == settings.end() ? nullptr : &*found;
}

void take(LoadedSettings& loaded, const Setting& setting, const std::string& text,
          const std::string& origin) {
  try {
    setting.read(loaded.settings, text);
  } catch (const BadInput& e) {
    throw BadInput(e.field(), e.reason() + " (" + origin + ")");
  }
  loaded.origins[setting.key] = origin;
}

void take_node(LoadedSettings& loaded, const std::filesystem::path& file, const std::string& key,
               const toml::node& node) {
  const std::string place = where(file, node.source());
  if (const Setting* setting = find(key)) {
    take(loaded, *setting, node.is_table() ? json_of(node) : text_of(key, node), place);
  } else if (const auto* table = node.as_table(); table && key.find('.') == std::string::npos) {
    for (const auto& [name, child] : *table) {
      take_node(loaded, file, key + "." + std::string(name.str()), child);
    }
  } else {
    throw BadInput(key, "is no setting (" + place + ")");
  }
}

void take_file(LoadedSettings& loaded, const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) {
    throw BadInput("config", "cannot read " + file.string());
  }
  try {
    const std::string content = text.str();
    for (const auto& [name, node] :
         toml::parse(std::string_view(content), std::string_view(file.native()))) {
      take_node(loaded, file, std::string(name.str()), node);
    }
  } catch (const toml::parse_error& e) {
    throw BadInput("config", std::string(e.description()) + " (" + where(file, e.source()) + ")");
  }
}

// --- the environment and the flags ---------------------------------------------------------------

void take_secret_files(LoadedSettings& loaded, const Sources& sources, const Setting& setting) {
  if (const auto folder = sources.environment("CREDENTIALS_DIRECTORY")) {
    const auto file = std::filesystem::path(*folder) / setting.key;
    if (std::filesystem::exists(file)) {
      take(loaded, setting, first_line_of(setting.key, file), "credential " + file.string());
    }
  }
  const std::string name = environment_name(setting) + "_FILE";
  if (const auto file = sources.environment(name)) {
    take(loaded, setting, first_line_of(setting.key, *file), "environment " + name);
  }
}

void take_environment(LoadedSettings& loaded, const Sources& sources) {
  for (const auto& setting : all_settings()) {
    if (setting.secret) {
      take_secret_files(loaded, sources, setting);
    }
    const std::string name = environment_name(setting);
    if (const auto text = sources.environment(name)) {
      take(loaded, setting, *text, "environment " + name);
    }
  }
}

/// What is coarser is kept at least as long as what is finer.
void check_retention(const Settings& settings) {
  const auto not_less = [](const std::string& key, std::size_t days, const std::string& than,
                           std::size_t least) {
    if (days < least) throw BadInput(key, "must not be less than " + than);
  };
  not_less("store.keep_minutes_days", settings.store_keep_minutes_days, "store.keep_scores_days",
           settings.store_keep_scores_days);
  not_less("store.keep_hours_days", settings.store_keep_hours_days, "store.keep_minutes_days",
           settings.store_keep_minutes_days);
  not_less("store.keep_incidents_days", settings.store_keep_incidents_days,
           "store.keep_scores_days", settings.store_keep_scores_days);
}

void take_flags(LoadedSettings& loaded, const Sources& sources) {
  for (const auto& [key, text] : sources.flags) {
    take(loaded, *find(key), text, "flag --" + key);
  }
}

}  // namespace

bool needs_tokens(const Settings& settings) {
  const bool loopback = settings.http_host.starts_with("127.") || settings.http_host == "::1";
  return settings.http_auth == "tokens" || (settings.http_auth == "auto" && !loopback);
}

std::span<const Setting> all_settings() {
  static const std::vector<Setting> kTable = table();
  return kTable;
}

std::string environment_name(const Setting& setting) {
  std::string name = "KIDNAPWATCH_" + setting.key;
  std::ranges::transform(name, name.begin(), [](unsigned char c) {
    return c == '.' ? '_' : static_cast<char>(std::toupper(c));
  });
  return name;
}

LoadedSettings load_settings(const Sources& sources) {
  LoadedSettings loaded;
  for (const auto& setting : all_settings()) {
    loaded.origins[setting.key] = "default";
  }
  if (sources.file) {
    take_file(loaded, *sources.file);
  }
  take_environment(loaded, sources);
  take_flags(loaded, sources);
  check_retention(loaded.settings);
  return loaded;
}

std::string first_line_of(const std::string& field, const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line)) {
    throw BadInput(field, "cannot read " + file.string());
  }
  return line;
}

std::optional<std::string> process_environment(const std::string& name) {
  const char* value = std::getenv(name.c_str());  // NOLINT(concurrency-mt-unsafe): before threads
  return value ? std::optional<std::string>(value) : std::nullopt;
}

}  // namespace kidnapwatch::service
