// SPDX-License-Identifier: Apache-2.0
// Monte Carlo localization.
#include "core/baselines/mcl.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/baselines/particle_scores.hpp"

namespace kidnapwatch::core::baselines {
namespace {

constexpr double kBin = 0.5;   // m; clusters are sought in bins of so much
constexpr long kHeadings = 8;  // and of an eighth of a turn
constexpr double kClusterRad = 0.6;

/// Index of the bin that a pose is in; poses beyond the map go to the bins at its edge.
class Bins {
 public:
  explicit Bins(const GridLayout& layout)
      : layout_(layout), columns_(count(layout.columns)), rows_(count(layout.rows)) {}

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(columns_ * rows_ * kHeadings);
  }
  [[nodiscard]] std::size_t of(const Pose& pose) const {
    const long column = bin((pose.x_m - layout_.origin_x_m) / kBin, columns_);
    const long row = bin((pose.y_m - layout_.origin_y_m) / kBin, rows_);
    const double turns = pose.theta_rad / (2.0 * std::numbers::pi) + 0.5;
    const long heading = bin(turns * kHeadings, kHeadings);
    return static_cast<std::size_t>((row * columns_ + column) * kHeadings + heading);
  }

 private:
  [[nodiscard]] long count(long cells) const {
    return static_cast<long>(static_cast<double>(cells) * layout_.cell_m / kBin) + 1;
  }
  static long bin(double at, long bins) {
    return std::clamp(static_cast<long>(std::floor(at)), 0L, bins - 1);
  }

  GridLayout layout_;
  long columns_;
  long rows_;
};

bool is_near(const Pose& a, const Pose& b) {
  return std::abs(a.x_m - b.x_m) < kBin && std::abs(a.y_m - b.y_m) < kBin &&
         std::abs(wrapped(a.theta_rad - b.theta_rad)) < kClusterRad;
}

/// A weighted sum of poses, and their mean.
struct PoseSum {
  double weight = 0.0;
  double x = 0.0;
  double y = 0.0;
  double cosine = 0.0;
  double sine = 0.0;

  void add(const Pose& pose, double by) {
    weight += by;
    x += by * pose.x_m;
    y += by * pose.y_m;
    cosine += by * std::cos(pose.theta_rad);
    sine += by * std::sin(pose.theta_rad);
  }
  [[nodiscard]] Pose mean() const { return {x / weight, y / weight, std::atan2(sine, cosine)}; }
};

}  // namespace

Mcl::Mcl(const MeasuredMap& map, const MclConfig& config, std::uint64_t seed)
    : map_(&map),
      config_(config),
      random_(seed),
      particles_(config.particles),
      weights_(config.particles, 1.0 / static_cast<double>(config.particles)),
      log_weights_(config.particles, 0.0),
      log_likelihoods_(config.particles),
      resampled_(config.particles),
      bins_(Bins(map.distances().layout).size()) {
  assert(config.particles > 0 && config.candidates > 0 && config.start_candidates > 0);
  assert(!map.free_cells().empty());
  candidates_.reserve(std::max(config.candidates, config.start_candidates));
  candidate_weights_.reserve(candidates_.capacity());
  std::ranges::generate(particles_, [this] { return anywhere(); });
}

void Mcl::start_at(const Pose& T_map_base, const PoseSpread& spread) {
  for (Pose& particle : particles_) {
    particle = {T_map_base.x_m + spread.position_m * normal_(random_),
                T_map_base.y_m + spread.position_m * normal_(random_),
                wrapped(T_map_base.theta_rad + spread.heading_rad * normal_(random_))};
  }
  weigh_alike();
}

void Mcl::start_anywhere(const Scan& scan) {
  choose_beams(scan, map_->config(), beams_);
  std::ranges::generate(particles_, [this] { return anywhere_by_scan(config_.start_candidates); });
  weigh_alike();
}

std::optional<MclUpdate> Mcl::update(const Scan& scan, const Pose& T_before_now,
                                     const std::optional<Pose>& true_pose) {
  move(T_before_now);
  choose_beams(scan, map_->config(), beams_);
  if (beams_.size() == 0) return std::nullopt;
  MclUpdate update;
  weigh(update);
  find_cluster(update);
  if (config_.relocalization == Relocalization::global) update.random_share = random_share();
  const auto particles = static_cast<double>(particles_.size());
  if (update.random_share > 0.0 || update.effective < config_.resample_below * particles) {
    resample(update.random_share);
  }
  if (config_.relocalization == Relocalization::perfect && true_pose) {
    const Pose off = inverse(*true_pose) * update.T_map_base;
    update.relocalized =
        std::hypot(off.x_m, off.y_m) > config_.lost_m || std::abs(off.theta_rad) > config_.lost_rad;
    if (update.relocalized) start_at(*true_pose);
  }
  return update;
}

void Mcl::move(const Pose& T_before_now) {
  const OdometryMotion motion(T_before_now, config_.odometry_noise);
  for (Pose& particle : particles_) particle = motion.drawn(particle, random_, normal_);
}

