// SPDX-License-Identifier: Apache-2.0
// How far a kidnapping stands out from the rest of its run. Eqs. (2) and (3).
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/detector.hpp"

namespace kidnapwatch::core::evaluation {

/// The steps that the kidnapping's score is compared with.
enum class Evaluator {
  prior,  ///< 2..t_k - 1: all that an online detector knew then
  all,    ///< all but t_k: with what came after as well, as in the relocalization tests
};

/// eta of the kidnapping at step `t_k`, counted from 1; scores[t - 1] is that of step t. For HPTF
///
///     eta = (M(t_k) - max M(t)) / max(M(t_k), max M(t))
///
/// and for LPTF the same of min M(t) - M(t_k): positive exactly if a threshold exists that t_k
/// alone is beyond, and never outside of -1..1 for scores that are not negative. Steps without a
/// score are left out; -1 if a score is not finite or t_k has none. Nothing if there is no step to
/// compare with.
[[nodiscard]] std::optional<double> performance_index(std::span<const std::optional<double>> scores,
                                                      std::size_t t_k, Polarity polarity,
                                                      Evaluator evaluator);

/// The performance indices of many kidnappings, in short.
struct Performance {
  double mean = 0.0;        ///< of eta
  double undetected = 0.0;  ///< share with eta <= 0: what to rank detectors by
  std::size_t kidnappings = 0;

  friend bool operator==(const Performance&, const Performance&) = default;
};

[[nodiscard]] Performance performance(std::span<const double> etas);

}  // namespace kidnapwatch::core::evaluation
