// SPDX-License-Identifier: Apache-2.0
// The transform, its derivatives, and Newton's method on them.
#include "core/baselines/ndt.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/Dense>

namespace kidnapwatch::core::baselines {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kGrids = 4;
constexpr double kFarthest = 18.0;  // in d' S^-1 d / 2: less than 1.6e-8 of likelihood
// Of a step: with 0.5 m and 0.3 rad it leaps into other basins (96, not 99.7 % found in ndt_test).
constexpr double kLongestStepM = 0.1;
constexpr double kLongestTurnRad = 0.1;
constexpr double kArrived = 1e-6;     // m and rad
constexpr double kSufficient = 1e-4;  // Armijo: share of the promised decrease
constexpr int kHalvings = 12;

Vector3d vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

Matrix3d matrix(const std::array<double, 9>& m) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m.data());
}

Pose moved(const Pose& pose, const Vector3d& step) {
  return {pose.x_m + step[0], pose.y_m + step[1], wrapped(pose.theta_rad + step[2])};
}

/// Newton's step on the Hessian made positive definite: downhill, and no longer than allowed.
Vector3d newton_step(const NdtFit& fit) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(matrix(fit.hessian));
  const double floor = std::max(1e-9, 1e-4 * eigen.eigenvalues().cwiseAbs().maxCoeff());
  const Vector3d curvatures = eigen.eigenvalues().cwiseAbs().cwiseMax(floor);
  const Vector3d along = eigen.eigenvectors().transpose() * vector(fit.gradient);
  const Vector3d step = -(eigen.eigenvectors() * along.cwiseQuotient(curvatures));
  const double excess =
      std::max(step.head<2>().norm() / kLongestStepM, std::abs(step[2]) / kLongestTurnRad);
  return step / std::max(1.0, excess);
}

/// Descends to a minimum from `pose`; whether it got there.
bool descend(const NormalDistributions& reference, const Cloud& points, double widening,
             std::size_t iterations, Pose& pose) {
  for (std::size_t i = 0; i < iterations; ++i) {
    const NdtFit fit = reference.fit(points, pose, widening);
    Vector3d step = newton_step(fit);
    const double promised = vector(fit.gradient).dot(step);
    int halvings = 0;
    while (reference.objective(points, moved(pose, step), widening) >
           fit.objective + kSufficient * promised * std::ldexp(1.0, -halvings)) {
      if (++halvings == kHalvings) return true;  // as low as rounding lets it get
      step *= 0.5;
    }
    pose = moved(pose, step);
    if (step.cwiseAbs().maxCoeff() < kArrived) return true;
  }
  return false;
}

}  // namespace

struct NormalDistributions::Sums {
  double n = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
};

NormalDistributions::NormalDistributions(const Cloud& points, const NdtConfig& config)
    : cell_m_(config.cell_m) {
  assert(points.size() > 0);
  const auto [west, east] = std::ranges::minmax(points.x);
  const auto [south, north] = std::ranges::minmax(points.y);
  west_m_ = west - cell_m_;
  south_m_ = south - cell_m_;
  columns_ = static_cast<long>((east - west_m_) / cell_m_) + 2;
  rows_ = static_cast<long>((north - south_m_) / cell_m_) + 2;
  slots_.assign(kGrids * static_cast<std::size_t>(columns_ * rows_), -1);
  std::vector<Sums> sums(slots_.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t grid = 0; grid < kGrids; ++grid) {
      Sums& sum = sums[static_cast<std::size_t>(cell_at(points.x[i], points.y[i], grid))];
      // about the corner: sums of squares far from 0 would lose their digits
      const double x = points.x[i] - west_m_;
      const double y = points.y[i] - south_m_;
      sum = {sum.n + 1.0, sum.x + x, sum.y + y, sum.xx + x * x, sum.xy + x * y, sum.yy + y * y};
    }
  }
  for (std::size_t slot = 0; slot < sums.size(); ++slot) add_cell(sums[slot], slot, config);
}

/// Index of the cell of a grid that the point is in; -1 outside.
long NormalDistributions::cell_at(double x, double y, std::size_t grid) const {
  const double shift_x = (grid & 1U) != 0 ? 0.5 : 0.0;
  const double shift_y = (grid & 2U) != 0 ? 0.5 : 0.0;
  const double column = std::floor((x - west_m_) / cell_m_ + shift_x);
  const double row = std::floor((y - south_m_) / cell_m_ + shift_y);
  if (!(column >= 0.0 && column < static_cast<double>(columns_) && row >= 0.0 &&
        row < static_cast<double>(rows_))) {
    return -1;
  }
  return (static_cast<long>(grid) * rows_ + static_cast<long>(row)) * columns_ +
         static_cast<long>(column);
}

