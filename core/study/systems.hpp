// SPDX-License-Identifier: Apache-2.0
// All that the paper compares, in every reading of it, by name.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/baselines/mcl.hpp"
#include "core/dissimilarity.hpp"
#include "core/study/algorithm2.hpp"

namespace kidnapwatch::core::study {

/// "2ddtw drop", "qs2ddtw homogeneous levene clamp": the variant, and what it depends on.
[[nodiscard]] std::string id_of(const DissimilarityConfig& config);

/// The readings of the paper's Algorithm 3: {1-D, 2-D} x {drop, clamp} x {raw, standardized, and
/// quasi-standardized by either gate and each of three variance tests}: 32 detectors.
[[nodiscard]] std::vector<DissimilarityConfig> readings();
[[nodiscard]] Detectors dtw_systems();

/// "ndt_qe", "ndt_qs", "ndt_qh", "ndt_qo".
[[nodiscard]] Detectors ndt_systems();

/// "mcw none", "me lptf none", "me hptf none", and with "global" and "perfect" for "none".
[[nodiscard]] std::string mcw_id(baselines::Relocalization relocalization);
[[nodiscard]] std::string me_id(Polarity polarity, baselines::Relocalization relocalization);

/// Eqs. (9)-(12) of a filter that starts where the robot does: one filter is run to each t_k, and a
/// copy of it from there on.
[[nodiscard]] std::vector<TrialRecord> mcl_records(const Trial& trial,
                                                   const baselines::MeasuredMap& map,
                                                   const baselines::MclConfig& config,
                                                   std::uint64_t seed);

}  // namespace kidnapwatch::core::study
