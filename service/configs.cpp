// SPDX-License-Identifier: Apache-2.0
// Levels laid over each other when one changes, so that scans need only look.
#include "service/configs.hpp"

#include <algorithm>
#include <utility>

#include "adapters/codecs/config_json.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::service {

Configs::Configs(const core::DetectionConfig& defaults,
                 const std::vector<api::ConfigChange>& stored, Outside outside)
    : defaults_{.version = 0, .since = outside.now(), .author = "settings", .config = defaults},
      outside_(std::move(outside)) {
  State state;
  add(state, {});  // the fleet's level, as long as nobody has set it
  for (const auto& change : stored) {
    add(state, change);
  }
  state_ = std::make_shared<const State>(std::move(state));
}

core::ConfigVersion Configs::resolved(const State& state, const std::string& robot) const {
  core::ConfigVersion result = defaults_;
  for (const std::string& level : {std::string(), robot}) {
    const auto found = state.levels.find(level);
    if (found == state.levels.end()) {
      continue;
    }
    const api::ConfigChange& change = found->second;
    result.config = adapters::codecs::detection_config(change.values, result.config);
    if (change.version > result.version) {
      result.version = change.version;
      result.since = change.since;
      result.author = change.author;
    }
  }
  core::check(result.config);
  return result;
}

/// Throws BadInput where it would leave any robot with a configuration that is not usable.
void Configs::add(State& state, api::ConfigChange change) const {
  const std::string changed = change.robot;
  state.version = std::max(state.version, change.version);
  state.levels.insert_or_assign(changed, std::move(change));
  for (const auto& [level, values] : state.levels) {
    if (!changed.empty() && level != changed) continue;  // robots do not inherit from each other
    try {
      state.in_force[level] = std::make_shared<const core::ConfigVersion>(resolved(state, level));
    } catch (const core::BadInput& bad) {
      if (level == changed) throw;
      throw core::BadInput(bad.field(), bad.reason() + ", by what is set for robot " + level);
    }
  }
}

std::shared_ptr<const Configs::State> Configs::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

std::shared_ptr<const core::ConfigVersion> Configs::in_force(const std::string& robot) const {
  const auto now = state();
  const auto found = now->in_force.find(robot);
  return found == now->in_force.end() ? now->in_force.at("") : found->second;
}

std::size_t Configs::window_pairs() const {
  std::size_t longest = 0;
  for (const auto& [level, config] : state()->in_force) {
    longest = std::max(longest, config->config.calibration.window_pairs);
  }
  return longest;
}

api::ConfigView Configs::view(const std::string& robot) const {
  const auto now = state();
  const auto own = now->levels.find(robot);
  const bool is_robots = !robot.empty() && own != now->levels.end();
  const auto found = now->in_force.find(robot);
  return {.effective = *(found == now->in_force.end() ? now->in_force.at("") : found->second),
          .fleet = now->levels.at("").values,
          .robot = is_robots ? own->second.values : api::Json::object()};
}

api::ConfigView Configs::put(const std::string& robot, const api::Json& values,
                             std::int64_t seen_version, const std::string& author) {
  {
    const std::lock_guard one_at_a_time(put_mutex_);
    const std::int64_t current = in_force(robot)->version;
    if (seen_version != current) {
      throw api::VersionConflict{current};
    }
    State next = *state();
    const api::ConfigChange change{.version = next.version + 1,
                                   .since = outside_.now(),
                                   .author = author,
                                   .robot = robot,
                                   .values = values};
    add(next, change);
    outside_.save(change);
    const std::lock_guard lock(mutex_);
    state_ = std::make_shared<const State>(std::move(next));
  }
  return view(robot);
}

}  // namespace kidnapwatch::service
