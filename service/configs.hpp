// SPDX-License-Identifier: Apache-2.0
// The configuration of detection in three levels: defaults <- fleet <- robot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "api/ports.hpp"

namespace kidnapwatch::service {

/// Any thread may call anything. A level is named by its robot, the fleet's by the empty text.
class Configs {
 public:
  struct Outside {
    std::function<core::Stamp()> now;
    /// Makes a change durable, or throws.
    std::function<void(const api::ConfigChange&)> save;
  };

  /// `stored`: the latest change of each level. Throws BadInput for what cannot be in force.
  Configs(const core::DetectionConfig& defaults, const std::vector<api::ConfigChange>& stored,
          Outside outside);

  [[nodiscard]] std::shared_ptr<const core::ConfigVersion> in_force(const std::string& robot) const;
  /// The longest window of any level.
  [[nodiscard]] std::size_t window_pairs() const;

  /// As api::Fleet::config and put_config.
  [[nodiscard]] api::ConfigView view(const std::string& robot) const;
  api::ConfigView put(const std::string& robot, const api::Json& values, std::int64_t seen_version,
                      const std::string& author);

 private:
  /// The latest change of each level, and what comes of them for whom it concerns.
  struct State {
    std::map<std::string, api::ConfigChange> levels;
    std::map<std::string, std::shared_ptr<const core::ConfigVersion>> in_force;
    std::int64_t version = 0;
  };

  [[nodiscard]] core::ConfigVersion resolved(const State& state, const std::string& robot) const;
  void add(State& state, api::ConfigChange change) const;
  [[nodiscard]] std::shared_ptr<const State> state() const;

  const core::ConfigVersion defaults_;
  const Outside outside_;
  std::mutex put_mutex_;      // one change at a time
  mutable std::mutex mutex_;  // over state_
  std::shared_ptr<const State> state_;
};

}  // namespace kidnapwatch::service
