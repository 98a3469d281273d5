// SPDX-License-Identifier: Apache-2.0
// Recursive least squares of the lidar's motion against the odometry's.
#include "core/wheel_model.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace kidnapwatch::core {
namespace {

constexpr double kForget = 0.998;        // per pair: a memory of some 500 pairs
constexpr double kNoiseTurn_rad = 0.01;  // of one alignment
constexpr double kNoiseWay_m = 0.02;

using Rows = Eigen::Matrix<double, 2, 4>;

Eigen::Vector2d turn_row(const Wheels& w) {
  return {w.motion.theta_rad, w.before.theta_rad / w.before_scans - w.motion.theta_rad / w.scans};
}

Rows way_rows(const Wheels& w) {
  const double jx = w.motion.x_m / w.scans - w.before.x_m / w.before_scans;
  const double jy = w.motion.y_m / w.scans - w.before.y_m / w.before_scans;
  const double c = std::cos(w.motion.theta_rad) - 1.0;
  const double s = std::sin(w.motion.theta_rad);
  Rows rows;
  rows << w.motion.x_m, -jx, c, -s, w.motion.y_m, -jy, s, c;
  return rows;
}

/// Cauchy weight of a residual of so many standard deviations.
double weight(double sigmas) { return 1.0 / (1.0 + sigmas * sigmas / 9.0); }

}  // namespace

Pose WheelModel::expected(const Wheels& wheels) const {
  const Eigen::Vector2d shift = way_rows(wheels) * going_;
  return {wheels.motion.x_m + shift[0], wheels.motion.y_m + shift[1],
          wrapped(wheels.motion.theta_rad + turn_row(wheels).dot(turning_))};
}

void WheelModel::learn(const Wheels& wheels, const Pose& seen) {
  const Pose expectation = expected(wheels);
  const Eigen::Vector2d row = turn_row(wheels);
  const double turn_error = wrapped(seen.theta_rad - wheels.motion.theta_rad);
  const double miss = wrapped(seen.theta_rad - expectation.theta_rad) / kNoiseTurn_rad;
  const double wt = weight(miss) / (kNoiseTurn_rad * kNoiseTurn_rad);
  turning_H_ = kForget * turning_H_ + wt * row * row.transpose();
  turning_b_ = kForget * turning_b_ + wt * row * turn_error;
  const Rows rows = way_rows(wheels);
  const Eigen::Vector2d error{seen.x_m - wheels.motion.x_m, seen.y_m - wheels.motion.y_m};
  const double ww =
      weight(distance_m(seen, expectation) / kNoiseWay_m) / (kNoiseWay_m * kNoiseWay_m);
  going_H_ = kForget * going_H_ + ww * rows.transpose() * rows;
  going_b_ = kForget * going_b_ + ww * rows.transpose() * error;
  // What to believe before anything was seen: nothing, to within these.
  const Eigen::Vector2d turn_prior{1 / (0.1 * 0.1), 1 / (0.5 * 0.5)};
  const Eigen::Vector4d way_prior{1 / (0.1 * 0.1), 1 / (0.5 * 0.5), 1 / (0.3 * 0.3),
                                  1 / (0.3 * 0.3)};
  turning_ = (turning_H_ + Eigen::Matrix2d(turn_prior.asDiagonal())).ldlt().solve(turning_b_);
  going_ = (going_H_ + Eigen::Matrix4d(way_prior.asDiagonal())).ldlt().solve(going_b_);
}

}  // namespace kidnapwatch::core
