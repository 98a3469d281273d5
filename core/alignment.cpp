// SPDX-License-Identifier: Apache-2.0
// Point-to-line ICP with polar association.
#include "core/alignment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace kidnapwatch::core {
namespace {

constexpr float kSearchMax = 8.0F;  // beams to either side of a point's bearing

struct System {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  int matches = 0;
};

/// Index with margin of the point of `contour` nearest to (x, y) around `beam`; squared distance in
/// d2.
std::size_t nearest(const Contour& contour, int beam, int half_width, float x, float y, float& d2) {
  const std::size_t from =
      Contour::kMargin + static_cast<std::size_t>(beam) - static_cast<std::size_t>(half_width);
  const std::size_t to = from + 2 * static_cast<std::size_t>(half_width);
  std::size_t best = from;
  d2 = 1e9F;
  for (std::size_t k = from; k <= to; ++k) {
    const float dx = contour.x[k] - x;
    const float dy = contour.y[k] - y;
    const float d = dx * dx + dy * dy;
    best = d < d2 ? k : best;
    d2 = std::min(d, d2);
  }
  return best;
}

System linearised(const Contour& before, const Contour& now, const Pose& motion, float gate_m,
                  const AlignmentConfig& config) {
  const auto c = static_cast<float>(std::cos(motion.theta_rad));
  const auto s = static_cast<float>(std::sin(motion.theta_rad));
  const auto tx = static_cast<float>(motion.x_m);
  const auto ty = static_cast<float>(motion.y_m);
  const auto step = static_cast<float>(std::abs(before.geometry.angle_increment_rad));
  const float scale = 1.0F / std::max(now.mean_range_m, 0.1F);
  const float scale_m = std::max(config.outlier_m, gate_m / 3.0F);
  const float inverse_outlier2 = 1.0F / (scale_m * scale_m);
  float h00 = 0, h01 = 0, h02 = 0, h11 = 0, h12 = 0, h22 = 0, b0 = 0, b1 = 0, b2 = 0;
  System system;
  const std::size_t most = gate_m > config.gate_end_m ? config.points / 2 : config.points;
  const std::size_t stride = std::max<std::size_t>(1, (now.valid + most - 1) / most);
  for (std::size_t i = 0; i < now.valid; i += stride) {
    const float rx = c * now.px[i] - s * now.py[i];
    const float ry = s * now.px[i] + c * now.py[i];
    const float x = rx + tx;
    const float y = ry + ty;
    const int beam = beam_towards(before, x, y);
    if (beam < 0) continue;
    const float r = std::sqrt(x * x + y * y);
    const int half_width = static_cast<int>(std::clamp(gate_m / (r * step), 1.0F, kSearchMax));
    float d2 = 0.0F;
    const std::size_t k = nearest(before, beam, half_width, x, y, d2);
    if (d2 > gate_m * gate_m) continue;
    const float nx = before.normal_x[k];
    const float ny = before.normal_y[k];
    if (nx == 0.0F && ny == 0.0F) continue;
    ++system.matches;
    const float error = nx * (x - before.x[k]) + ny * (y - before.y[k]);
    const float w = 1.0F / (1.0F + error * error * inverse_outlier2);
    const float jt = (ny * rx - nx * ry) * scale;
    h00 += w * nx * nx, h01 += w * nx * ny, h02 += w * nx * jt;
    h11 += w * ny * ny, h12 += w * ny * jt, h22 += w * jt * jt;
    b0 -= w * nx * error, b1 -= w * ny * error, b2 -= w * jt * error;
  }
  system.H << h00, h01, h02, h01, h11, h12, h02, h12, h22;
  system.b << b0, b1, b2;
  return system;
}

/// The step along the directions that the matches fix.
Eigen::Vector3d step(const System& system, double weak) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(system.H);
  Eigen::Vector3d delta = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double strength = eigen.eigenvalues()[i];
    if (strength <= weak * system.matches || strength <= 0.0) continue;
    const Eigen::Vector3d axis = eigen.eigenvectors().col(i);
    delta += axis * (axis.dot(system.b) / strength);
  }
  return delta;
}

}  // namespace

Alignment aligned(const Contour& before, const Contour& now, const Pose& seed,
                  const AlignmentConfig& config) {
  Alignment result{seed, 0, 0};
  Pose& motion = result.motion;
  const double scale = 1.0 / std::max(now.mean_range_m, 0.1F);
  float gate_m = config.gate_m;
  for (int i = 0; i < config.iterations; ++i) {
    const System system = linearised(before, now, motion, gate_m, config);
    result.matches = system.matches;
    result.iterations = i + 1;
    if (system.matches < 10) break;
    const Eigen::Vector3d delta = step(system, config.weak);
    const Pose last = motion;
    motion.x_m =
        seed.x_m + std::clamp(motion.x_m + delta[0] - seed.x_m, -config.reach_m, config.reach_m);
    motion.y_m =
        seed.y_m + std::clamp(motion.y_m + delta[1] - seed.y_m, -config.reach_m, config.reach_m);
    motion.theta_rad = wrapped(
        seed.theta_rad + std::clamp(wrapped(motion.theta_rad + delta[2] * scale - seed.theta_rad),
                                    -config.reach_rad, config.reach_rad));
    const bool still = std::hypot(motion.x_m - last.x_m, motion.y_m - last.y_m) < config.stop_m &&
                       std::abs(wrapped(motion.theta_rad - last.theta_rad)) < config.stop_rad;
    if (still && gate_m <= config.gate_end_m) break;
    gate_m = std::max(config.gate_end_m, gate_m * (still ? 0.5F : config.gate_shrink));
  }
  return result;
}

double profile_turn_rad(const Contour& before, const Contour& now, double seed_rad,
                        double reach_rad) {
  const double step_rad = before.geometry.angle_increment_rad;
  const auto n = static_cast<std::ptrdiff_t>(std::min(before.beams, now.beams));
  const std::ptrdiff_t stride = std::max<std::ptrdiff_t>(1, n / 180);
  const auto limit = static_cast<double>(n);  // however fine the beams are
  const auto centre =
      static_cast<std::ptrdiff_t>(std::lround(std::clamp(seed_rad / step_rad, -limit, limit)));
  const auto reach = static_cast<std::ptrdiff_t>(std::min(std::abs(reach_rad / step_rad), limit));
  float best = 1e9F;
  std::ptrdiff_t best_shift = centre;
  for (std::ptrdiff_t shift = centre - reach; shift <= centre + reach; shift += stride) {
    float cost = 0.0F;
    float count = 0.0F;
    for (std::ptrdiff_t i = 0; i < n; i += stride) {
      std::ptrdiff_t k = i + shift;
      if (before.whole_turn) k = ((k % n) + n) % n;
      if (k < 0 || k >= n) continue;
      const auto a = static_cast<std::size_t>(i) + Contour::kMargin;
      const auto b = static_cast<std::size_t>(k) + Contour::kMargin;
      if (now.far_m[a] <= 0.0F || before.far_m[b] <= 0.0F) continue;
      cost += std::min(std::abs(now.near_m[a] - before.near_m[b]), 1.0F);
      count += 1.0F;
    }
    if (count < 15.0F) continue;
    cost /= count;
    if (cost < best) best = cost, best_shift = shift;
  }
  return static_cast<double>(best_shift) * step_rad;
}

}  // namespace kidnapwatch::core
