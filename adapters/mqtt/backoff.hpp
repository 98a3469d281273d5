// SPDX-License-Identifier: Apache-2.0
// How long to wait before trying again: doubling, and never all clients at once.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <random>
#include <utility>

namespace kidnapwatch::adapters::mqtt {

/// Doubles from `min` up to `max`; each wait is a random share, half to all, of that: after an
/// outage 10,000 clients do not come back in the same instant.
class Backoff {
 public:
  Backoff(std::chrono::milliseconds min, std::chrono::milliseconds max, std::uint64_t seed)
      : min_(min), max_(max), next_(min), random_(seed) {}

  [[nodiscard]] std::chrono::milliseconds next() {
    const auto longest = std::exchange(next_, std::min(2 * next_, max_));
    std::uniform_int_distribution<std::int64_t> wait_ms(longest.count() / 2, longest.count());
    return std::chrono::milliseconds{wait_ms(random_)};
  }

  void reset() { next_ = min_; }

 private:
  std::chrono::milliseconds min_;
  std::chrono::milliseconds max_;
  std::chrono::milliseconds next_;
  std::mt19937_64 random_;
};

}  // namespace kidnapwatch::adapters::mqtt
