// SPDX-License-Identifier: Apache-2.0
// How well a logistic regression does on runs that it has not seen.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/evaluation/logistic_regression.hpp"

namespace kidnapwatch::core::evaluation {

/// Probabilities for every example of every run, each by a model that was selected (stepwise) and
/// fitted on the other runs alone; features are scaled by the mean and deviation that they have
/// there. `times_selected` counts, per feature, the models that it is in.
struct HeldOut {
  std::vector<std::vector<double>> probabilities;  ///< by run and example
  std::vector<std::size_t> times_selected;
};

/// Leave one run out. At least two runs; without any one of them, the others have both classes.
[[nodiscard]] HeldOut held_out(std::span<const std::vector<Example>> runs,
                               const LogisticConfig& config = {});

}  // namespace kidnapwatch::core::evaluation
