// SPDX-License-Identifier: Apache-2.0
// The four scores, and detectors that each show one of them.
#include "core/baselines/ndt_scores.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace kidnapwatch::core::baselines {
namespace {

constexpr double kLargestQh = 10.0;

/// Eq. (13): mean over the points, seen from `pose`, of the squared distance to the reference.
double nearest_neighbour_mse(const Cloud& reference, const Cloud& points, const Pose& pose) {
  const double c = std::cos(pose.theta_rad);
  const double s = std::sin(pose.theta_rad);
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = c * points.x[i] - s * points.y[i] + pose.x_m;
    const double y = s * points.x[i] + c * points.y[i] + pose.y_m;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < reference.size(); ++j) {
      const double dx = reference.x[j] - x;
      const double dy = reference.y[j] - y;
      nearest = std::min(nearest, dx * dx + dy * dy);
    }
    sum += nearest;
  }
  return sum / static_cast<double>(points.size());
}

/// Eq. (15).
double weakest_direction(const std::array<double, 9>& hessian) {
  const Eigen::Map<const Eigen::Matrix3d> matrix(hessian.data());  // symmetric
  const double least =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix, Eigen::EigenvaluesOnly)
          .eigenvalues()[0];
  return least > 0.0 ? std::min(kLargestQh, 1.0 / std::sqrt(least)) : kLargestQh;
}

/// Eq. (16).
double disagreement(const Pose& registered, const Pose& expected) {
  const Pose off = inverse(expected) * registered;
  return std::hypot(off.x_m, off.y_m) + std::abs(off.theta_rad);
}

class NdtDetector : public Detector {
 public:
  NdtDetector(std::string_view name, Polarity polarity, double NdtScores::*score,
              std::shared_ptr<ScanMatcher> matcher)
      : name_(name), polarity_(polarity), score_(score), matcher_(std::move(matcher)) {}

  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] Polarity polarity() const override { return polarity_; }
  [[nodiscard]] std::optional<double> observe(const Scan& scan) override {
    const auto scores = matcher_->observe(scan);
    if (!scores) return std::nullopt;
    return (*scores).*score_;
  }

 private:
  std::string_view name_;
  Polarity polarity_;
  double NdtScores::*score_;
  std::shared_ptr<ScanMatcher> matcher_;
};

}  // namespace

NdtScores ndt_scores(const NdtMatch& match, const Cloud& reference, const Cloud& points,
                     const Pose& guess) {
  return {nearest_neighbour_mse(reference, points, match.T_before_now), match.mean_likelihood,
          weakest_direction(match.hessian), disagreement(match.T_before_now, guess)};
}

Pose ScanMatcher::expected_motion(const Scan& scan) const {
  if (!odometry_ || !scan.odometry) return {};
  const Pose T_before_now = inverse(*odometry_) * *scan.odometry;
  return inverse(T_base_lidar_) * T_before_now * T_base_lidar_;
}

std::optional<NdtScores> ScanMatcher::observe(const Scan& scan) {
  if (stamp_ == scan.stamp) return scores_;
  stamp_ = scan.stamp;
  scores_.reset();
  if (!is_comparable(scan)) return std::nullopt;
  Cloud points = cloud(scan, InvalidPolicy::drop);
  if (distributions_) {
    const Pose guess = expected_motion(scan);
    const NdtMatch found = match(*distributions_, points, guess, config_);
    scores_ = ndt_scores(found, reference_, points, guess);
    T_before_now_ = T_base_lidar_ * found.T_before_now * inverse(T_base_lidar_);
  }
  distributions_.emplace(points, config_);
  reference_ = std::move(points);
  odometry_ = scan.odometry;
  return scores_;
}

std::vector<std::unique_ptr<Detector>> ndt_detectors(const NdtConfig& config,
                                                     const Pose& T_base_lidar) {
  const auto matcher = std::make_shared<ScanMatcher>(config, T_base_lidar);
  std::vector<std::unique_ptr<Detector>> detectors;
  const auto add = [&](std::string_view name, Polarity polarity, double NdtScores::*score) {
    detectors.push_back(std::make_unique<NdtDetector>(name, polarity, score, matcher));
  };
  add("ndt_qe", Polarity::hptf, &NdtScores::qe);
  add("ndt_qs", Polarity::lptf, &NdtScores::qs);
  add("ndt_qh", Polarity::hptf, &NdtScores::qh);
  add("ndt_qo", Polarity::hptf, &NdtScores::qo);
  return detectors;
}

}  // namespace kidnapwatch::core::baselines
