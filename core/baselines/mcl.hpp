// SPDX-License-Identifier: Apache-2.0
// Monte Carlo localization (Fox et al. 1999), and what its weights tell of kidnappings. Eqs. (9)-
// (12).
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "core/baselines/measurement.hpp"
#include "core/baselines/odometry_motion.hpp"
#include "core/random.hpp"
#include "core/scan.hpp"

namespace kidnapwatch::core::baselines {

/// What a filter does that may be lost.
enum class Relocalization {
  none,     ///< nothing
  global,   ///< augmented MCL: random particles while scans fit worse than they used to
  perfect,  ///< once lost, it is put to the true pose: what a perfect relocalization would reach
};

struct MclConfig {
  std::size_t particles = 2000;
  OdometryNoise odometry_noise;
  /// As how many independent beams a scan counts; neighbouring ones err together.
  double independent_beams = 12.0;
  double resample_below = 0.5;  ///< effective sample size, as a share of the particles
  Relocalization relocalization = Relocalization::none;
  double recovery_slow = 0.01;  ///< augmented MCL's rates, per scan
  double recovery_fast = 0.2;
  std::size_t candidates = 10;  ///< random poses per random particle; the scan chooses among them
  std::size_t start_candidates = 100;  ///< the same when all start anywhere
  double lost_m = 1.0;  ///< perfect relocalization: an estimate this far off the truth is lost
  double lost_rad = 0.5;
};

/// Standard deviations of particles around a pose that they start at.
struct PoseSpread {
  double position_m = 0.1;
  double heading_rad = 0.05;
};

struct MclUpdate {
  Pose T_map_base;            ///< mean of the heaviest cluster
  double share = 0.0;         ///< of the weight that this cluster has
  double effective = 0.0;     ///< effective sample size, before resampling
  double random_share = 0.0;  ///< of particles that were replaced by random ones
  bool relocalized = false;   ///< put to the true pose, after these scores
  /// Eq. (9): the best particle's likelihood, geometric mean per beam: from random_share to 1.
  double max_current_weight = 0.0;
  /// Eqs. (10)-(12) of the particles' measurement likelihoods.
  double measurement_entropy = 0.0;
};

/// A filter on a map, which outlives it. A copy goes on as the original would have.
class Mcl {
 public:
  /// The particles start anywhere; the same seed and calls give the same results.
  Mcl(const MeasuredMap& map, const MclConfig& config, std::uint64_t seed);

  void start_at(const Pose& T_map_base, const PoseSpread& spread = {});

  /// On free cells with any heading, the scan choosing among `candidates` poses for each particle.
  void start_anywhere(const Scan& scan);

  /// Moves the particles by odometry and weighs them by the scan. The true pose is only looked at
  /// by perfect relocalization. Nothing, after the motion, for a scan without a valid beam.
  std::optional<MclUpdate> update(const Scan& scan, const Pose& T_before_now,
                                  const std::optional<Pose>& true_pose = std::nullopt);

  [[nodiscard]] std::span<const Pose> particles() const { return particles_; }
  /// Normalised.
  [[nodiscard]] std::span<const double> weights() const { return weights_; }

 private:
  void move(const Pose& T_before_now);
  void weigh(MclUpdate& update);
  void weigh_alike();
  void normalise();
  void find_cluster(MclUpdate& update);
  void follow_fit(double fit);
  [[nodiscard]] double random_share() const;
  void resample(double random_share);
  Pose anywhere();
  Pose anywhere_by_scan(std::size_t candidates);

  const MeasuredMap* map_;
  MclConfig config_;
  std::mt19937_64 random_;
  Normal normal_;
  std::vector<Pose> particles_;
  std::vector<double> weights_;
  std::vector<double> log_weights_;  // not normalised
  double slow_fit_ = 0.0;            // w_slow and w_fast of augmented MCL; 0 before the first scan
  double fast_fit_ = 0.0;
  // Memory of one update.
  BeamSubset beams_;
  std::vector<double> log_likelihoods_;
  std::vector<Pose> resampled_;
  std::vector<Pose> candidates_;
  std::vector<double> candidate_weights_;
  std::vector<double> bins_;
};

}  // namespace kidnapwatch::core::baselines
