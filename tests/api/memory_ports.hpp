// SPDX-License-Identifier: Apache-2.0
// A fleet and a history that live in memory, and calls of the API on them.
#pragma once

#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "adapters/codecs/config_json.hpp"
#include "api/routes.hpp"

namespace kidnapwatch::api {

using adapters::codecs::Json;
using adapters::codecs::text;

inline core::Stamp at_s(std::int64_t seconds) {
  return core::stamp_from_ns(seconds * 1'000'000'000);
}

class MemoryFleet : public Fleet {
 public:
  std::vector<core::RobotStatus> robots_now;
  core::ServiceStatus status_now;
  bool broken = false;  ///< throws whatever is asked

  [[nodiscard]] std::vector<core::RobotStatus> robots() const override {
    if (broken) {
      throw std::runtime_error("the fleet is broken");
    }
    return robots_now;
  }

  [[nodiscard]] std::optional<core::RobotStatus> robot(const std::string& id) const override {
    for (const auto& robot : robots_now) {
      if (robot.id == id) {
        return robot;
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] core::ServiceStatus status() const override { return status_now; }

  [[nodiscard]] ConfigView config(const std::string& robot) const override {
    const std::scoped_lock lock(mutex_);
    return view(robot, levels);
  }

  ConfigView put_config(const std::string& robot, const Json& values, std::int64_t seen_version,
                        const std::string& author) override {
    const std::scoped_lock lock(mutex_);
    if (std::exchange(overtaken, false)) {
      set(levels, "", Json::object(), "rival");
    }
    const auto current = view(robot, levels).effective.version;
    if (seen_version != current) {
      throw VersionConflict{current};
    }
    auto next = levels;
    set(next, robot, values, author);
    auto result = view(robot, next);
    core::check(result.effective.config);
    levels = next;
    return result;
  }

  [[nodiscard]] std::vector<core::Scan> last_scans(const std::string& /*robot*/) override {
    if (busy) {
      throw Unavailable("busy");
    }
    return scans_now;
  }

  std::vector<core::Scan> scans_now;

  /// Told what is to be done; answers what `changed` is then.
  std::optional<core::Incident> change_incident(const std::string& id,
                                                const core::IncidentCommand& command) override {
    if (busy) {
      throw Unavailable("busy");
    }
    commands.emplace_back(id, command);
    return changed;
  }

  std::vector<std::pair<std::string, core::IncidentCommand>> commands;
  std::optional<core::Incident> changed;
  bool busy = false;
  bool overtaken = false;  ///< somebody else is faster than the next put_config

  std::vector<ConfigChange> levels;  ///< all changes, the latest last

 private:
  static void set(std::vector<ConfigChange>& levels, const std::string& robot, const Json& values,
                  const std::string& author) {
    const auto version = static_cast<std::int64_t>(levels.size()) + 1;
    levels.push_back(
        {.version = version, .since = {}, .author = author, .robot = robot, .values = values});
  }
  static ConfigView view(const std::string& robot, const std::vector<ConfigChange>& levels) {
    ConfigView view;
    for (const auto& change : levels) {
      if (change.robot.empty() || change.robot == robot) {
        (change.robot.empty() ? view.fleet : view.robot) = change.values;
        view.effective.version = change.version;
        view.effective.author = change.author;
      }
    }
    using adapters::codecs::detection_config;
    view.effective.config = detection_config(view.robot, detection_config(view.fleet));
    return view;
  }

  mutable std::mutex mutex_;
};

class MemoryHistory : public History {
 public:
  std::vector<ConfigChange> all_configs;                        ///< newest first
  std::vector<std::pair<std::string, core::Score>> all_scores;  ///< in order of stamps
  std::vector<core::ScoreBucket> rolled_up;                     ///< of every robot
  std::vector<core::Incident> all_incidents;                    ///< newest first
  std::vector<std::pair<std::string, core::Evidence>> all_evidence;

  [[nodiscard]] std::vector<core::Score> scores(const std::string& robot, TimeRange stamps,
                                                std::size_t limit) const override {
    std::vector<core::Score> found;
    for (const auto& [id, score] : all_scores) {
      if (id == robot && contains(stamps, score.stamp) && found.size() < limit) {
        found.push_back(score);
      }
    }
    return found;
  }

  [[nodiscard]] std::vector<core::ScoreBucket> score_buckets(const std::string& robot,
                                                             TimeRange stamps,
                                                             std::chrono::seconds resolution,
                                                             std::size_t limit) const override {
    core::ScoreBuckets buckets(resolution, limit);
    for (const auto& bucket : rolled_up) {
      if (bucket.from < stamps.to && bucket.end() > stamps.from) buckets.add(bucket);
    }
    for (const auto& score : scores(robot, stamps, all_scores.size())) {
      buckets.add(score);
    }
    return buckets.all();
  }

  [[nodiscard]] std::vector<core::Incident> incidents(const IncidentQuery& query) const override {
    std::vector<core::Incident> found;
    for (const auto& one : all_incidents) {
      const bool wanted = query.robot.value_or(one.robot) == one.robot &&
                          query.state.value_or(one.state) == one.state &&
                          query.kind.value_or(one.kind) == one.kind &&
                          (!query.label || query.label == one.label) &&
                          contains(query.opened_at, one.opened_at) &&
                          (!query.before_id || one.id < *query.before_id);
      if (wanted && found.size() < query.limit) {
        found.push_back(one);
      }
    }
    return found;
  }

  [[nodiscard]] std::optional<core::Incident> incident(const std::string& id) const override {
    for (const auto& one : all_incidents) {
      if (one.id == id) {
        return one;
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<core::Evidence> evidence(const std::string& id) const override {
    for (const auto& [incident, evidence] : all_evidence) {
      if (incident == id) {
        return evidence;
      }
    }
    return std::nullopt;
  }

  std::vector<NumberedAlert> all_alerts;  ///< in order
  std::int64_t last_alert = 0;            ///< that was ever given, if all are gone

  [[nodiscard]] std::vector<NumberedAlert> alerts(std::int64_t after,
                                                  std::size_t limit) const override {
    std::vector<NumberedAlert> found;
    for (const auto& one : all_alerts) {
      if (one.number > after && found.size() < limit) {
        found.push_back(one);
      }
    }
    return found;
  }

  [[nodiscard]] std::vector<NumberedAlert> alerts_of(const std::string& incident) const override {
    std::vector<NumberedAlert> found;
    for (const auto& one : all_alerts) {
      if (one.json.find(incident) != std::string::npos) {
        found.push_back(one);
      }
    }
    return found;
  }

  [[nodiscard]] AlertNumbers alert_numbers() const override {
    if (all_alerts.empty()) {
      return {.first = last_alert + 1, .last = last_alert};
    }
    return {.first = all_alerts.front().number, .last = all_alerts.back().number};
  }

  [[nodiscard]] std::vector<ConfigChange> configs(const ConfigQuery& query) const override {
    std::vector<ConfigChange> found;
    for (const auto& one : all_configs) {
      const bool wanted = query.robot.value_or(one.robot) == one.robot &&
                          one.version < query.before.value_or(one.version + 1);
      if (wanted && found.size() < query.limit) {
        found.push_back(one);
      }
    }
    return found;
  }

 private:
  static bool contains(TimeRange range, core::Stamp stamp) {
    return range.from <= stamp && stamp < range.to;
  }
};

/// Calls routes as functions, without a server.
class ApiTest : public ::testing::Test {
 protected:
  Response call(const Request& request) {
    return answer({fleet, history, *guard, live}, request,
                  [this](const std::string& what) { report = what; });
  }

  Response get(const std::string& target, std::vector<Header> headers = {}) {
    return call({"GET", target, std::move(headers), "", "10.0.0.7"});
  }

  Response put(const std::string& target, const std::string& body,
               std::vector<Header> headers = {}) {
    headers.push_back({"Content-Type", "application/json"});
    return call({"PUT", target, std::move(headers), body, "10.0.0.7"});
  }

  Response patch(const std::string& target, const std::string& body,
                 std::vector<Header> headers = {{"Content-Type", "application/json"}}) {
    return call({"PATCH", target, std::move(headers), body, "10.0.0.7"});
  }

  Response remove(const std::string& target, std::vector<Header> headers = {}) {
    return call({"DELETE", target, std::move(headers), "", "10.0.0.7"});
  }

  Response post(const std::string& target, const std::string& body,
                std::vector<Header> headers = {}) {
    headers.push_back({"Content-Type", "application/json"});
    return call({"POST", target, std::move(headers), body, "10.0.0.7"});
  }

  static Json body(const Response& response) {
    return adapters::codecs::parsed(response.body, "response");
  }

  static std::string header_of(const Response& response, const std::string& name) {
    for (const auto& header : response.headers) {
      if (header.name == name) {
        return header.value;
      }
    }
    return "";
  }

  MemoryFleet fleet;
  MemoryHistory history;
  /// As where no tokens are needed and nobody is too fast.
  std::unique_ptr<Guard> guard =
      std::make_unique<Guard>(nullptr, RateLimitConfig{.per_s = 0.0}, [] { return 0.0; });
  double now_s = 0.0;
  LiveRobots live{fleet, [this] { return now_s; }};
  std::string report;
};

}  // namespace kidnapwatch::api
