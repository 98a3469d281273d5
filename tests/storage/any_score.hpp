// SPDX-License-Identifier: Apache-2.0
// Scores of all kinds, at random.
#pragma once

#include <array>
#include <limits>
#include <random>

#include "storage/block.hpp"
#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {

/// At that time; NaN, infinite, huge and absent parts among the others; as_stored().
inline core::Score any_score(double seconds, std::mt19937& random) {
  const auto one_in = [&](unsigned n) { return random() % n == 0; };
  const auto number = [&] {
    constexpr auto kInf = std::numeric_limits<double>::infinity();
    constexpr std::array kOdd{
        std::numeric_limits<double>::quiet_NaN(), kInf, -kInf, 1e300, 1e-40, -0.0};
    return one_in(10) ? kOdd.at(random() % kOdd.size())
                      : std::ldexp(1.0 + static_cast<double>(random()) * 0x1p-32,
                                   static_cast<int>(random() % 20) - 8);
  };
  core::Score score = score_at(seconds, number());
  score.dissimilarity.cost_per_beam = one_in(5) ? number() : score.dissimilarity.cost / 681;
  score.state = static_cast<core::RobotState>(random() % 6);
  if (one_in(2)) score.threshold.reset();
  if (one_in(7)) score.threshold = number();
  if (!one_in(3)) {
    score.motion = core::MotionScore{.score = number(), .carry = -number()};
    if (one_in(2)) score.motion->confirmed = number();
    if (one_in(2)) score.motion->threshold = number();
  }
  return as_stored(score);
}

}  // namespace kidnapwatch::storage
