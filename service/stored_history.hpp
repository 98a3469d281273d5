// SPDX-License-Identifier: Apache-2.0
// The store's archive as REST asks for it.
#pragma once

#include "api/ports.hpp"
#include "storage/archive.hpp"

namespace kidnapwatch::service {

/// The archive outlives it.
class StoredHistory final : public api::History {
 public:
  explicit StoredHistory(const storage::Archive& archive) : archive_(archive) {}

  [[nodiscard]] std::vector<core::Score> scores(const std::string& robot, api::TimeRange stamps,
                                                std::size_t limit) const override {
    return archive_.scores(robot, stamps.from, stamps.to, limit);
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

 private:
  const storage::Archive& archive_;
};

}  // namespace kidnapwatch::service
