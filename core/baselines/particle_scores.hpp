// SPDX-License-Identifier: Apache-2.0
// What the weights of a particle filter tell about a kidnapping. Eqs. (9)-(12).
#pragma once

#include <span>

namespace kidnapwatch::core::baselines {

/// Maximum current weight, Eq. (9), of weights before normalising; LPTF. 0 for no weights.
///
/// Normalised weights say nothing: however badly all particles fit, they sum up to 1.
[[nodiscard]] double max_current_weight(std::span<const double> weights);

/// Measurement entropy, Eqs. (10)-(12): -sum w ln w of the weights w, normalised; in nats, from 0
/// (one particle has it all) to ln N (all alike). The paper prints it as HPTF. Measured, it is
/// LPTF: where no particle fits, the few that fit least badly take all the weight. NaN unless all
/// weights are finite and >= 0 and one is > 0.
[[nodiscard]] double measurement_entropy(std::span<const double> weights);

/// The same of logarithms of weights, which may differ by any factor. NaN if none is finite.
[[nodiscard]] double measurement_entropy_of_logs(std::span<const double> log_weights);

/// 1 / sum w^2 of the weights, normalised: how many particles count (Kong, Liu, Wong 1994).
[[nodiscard]] double effective_sample_size(std::span<const double> weights);

}  // namespace kidnapwatch::core::baselines
