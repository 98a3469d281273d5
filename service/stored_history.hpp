// SPDX-License-Identifier: Apache-2.0
// The store's archive as REST asks for it.
#pragma once

#include "adapters/codecs/json.hpp"
#include "api/ports.hpp"
#include "storage/archive.hpp"

namespace kidnapwatch::service {

[[nodiscard]] inline api::ConfigChange config_change(const storage::ConfigText& stored) {
  return {.version = stored.version,
          .since = stored.since,
          .author = stored.author,
          .robot = stored.robot,
          .values = adapters::codecs::parsed(stored.text, "stored config")};
}

[[nodiscard]] inline storage::ConfigText config_text(const api::ConfigChange& change) {
  return {.version = change.version,
          .since = change.since,
          .author = change.author,
          .text = adapters::codecs::text(change.values),
          .robot = change.robot};
}

/// Of each level of the configuration.
[[nodiscard]] inline std::vector<api::ConfigChange> latest_changes(
    const storage::Archive& archive) {
  std::vector<api::ConfigChange> changes;
  for (const auto& stored : archive.latest_configs()) {
    changes.push_back(config_change(stored));
  }
  return changes;
}

/// The archive outlives it.
class StoredHistory final : public api::History {
 public:
  explicit StoredHistory(const storage::Archive& archive) : archive_(archive) {}

  [[nodiscard]] std::vector<core::Score> scores(const std::string& robot, api::TimeRange stamps,
                                                std::size_t limit) const override {
    return archive_.scores(robot, stamps.from, stamps.to, limit);
  }
  [[nodiscard]] std::vector<core::ScoreBucket> score_buckets(const std::string& robot,
                                                             api::TimeRange stamps,
                                                             std::chrono::seconds resolution,
                                                             std::size_t limit) const override {
    return archive_.score_buckets(robot, stamps.from, stamps.to, resolution, limit);
  }
  [[nodiscard]] std::vector<core::Incident> incidents(
      const api::IncidentQuery& query) const override {
    return archive_.incidents({.robot = query.robot,
                               .state = query.state,
                               .kind = query.kind,
                               .label = query.label,
                               .opened_from = query.opened_at.from,
                               .opened_to = query.opened_at.to,
                               .before_id = query.before_id,
                               .limit = query.limit});
  }
  [[nodiscard]] std::optional<core::Incident> incident(const std::string& id) const override {
    return archive_.incident(id);
  }
  [[nodiscard]] std::optional<core::Evidence> evidence(const std::string& id) const override {
    return archive_.evidence(id);
  }
  [[nodiscard]] std::vector<api::NumberedAlert> alerts(std::int64_t after,
                                                       std::size_t limit) const override {
    return numbered(archive_.alerts(after, limit));
  }
  [[nodiscard]] std::vector<api::NumberedAlert> alerts_of(
      const std::string& incident_id) const override {
    return numbered(archive_.alerts_of(incident_id));
  }
  [[nodiscard]] api::AlertNumbers alert_numbers() const override {
    const auto numbers = archive_.alert_numbers();
    return {.first = numbers.first, .last = numbers.last};
  }
  [[nodiscard]] std::vector<api::ConfigChange> configs(
      const api::ConfigQuery& query) const override {
    std::vector<api::ConfigChange> changes;
    for (const auto& stored :
         archive_.configs({.robot = query.robot, .before = query.before, .limit = query.limit})) {
      changes.push_back(config_change(stored));
    }
    return changes;
  }

 private:
  static std::vector<api::NumberedAlert> numbered(const std::vector<storage::StoredAlert>& stored) {
    std::vector<api::NumberedAlert> alerts;
    alerts.reserve(stored.size());
    for (const auto& [number, robot, payload] : stored) {
      alerts.push_back({number, robot, payload});
    }
    return alerts;
  }

  const storage::Archive& archive_;
};

}  // namespace kidnapwatch::service