void NormalDistributions::add_cell(const Sums& sums, std::size_t slot, const NdtConfig& config) {
  if (sums.n < static_cast<double>(config.least_points)) return;
  const double x = sums.x / sums.n;
  const double y = sums.y / sums.n;
  Eigen::Matrix2d covariance;
  covariance << sums.xx - sums.n * x * x, sums.xy - sums.n * x * y, sums.xy - sums.n * x * y,
      sums.yy - sums.n * y * y;
  covariance /= sums.n - 1.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance);
  const double floor = std::max(config.least_eigen_share * eigen.eigenvalues()[1],
                                config.least_spread_m * config.least_spread_m);
  const Eigen::Vector2d variances = eigen.eigenvalues().cwiseMax(floor);
  const Eigen::Matrix2d inverse = eigen.eigenvectors() * variances.cwiseInverse().asDiagonal() *
                                  eigen.eigenvectors().transpose();
  slots_[slot] = static_cast<int>(cells_.size());
  cells_.push_back({x + west_m_, y + south_m_, inverse(0, 0), inverse(0, 1), inverse(1, 1)});
}

/// Calls visit(x, y, bx, by, likelihood, cell) for every point and grid where there is a cell:
/// (x, y) is the point turned, but not moved, by the pose, (bx, by) = S^-1 d.
template <typename Visit>
void NormalDistributions::for_each_hit(const Cloud& points, const Pose& pose, double widening,
                                       Visit visit) const {
  const double c = std::cos(pose.theta_rad);
  const double s = std::sin(pose.theta_rad);
  const double narrow = 1.0 / widening;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = c * points.x[i] - s * points.y[i];
    const double y = s * points.x[i] + c * points.y[i];
    for (std::size_t grid = 0; grid < kGrids; ++grid) {
      const long index = cell_at(x + pose.x_m, y + pose.y_m, grid);
      if (index < 0) continue;
      const int slot = slots_[static_cast<std::size_t>(index)];
      if (slot < 0) continue;
      const Cell& cell = cells_[static_cast<std::size_t>(slot)];
      const double dx = x + pose.x_m - cell.x;
      const double dy = y + pose.y_m - cell.y;
      const double bx = narrow * (cell.xx * dx + cell.xy * dy);
      const double by = narrow * (cell.xy * dx + cell.yy * dy);
      const double exponent = 0.5 * (dx * bx + dy * by);
      if (exponent < kFarthest) visit(x, y, bx, by, std::exp(-exponent), cell);
    }
  }
}

double NormalDistributions::objective(const Cloud& points, const Pose& pose,
                                      double widening) const {
  double sum = 0.0;
  for_each_hit(
      points, pose, widening,
      [&](double, double, double, double, double likelihood, const Cell&) { sum += likelihood; });
  return -sum;
}

NdtFit NormalDistributions::fit(const Cloud& points, const Pose& pose, double widening) const {
  NdtFit fit;
  const double narrow = 1.0 / widening;
  for_each_hit(points, pose, widening,
               [&](double x, double y, double bx, double by, double p, const Cell& cell) {
                 // d changes by (1, 0), (0, 1) and (-y, x); twice by theta by (-x, -y).
                 const double bt = x * by - y * bx;
                 const double xx = narrow * cell.xx;
                 const double xy = narrow * cell.xy;
                 const double yy = narrow * cell.yy;
                 const double xt = x * xy - y * xx;
                 const double yt = x * yy - y * xy;
                 const double tt = x * yt - y * xt - (x * bx + y * by);
                 fit.objective -= p;
                 fit.gradient[0] += p * bx;
                 fit.gradient[1] += p * by;
                 fit.gradient[2] += p * bt;
                 fit.hessian[0] += p * (xx - bx * bx);
                 fit.hessian[1] += p * (xy - bx * by);
                 fit.hessian[2] += p * (xt - bx * bt);
                 fit.hessian[4] += p * (yy - by * by);
                 fit.hessian[5] += p * (yt - by * bt);
                 fit.hessian[8] += p * (tt - bt * bt);
               });
  fit.hessian[3] = fit.hessian[1];
  fit.hessian[6] = fit.hessian[2];
  fit.hessian[7] = fit.hessian[5];
  return fit;
}

NdtMatch match(const NormalDistributions& reference, const Cloud& points, const Pose& guess,
               const NdtConfig& config) {
  assert(points.size() > 0);
  NdtMatch result;
  result.T_before_now = guess;
  descend(reference, points, config.wide_variances, config.iterations, result.T_before_now);
  result.converged = descend(reference, points, 1.0, config.iterations, result.T_before_now);
  const NdtFit fit = reference.fit(points, result.T_before_now, 1.0);
  result.mean_likelihood = -fit.objective / static_cast<double>(kGrids * points.size());
  result.hessian = fit.hessian;
  return result;
}

}  // namespace kidnapwatch::core::baselines