void Mcl::weigh(MclUpdate& update) {
  double best = -std::numeric_limits<double>::infinity();
  double fit = 0.0;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const double per_beam = map_->log_likelihood(particles_[i], beams_);
    best = std::max(best, per_beam);
    fit += weights_[i] * std::exp(per_beam);
    log_likelihoods_[i] = per_beam;
  }
  update.max_current_weight = std::exp(best);  // Eq. (9)
  follow_fit(fit);
  const auto beams = static_cast<double>(beams_.size());
  const double counted = std::min(config_.independent_beams, beams);
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    log_weights_[i] += counted * log_likelihoods_[i];
    log_likelihoods_[i] *= beams;
  }
  update.measurement_entropy = measurement_entropy_of_logs(log_likelihoods_);  // Eqs. (10)-(12)
  normalise();
  update.effective = effective_sample_size(weights_);
}

void Mcl::weigh_alike() {
  std::ranges::fill(weights_, 1.0 / static_cast<double>(weights_.size()));
  std::ranges::fill(log_weights_, 0.0);
}

void Mcl::normalise() {
  const double most = *std::ranges::max_element(log_weights_);
  double sum = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    log_weights_[i] -= most;
    weights_[i] = std::exp(log_weights_[i]);
    sum += weights_[i];
  }
  for (double& weight : weights_) weight /= sum;
}

void Mcl::find_cluster(MclUpdate& update) {
  const Bins bins(map_->distances().layout);
  std::ranges::fill(bins_, 0.0);
  for (std::size_t i = 0; i < particles_.size(); ++i) bins_[bins.of(particles_[i])] += weights_[i];
  const auto heaviest = static_cast<std::size_t>(std::ranges::max_element(bins_) - bins_.begin());
  PoseSum in_bin;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    if (bins.of(particles_[i]) == heaviest) in_bin.add(particles_[i], weights_[i]);
  }
  const Pose centre = in_bin.mean();
  PoseSum cluster;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    if (is_near(particles_[i], centre)) cluster.add(particles_[i], weights_[i]);
  }
  update.T_map_base = cluster.weight > 0.0 ? cluster.mean() : centre;
  update.share = std::max(cluster.weight, in_bin.weight);
}

/// Augmented MCL (Thrun, Burgard, Fox 2005, Table 8.3): how well scans fit, in the long and in the
/// short run.
void Mcl::follow_fit(double fit) {
  if (slow_fit_ == 0.0) slow_fit_ = fast_fit_ = fit;
  slow_fit_ += config_.recovery_slow * (fit - slow_fit_);
  fast_fit_ += config_.recovery_fast * (fit - fast_fit_);
}

double Mcl::random_share() const { return std::max(0.0, 1.0 - fast_fit_ / slow_fit_); }

/// Low-variance resampling (Table 4.4), a share of the particles replaced by random ones.
void Mcl::resample(double random_share) {
  const double step = 1.0 / static_cast<double>(particles_.size());
  double pointer = step * uniform(random_);
  double passed = weights_.front();
  std::size_t i = 0;
  for (Pose& drawn : resampled_) {
    while (pointer > passed && i + 1 < particles_.size()) passed += weights_[++i];
    pointer += step;
    const bool random = random_share > 0.0 && uniform(random_) < random_share;
    drawn = random ? anywhere_by_scan(config_.candidates) : particles_[i];
  }
  particles_.swap(resampled_);
  weigh_alike();
}

Pose Mcl::anywhere() {
  const GridLayout& layout = map_->distances().layout;
  const std::vector<std::size_t>& free = map_->free_cells();
  const auto cell = static_cast<long>(free[random_() % free.size()]);
  const long column = cell % layout.columns;
  const long row = cell / layout.columns;
  const double heading_rad = std::numbers::pi * (1.0 - 2.0 * uniform(random_));
  return {layout.origin_x_m + (static_cast<double>(column) + uniform(random_)) * layout.cell_m,
          layout.origin_y_m + (static_cast<double>(row) + uniform(random_)) * layout.cell_m,
          heading_rad};
}

/// One of some poses anywhere, drawn by their likelihood.
Pose Mcl::anywhere_by_scan(std::size_t candidates) {
  candidates_.resize(candidates);
  candidate_weights_.resize(candidates);
  std::ranges::generate(candidates_, [this] { return anywhere(); });
  if (beams_.size() == 0) return candidates_.front();
  const double beams = std::min(config_.independent_beams, static_cast<double>(beams_.size()));
  double sum = 0.0;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    sum += std::exp(beams * map_->log_likelihood(candidates_[i], beams_));
    candidate_weights_[i] = sum;
  }
  const double drawn = sum * uniform(random_);
  const auto chosen = std::ranges::upper_bound(candidate_weights_, drawn);
  const auto last = static_cast<std::ptrdiff_t>(candidates_.size()) - 1;
  return candidates_[static_cast<std::size_t>(std::min(chosen - candidate_weights_.begin(), last))];
}

}  // namespace kidnapwatch::core::baselines
