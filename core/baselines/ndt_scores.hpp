// SPDX-License-Identifier: Apache-2.0
// Four scores of how well NDT registers consecutive scans. Eqs. (13)-(16).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/baselines/ndt.hpp"
#include "core/detector.hpp"

namespace kidnapwatch::core::baselines {

/// Of one registration.
struct NdtScores {
  double qe = 0.0;  ///< m^2, mean squared distance to the nearest point of the reference; HPTF
  double qs = 0.0;  ///< mean likelihood, 0..1; LPTF
  double qh = 0.0;  ///< 1 / sqrt of the Hessian's smallest eigenvalue, 10 at most; HPTF
  double qo = 0.0;  ///< registered against odometry: metres plus radians; HPTF

  friend bool operator==(const NdtScores&, const NdtScores&) = default;
};

/// Eqs. (13)-(16) of a match that odometry had expected at `guess`.
[[nodiscard]] NdtScores ndt_scores(const NdtMatch& match, const Cloud& reference,
                                   const Cloud& points, const Pose& guess);

/// Registers each comparable scan of one robot with the last one before it, from where odometry
/// puts it; from where that one was if there is no odometry.
class ScanMatcher {
 public:
  explicit ScanMatcher(const NdtConfig& config, const Pose& T_base_lidar = {})
      : config_(config), T_base_lidar_(T_base_lidar) {}

  /// Nothing for the first scan and for those that are not comparable. A scan with the stamp of the
  /// last one is that one: it gets the same answer.
  std::optional<NdtScores> observe(const Scan& scan);

  /// Of the last scan that got scores: the motion of the base.
  [[nodiscard]] const std::optional<Pose>& motion() const { return T_before_now_; }

 private:
  [[nodiscard]] Pose expected_motion(const Scan& scan) const;

  NdtConfig config_;
  Pose T_base_lidar_;
  std::optional<Stamp> stamp_;
  std::optional<NdtScores> scores_;  // of the scan at stamp_
  std::optional<Pose> T_before_now_;
  std::optional<Pose> odometry_;  // of the reference
  Cloud reference_;
  std::optional<NormalDistributions> distributions_;
};

/// "ndt_qe", "ndt_qs", "ndt_qh", "ndt_qo": four detectors that share one registration. Each scan is
/// to be shown to all of those in use.
[[nodiscard]] std::vector<std::unique_ptr<Detector>> ndt_detectors(const NdtConfig& config = {},
                                                                   const Pose& T_base_lidar = {});

}  // namespace kidnapwatch::core::baselines
