// SPDX-License-Identifier: Apache-2.0
// Odometry straightened by matching each scan with those before it.
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/baselines/mapping.hpp"
#include "core/baselines/odometry_motion.hpp"
#include "core/cloud.hpp"

namespace kidnapwatch::core::baselines {
namespace {

constexpr double kCell = 0.05;        // m
constexpr double kBlur = 0.08;        // m, standard deviation
constexpr long kBlurCells = 4;        // of the blur to each side
constexpr std::size_t kPoints = 120;  // of a scan that are matched
constexpr double kCoarse = 0.06;      // m between candidates
constexpr double kCoarseTurn = 0.02;  // rad
constexpr double kFinest = 0.002;     // m, where the search ends
// What a correction as far as the window costs: corridors leave one direction to odometry.
constexpr double kDistrust = 0.1;

/// The blurred end points of scans: 1 at a point, falling to 0 within kBlurCells. Kept in tiles,
/// which are there only where there are points.
class Blur {
 public:
  /// Covers a square around the origin, `across_m` to each side; what is beyond is ignored.
  explicit Blur(double across_m)
      : tiles_across_(2 * static_cast<long>(std::ceil(across_m / (kTile * kCell)))),
        tiles_(static_cast<std::size_t>(tiles_across_ * tiles_across_)) {}

  void add(double x_m, double y_m) {
    const long column = cell_of(x_m);
    const long row = cell_of(y_m);
    for (long up = -kBlurCells; up <= kBlurCells; ++up) {
      for (long right = -kBlurCells; right <= kBlurCells; ++right) {
        const double off_x_m = (static_cast<double>(column + right) + 0.5) * kCell - x_m;
        const double off_y_m = (static_cast<double>(row + up) + 0.5) * kCell - y_m;
        const double square = (off_x_m * off_x_m + off_y_m * off_y_m) / (kBlur * kBlur);
        raise(column + right, row + up, static_cast<float>(std::exp(-0.5 * square)));
      }
    }
  }

  [[nodiscard]] double nearest(double x_m, double y_m) const {
    return cell(cell_of(x_m), cell_of(y_m));
  }

  /// Between the centres of the four cells around the point.
  [[nodiscard]] double between(double x_m, double y_m) const {
    const double x = x_m / kCell - 0.5;
    const double y = y_m / kCell - 0.5;
    const auto column = static_cast<long>(std::floor(x));
    const auto row = static_cast<long>(std::floor(y));
    const double right = x - static_cast<double>(column);
    const double up = y - static_cast<double>(row);
    return (1.0 - up) * ((1.0 - right) * cell(column, row) + right * cell(column + 1, row)) +
           up * ((1.0 - right) * cell(column, row + 1) + right * cell(column + 1, row + 1));
  }

 private:
  static constexpr long kTile = 64;  // cells to a side
  using Tile = std::vector<float>;

  static long cell_of(double at_m) { return static_cast<long>(std::floor(at_m / kCell)); }

  static std::size_t in_tile(long column, long row) {
    return static_cast<std::size_t>((row & (kTile - 1)) * kTile + (column & (kTile - 1)));
  }

  /// Index of the cell's tile; none beyond the square.
  [[nodiscard]] std::optional<std::size_t> tile_of(long column, long row) const {
    const long across = (column >> 6) + tiles_across_ / 2;
    const long up = (row >> 6) + tiles_across_ / 2;
    if (across < 0 || across >= tiles_across_ || up < 0 || up >= tiles_across_) return {};
    return static_cast<std::size_t>(up * tiles_across_ + across);
  }

  [[nodiscard]] double cell(long column, long row) const {
    const auto tile = tile_of(column, row);
    if (!tile || tiles_[*tile].empty()) return 0.0;
    return static_cast<double>(tiles_[*tile][in_tile(column, row)]);
  }

  void raise(long column, long row, float to) {
    const auto tile = tile_of(column, row);
    if (!tile) return;
    tiles_[*tile].resize(static_cast<std::size_t>(kTile * kTile));
    float& value = tiles_[*tile][in_tile(column, row)];
    value = std::max(value, to);
  }

  long tiles_across_;
  std::vector<Tile> tiles_;
};

/// Every n-th point, so that about kPoints are left.
Cloud thinned(const Cloud& points) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / kPoints);
  Cloud kept;
  for (std::size_t i = 0; i < points.size(); i += step) {
    kept.x.push_back(points.x[i]);
    kept.y.push_back(points.y[i]);
  }
  return kept;
}

Cloud seen_from(const Pose& pose, const Cloud& points) {
  const double c = std::cos(pose.theta_rad);
  const double s = std::sin(pose.theta_rad);
  Cloud moved = points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    moved.x[i] = pose.x_m + c * points.x[i] - s * points.y[i];
    moved.y[i] = pose.y_m + s * points.x[i] + c * points.y[i];
  }
  return moved;
}

class Matcher {
 public:
  Matcher(const RefinementConfig& config, double across_m) : config_(config), blur_(across_m) {}

  void add(const Pose& T_map_base, const Cloud& points) {
    const Cloud ends = seen_from(T_map_base * config_.mapping.T_base_lidar, points);
    for (std::size_t i = 0; i < ends.size(); ++i) blur_.add(ends.x[i], ends.y[i]);
  }

