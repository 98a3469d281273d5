// SPDX-License-Identifier: Apache-2.0
// Identifiers of incidents and events: UUIDv7 (RFC 9562), in the order in which they were made.
#pragma once

#include <cstdint>
#include <mutex>
#include <random>
#include <string>

#include "core/stamp.hpp"

namespace kidnapwatch::service {

/// From the system's own entropy.
[[nodiscard]] std::uint64_t random_seed();

class Ids {
 public:
  explicit Ids(std::uint64_t seed) : random_(seed) {}

  /// Later ids of the same source sort after earlier ones, even if the clock went back. Any thread.
  [[nodiscard]] std::string next(core::Stamp now);

 private:
  std::mutex mutex_;
  std::mt19937_64 random_;
  std::uint64_t last_tick_ = 0;  // milliseconds in the upper 48 bits, a counter in the lower 12
};

}  // namespace kidnapwatch::service
