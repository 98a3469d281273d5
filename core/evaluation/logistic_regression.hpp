// SPDX-License-Identifier: Apache-2.0
// Logistic regression of several scores on one label, with stepwise selection (section 5's LR).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kidnapwatch::core::evaluation {

/// What detectors said at one time, and what was true.
struct Example {
  std::vector<double> features;  ///< finite; as many in every example
  bool kidnapped = false;
};

struct LogisticModel {
  std::vector<std::size_t> selected;  ///< features in the model, in ascending order
  double intercept = 0.0;
  std::vector<double> coefficients;  ///< one per selected feature
  double intercept_error = 0.0;      ///< standard errors, from the observed information
  std::vector<double> coefficient_errors;
  double log_likelihood = 0.0;  ///< without the penalty
  bool converged = false;       ///< false where the classes can be parted: then there is no maximum
};

struct LogisticConfig {
  double ridge = 0.0;  ///< penalty ridge / 2 * sum of squared coefficients, intercept free
  std::size_t iterations = 50;
  double enter_p = 0.05;  ///< a feature enters if its likelihood-ratio test is below
  double leave_p = 0.10;  ///< and leaves if it is above
};

/// Maximum likelihood by Newton's method (iteratively reweighted least squares) with halved steps.
/// Of the features in `selected` alone. Both classes occur.
[[nodiscard]] LogisticModel fit(std::span<const Example> examples,
                                std::span<const std::size_t> selected,
                                const LogisticConfig& config = {});

/// Begins with the intercept alone; takes in the feature whose likelihood-ratio test (chi-square
/// with one degree of freedom) is the clearest and lets go those that it made needless, until
/// neither is called for.
[[nodiscard]] LogisticModel stepwise(std::span<const Example> examples,
                                     const LogisticConfig& config = {});

/// The probability of a kidnapping.
[[nodiscard]] double probability(const LogisticModel& model, std::span<const double> features);

}  // namespace kidnapwatch::core::evaluation