  /// The pose near `seed` from which the points fit best.
  [[nodiscard]] Pose match(const Pose& seed, const Cloud& points) const {
    const Cloud few = thinned(points);
    if (few.size() == 0) return seed;
    return corrected(seed, fine(seed, coarse(seed, few), few));
  }

 private:
  static Pose corrected(const Pose& seed, const Pose& by) {
    return {seed.x_m + by.x_m, seed.y_m + by.y_m, wrapped(seed.theta_rad + by.theta_rad)};
  }

  /// The best correction of the whole window, on a lattice.
  [[nodiscard]] Pose coarse(const Pose& seed, const Cloud& points) const {
    const long across = std::lround(config_.window_m / kCoarse);
    const long turns = std::lround(config_.window_rad / kCoarseTurn);
    Pose best;
    double best_worth = -1.0;
    for (long turn = -turns; turn <= turns; ++turn) {
      Pose by{0.0, 0.0, static_cast<double>(turn) * kCoarseTurn};
      const Cloud ends = seen_from(corrected(seed, by) * config_.mapping.T_base_lidar, points);
      const long side = 2 * across + 1;
      for (long i = 0; i < side * side; ++i) {
        const long column = i / side - across;
        const long row = i % side - across;
        by.x_m = static_cast<double>(column) * kCoarse;
        by.y_m = static_cast<double>(row) * kCoarse;
        double sum = 0.0;
        for (std::size_t k = 0; k < ends.size(); ++k) {
          sum += blur_.nearest(ends.x[k] + by.x_m, ends.y[k] + by.y_m);
        }
        const double found = sum / static_cast<double>(ends.size()) - distrust(by);
        if (found <= best_worth) continue;
        best = by;
        best_worth = found;
      }
    }
    return best;
  }

  /// Uphill from there, in steps that halve where none goes up.
  [[nodiscard]] Pose fine(const Pose& seed, Pose best, const Cloud& points) const {
    double best_worth = worth(seed, best, points);
    for (double share = 0.5; share * kCoarse >= kFinest;) {
      const double move_m = share * kCoarse;
      const double turn_rad = share * kCoarseTurn;
      const Pose around = best;
      for (const Pose& step :
           {Pose{move_m, 0.0, 0.0}, Pose{-move_m, 0.0, 0.0}, Pose{0.0, move_m, 0.0},
            Pose{0.0, -move_m, 0.0}, Pose{0.0, 0.0, turn_rad}, Pose{0.0, 0.0, -turn_rad}}) {
        const Pose by = corrected(around, step);
        const double found = worth(seed, by, points);
        if (found <= best_worth) continue;
        best = by;
        best_worth = found;
      }
      if (best == around) share *= 0.5;
    }
    return best;
  }

  [[nodiscard]] double worth(const Pose& seed, const Pose& by, const Cloud& points) const {
    const Cloud ends = seen_from(corrected(seed, by) * config_.mapping.T_base_lidar, points);
    double sum = 0.0;
    for (std::size_t i = 0; i < ends.size(); ++i) sum += blur_.between(ends.x[i], ends.y[i]);
    return sum / static_cast<double>(ends.size()) - distrust(by);
  }

  [[nodiscard]] double distrust(const Pose& by) const {
    const double moved = std::hypot(by.x_m, by.y_m) / config_.window_m;
    const double turned = by.theta_rad / config_.window_rad;
    return kDistrust * (moved * moved + turned * turned);
  }

  RefinementConfig config_;
  Blur blur_;
};

/// How far from the first pose any end point can come to lie, with room for drift.
double farthest_m(std::span<const RecordedScan> scans, double reach_m) {
  double farthest = 0.0;
  for (const RecordedScan& recorded : scans) {
    if (!recorded.scan.odometry || !scans.front().scan.odometry) continue;
    farthest =
        std::max(farthest, distance_m(*scans.front().scan.odometry, *recorded.scan.odometry));
  }
  return 1.1 * farthest + reach_m;
}

}  // namespace

std::vector<Pose> refine_poses(std::span<const RecordedScan> scans,
                               const RefinementConfig& config) {
  Matcher matcher(config, farthest_m(scans, config.mapping.reach_m));
  std::vector<Pose> poses;
  Pose keyframe;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Scan& scan = scans[i].scan;
    const Cloud points = cloud(scan, InvalidPolicy::drop);
    Pose pose;
    if (i > 0) {
      pose = matcher.match(poses.back() * motion_between(scans[i - 1].scan, scan), points);
    }
    poses.push_back(pose);
    const Pose moved = inverse(keyframe) * pose;
    if (i > 0 && std::hypot(moved.x_m, moved.y_m) < config.keyframe_m &&
        std::abs(moved.theta_rad) < config.keyframe_rad) {
      continue;
    }
    matcher.add(pose, points);
    keyframe = pose;
  }
  return poses;
}

std::vector<Pose> poses_of(std::span<const RecordedScan> scans, const RefinementConfig& config) {
  std::vector<Pose> poses;
  for (const RecordedScan& recorded : scans) {
    if (!recorded.true_pose) return refine_poses(scans, config);
    poses.push_back(*recorded.true_pose);
  }
  return poses;
}

}  // namespace kidnapwatch::core::baselines
