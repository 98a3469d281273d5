// SPDX-License-Identifier: Apache-2.0
// Maximum current weight and measurement entropy as detectors. Eqs. (9)-(12).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/baselines/mcl.hpp"
#include "core/detector.hpp"

namespace kidnapwatch::core::baselines {

/// "mcw" (LPTF) and "me" of a filter of our own on `map`, which outlives them: they share it, and
/// each scan is to be shown to both. It starts at `start`, or anywhere that the first scan fits.
/// Scans without odometry, and those without a valid beam, get no score.
[[nodiscard]] std::vector<std::unique_ptr<Detector>> mcl_detectors(
    const MeasuredMap& map, const MclConfig& config, std::uint64_t seed,
    const std::optional<Pose>& start, Polarity me_polarity = Polarity::lptf);

/// The weights that a robot's own filter published last.
class StreamedWeights {
 public:
  /// Not normalised for "mcw" to mean anything.
  void take(std::vector<double> weights) {
    weights_ = std::move(weights);
    ++taken_;
  }
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }
  [[nodiscard]] std::uint64_t taken() const { return taken_; }

 private:
  std::vector<double> weights_;
  std::uint64_t taken_ = 0;
};

/// "mcw" and "me" of the weights taken since the scan before; nothing for a scan without new ones,
/// and for weights that are none (negative, not finite, all 0).
[[nodiscard]] std::vector<std::unique_ptr<Detector>> particle_detectors(
    const std::shared_ptr<const StreamedWeights>& stream, Polarity me_polarity = Polarity::lptf);

}  // namespace kidnapwatch::core::baselines
