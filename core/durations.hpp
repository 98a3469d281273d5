// SPDX-License-Identifier: Apache-2.0
// How long things took, counted by bucket.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace kidnapwatch::core {

/// A histogram of durations.
class Durations {
 public:
  /// Upper bounds, each included, in seconds; longer ones are in one more bucket.
  static constexpr std::array kBounds_s{0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05,
                                        0.1,    0.25,  0.5,    1.0,   2.5,  5.0};

  void add(double duration_s) {
    const auto* const bound = std::ranges::lower_bound(kBounds_s, duration_s);
    ++counts_.at(static_cast<std::size_t>(bound - kBounds_s.begin()));
    sum_s_ += duration_s;
  }
  Durations& operator+=(const Durations& other) {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_.at(i) += other.counts_.at(i);
    sum_s_ += other.sum_s_;
    return *this;
  }

  [[nodiscard]] const std::array<std::uint64_t, kBounds_s.size() + 1>& counts() const {
    return counts_;
  }
  [[nodiscard]] double sum_s() const { return sum_s_; }

 private:
  std::array<std::uint64_t, kBounds_s.size() + 1> counts_{};
  double sum_s_ = 0.0;
};

}  // namespace kidnapwatch::core
