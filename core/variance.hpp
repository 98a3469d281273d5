// SPDX-License-Identifier: Apache-2.0
// Do two samples have the same variance? Section 3.3, Eqs. (4)-(8), for k = 2 groups.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/moments.hpp"

namespace kidnapwatch::core {

enum class VarianceTest {
  bartlett,        ///< Eqs. (4)-(6); sensitive to tails
  levene,          ///< Eqs. (7)-(8) about the mean
  brown_forsythe,  ///< Eqs. (7)-(8) about the median
};

/// The statistic V of the test for two samples of at least two values each. 0 if neither sample
/// varies, infinity if exactly one does.
[[nodiscard]] double variance_statistic(VarianceTest test, std::span<const double> a,
                                        std::span<const double> b);

/// Bartlett's, from the moments of samples of n_a and n_b values.
[[nodiscard]] double bartlett_statistic(const Moments& a, std::size_t n_a, const Moments& b,
                                        std::size_t n_b);

/// F(significance; 1, samples - 2): the value that V exceeds with probability `significance` if the
/// variances are equal (section 3.3). 0 < significance < 1, samples > 2.
[[nodiscard]] double critical_value(double significance, std::size_t samples);

/// critical_value() of one significance, each looked up once: it takes some 5 us.
class CriticalValues {
 public:
  [[nodiscard]] double at(double significance, std::size_t samples);

 private:
  double significance_ = 0.0;
  std::vector<double> values_;  // by number of samples; 0 where not yet known
};

}  // namespace kidnapwatch::core
