// SPDX-License-Identifier: Apache-2.0
// What is wrong with the service at the moment, in words for its operator.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/status.hpp"

namespace kidnapwatch::service {

/// What is looked at, all at one moment.
struct Signs {
  std::chrono::steady_clock::time_point time;
  core::Stamp clock;  ///< the wall's
  bool broker_connected = false;
  std::string store_problem;      ///< empty: it takes writes
  std::string quarantined;        ///< where a damaged store was put at the start; empty: none
  std::uint64_t dropped = 0;      ///< scans, since the start: the robots sent more than was judged
  std::uint64_t lost_writes = 0;  ///< scores and changes, since the start
};

/// Remembers for a while what happens in a moment: a jump of the clock, an overload. One thread.
class Health {
 public:
  /// What is wrong now; nothing if all is well. To be asked about once a second.
  [[nodiscard]] std::vector<core::Degradation> look(const Signs& signs);

 private:
  using Clock = std::chrono::steady_clock;

  void look_at_clock(const Signs& signs);
  void look_at_load(const Signs& signs);

  std::optional<Signs> before_;
  std::optional<core::Degradation> clock_;
  Clock::time_point clock_until_;
  std::optional<core::Degradation> overload_;
  Clock::time_point overload_until_;
};

}  // namespace kidnapwatch::service
