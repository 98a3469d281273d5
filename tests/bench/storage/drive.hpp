// SPDX-License-Identifier: Apache-2.0
// A fleet's scores as they might be, and how times are told.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "storage/block.hpp"

namespace kidnapwatch::storage {

using Clock = std::chrono::steady_clock;

inline constexpr int kRobots = 1000;
inline constexpr double kRateHz = 5.0;
inline constexpr core::Stamp kBegin = core::stamp_from_ns(1'790'000'000'000'000'000);

inline double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

inline std::string name_of(int robot) { return "robot-" + std::to_string(robot); }

/// Scores as a lidar with 360 beams gives them, by both detectors: some beams miss, stamps jitter
/// by 1 ms.
class Drive {
 public:
  explicit Drive(unsigned seed) : random_(seed) {}

  core::Score next() {
    const auto reference = stamp_;
    const auto period_us = std::llround(1e6 / kRateHz + jitter_us_(random_));
    stamp_ += std::chrono::microseconds(period_us);
    level_ = 0.9 * level_ + 0.1 * noise_(random_);
    core::Score score{.stamp = stamp_,
                      .reference = reference,
                      .threshold = 35.5 + std::floor(count_++ / 100.0),
                      .state = core::RobotState::normal};
    score.dissimilarity.cost = std::exp(2.0 + level_ + 0.3 * noise_(random_));
    score.dissimilarity.cost_per_beam = score.dissimilarity.cost / beams_(random_);
    carry_ = std::max(0.0, carry_ + 0.5 * noise_(random_) - 0.3);
    score.motion = core::MotionScore{.score = std::max(0.0, 2.0 * noise_(random_)),
                                     .confirmed = std::max(0.0, noise_(random_) - 1.0),
                                     .threshold = 4.5,
                                     .carry = carry_};
    return as_stored(score);
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> jitter_us_{0.0, 1000.0};
  std::normal_distribution<double> noise_{0.0, 1.0};
  std::uniform_int_distribution<int> beams_{640, 720};
  core::Stamp stamp_ = kBegin;
  double level_ = 0.0;
  double carry_ = 0.0;
  int count_ = 0;
};

inline std::vector<Drive> fleet() {
  std::vector<Drive> drives;
  for (unsigned i = 0; i < kRobots; ++i) drives.emplace_back(i);
  return drives;
}

struct Quantiles {
  std::vector<double> values;
  [[nodiscard]] double at(double share) {
    if (values.empty()) return std::nan("");
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  }
};

inline void say(const char* what, Quantiles& ms) {
  std::printf("%-46s p50 %7.2f  p99 %7.2f  max %7.2f ms  (n %zu)\n", what, ms.at(0.5), ms.at(0.99),
              ms.at(1.0), ms.values.size());
}

template <typename Read>
void time(Quantiles& into, Read read) {
  const auto begin = Clock::now();
  read();
  into.values.push_back(1e3 * seconds_since(begin));
}

}  // namespace kidnapwatch::storage
