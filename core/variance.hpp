// SPDX-License-Identifier: Apache-2.0
// Do two samples have the same variance? Section 3.3, Eqs. (4)-(8), for k = 2 groups.
#pragma once

#include <cstddef>
#include <span>

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

/// F(significance; 1, samples - 2): the value that V exceeds with probability `significance` if the
/// variances are equal (section 3.3). 0 < significance < 1, samples > 2.
[[nodiscard]] double critical_value(double significance, std::size_t samples);

}  // namespace kidnapwatch::core
