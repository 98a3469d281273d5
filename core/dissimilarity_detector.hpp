// SPDX-License-Identifier: Apache-2.0
// QS-2DDTW and its siblings in the shape that all detectors share.
#pragma once

#include <array>
#include <memory>

#include "core/detector.hpp"
#include "core/dissimilarity.hpp"

namespace kidnapwatch::core {

/// The six variants, {1-D, 2-D} x {raw, standardized, quasi-standardized}, in this order; `reading`
/// says all else, and with its gate (`paper` or `homogeneous`) what quasi-standardized means.
[[nodiscard]] std::array<DissimilarityConfig, 6> dtw_variants(const DissimilarityConfig& reading);

/// The cost of warping each comparable scan onto the last one before it: HPTF. Nothing for the
/// first and for those that are not comparable. Its name is detector_name(config).
[[nodiscard]] std::unique_ptr<Detector> dissimilarity_detector(const DissimilarityConfig& config);

}  // namespace kidnapwatch::core
