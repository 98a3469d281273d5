// SPDX-License-Identifier: Apache-2.0
// The detectors that a configuration asks for beside the alarm's own; recorded, never alarming.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/baselines/particle_detectors.hpp"
#include "core/detector.hpp"
#include "core/session.hpp"

namespace kidnapwatch::service {

/// Of one robot. Those that the paper compares with know no map here: particle weights are the
/// robot's own.
class OtherDetectors {
 public:
  /// `config` passed core::check().
  explicit OtherDetectors(const core::DetectionConfig& config);

  /// What they say of the robot's next good scan, in the order of their numbers.
  [[nodiscard]] std::vector<core::DetectorScore> observe(const core::Scan& scan);

  [[nodiscard]] bool need_particles() const { return need_particles_; }
  /// The weights of the robot's own filter, for its next scan.
  void take_particles(std::vector<double> weights) { particles_->take(std::move(weights)); }

 private:
  std::shared_ptr<core::baselines::StreamedWeights> particles_;
  std::vector<std::pair<core::DetectorId, std::unique_ptr<core::Detector>>> detectors_;
  bool need_particles_ = false;
};

}  // namespace kidnapwatch::service
