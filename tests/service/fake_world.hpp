// SPDX-License-Identifier: Apache-2.0
// A world around watches that tests can turn: a clock to set, and announcements to look at.
#pragma once

#include <cmath>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "service/fleet.hpp"

namespace kidnapwatch::service::test {

/// Remembers what was announced.
class Heard : public Announcer {
 public:
  void announce_state(const core::RobotStatus& status, core::Stamp) override {
    const std::lock_guard lock(mutex_);
    states_.push_back(status.id + " " + std::string(core::name(status.state)));
  }
  void announce_alert(const core::Alert& alert, std::optional<core::ScanPair> evidence) override {
    const std::lock_guard lock(mutex_);
    alerts_.push_back(alert);
    evidence_.push_back(std::move(evidence));
  }
  void announce_score(const std::string&, const core::Score& score, core::Stamp) override {
    const std::lock_guard lock(mutex_);
    scores_.push_back(score);
  }

  void keep_learned(const std::string& robot, std::vector<float> learned) override {
    const std::lock_guard lock(mutex_);
    learned_[robot] = std::move(learned);
  }

  std::map<std::string, std::vector<float>> learned() const { return locked(learned_); }
  std::vector<std::string> states() const { return locked(states_); }
  std::vector<core::Alert> alerts() const { return locked(alerts_); }
  std::vector<std::optional<core::ScanPair>> evidence() const { return locked(evidence_); }
  std::vector<core::Score> scores() const { return locked(scores_); }

 private:
  template <typename T>
  T locked(const T& values) const {
    const std::lock_guard lock(mutex_);
    return values;
  }

  mutable std::mutex mutex_;
  std::vector<std::string> states_;
  std::vector<core::Alert> alerts_;
  std::vector<std::optional<core::ScanPair>> evidence_;
  std::vector<core::Score> scores_;
  std::map<std::string, std::vector<float>> learned_;
};

inline core::Stamp at_s(double seconds) { return core::later_by_s(core::Stamp{}, seconds); }

/// A scan from the middle of a round room, as rosbridge writes it. Every beam is off by up to 1 cm,
/// differently for each stamp, so that no two scans are the same.
inline std::string round_room(double radius_m, double stamp_s, int beams = 90) {
  const auto sec = static_cast<long>(std::floor(stamp_s));
  const auto nanosec = static_cast<long>(std::lround((stamp_s - std::floor(stamp_s)) * 1e9));
  std::string text = R"({"header":{"stamp":{"sec":)" + std::to_string(sec) + R"(,"nanosec":)" +
                     std::to_string(nanosec) + R"(}},"angle_min":0,"angle_increment":)" +
                     std::to_string(6.28 / beams) + R"(,"range_min":0.1,"range_max":10,"ranges":[)";
  for (int i = 0; i < beams; ++i) {
    const double off_m = 0.01 * std::sin(1000.0 * stamp_s + i * i);
    text += (i == 0 ? "" : ",") + std::to_string(radius_m + off_m);
  }
  return text + "]}";
}

inline Message message(std::string payload, core::Stamp arrival) {
  return {std::make_shared<const std::string>(std::move(payload)), "", arrival};
}

inline core::ConfigVersion with_threshold(double threshold) {
  core::ConfigVersion version;
  version.config.alarm = core::AlarmBy::qs2ddtw;
  version.config.threshold = threshold;
  return version;
}

}  // namespace kidnapwatch::service::test
