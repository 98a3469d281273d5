// SPDX-License-Identifier: Apache-2.0
// A folder for one test's store, and values to put into it.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "core/incident.hpp"
#include "core/session.hpp"

namespace kidnapwatch::storage {

/// Deleted with all that is in it.
class StoreFolder {
 public:
  StoreFolder() {
    auto name = (std::filesystem::temp_directory_path() / "kidnapwatch-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp");
    path_ = name;
  }
  ~StoreFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  StoreFolder(const StoreFolder&) = delete;
  StoreFolder& operator=(const StoreFolder&) = delete;

  [[nodiscard]] std::filesystem::path store() const { return path_ / "store.sqlite"; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Seconds after some day in 2026.
inline core::Stamp at_s(double seconds) {
  return core::later_by_s(core::stamp_from_ns(1'790'000'000'000'000'000), seconds);
}

inline core::Score score_at(double seconds, double cost = 1.5,
                            core::RobotState state = core::RobotState::normal) {
  return {.stamp = at_s(seconds),
          .reference = at_s(seconds - 0.2),
          .dissimilarity = {.cost = cost, .cost_per_beam = cost / 720, .standardized = true},
          .threshold = 12.25,
          .state = state};
}

/// As a UUIDv7: in the order of `number`.
inline std::string incident_id(int number) {
  auto digits = std::to_string(number);
  return "019a0000-" + std::string(4 - digits.size(), '0') + digits + "-7000-8000-000000000000";
}

inline core::Incident incident_of(int number, const std::string& robot = "robot-1") {
  return {.id = incident_id(number),
          .robot = robot,
          .seq = 1,
          .opened_at = at_s(number),
          .resolved_at = {},
          .scan_stamp = at_s(number - 0.1),
          .before_stamp = at_s(number - 0.5),
          .after_stamp = at_s(number - 0.3),
          .detector = "qs2ddtw",
          .score = 31.5,
          .threshold = 12.25,
          .config_version = 3};
}

}  // namespace kidnapwatch::storage
