// SPDX-License-Identifier: Apache-2.0
// Likelihoods of scans.
#include "core/baselines/measurement.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace kidnapwatch::core::baselines {
namespace {

constexpr double kNoHit = 6.0;  // standard deviations beyond which a beam has missed the wall

/// 1 at the wall.
double hit(double off_m, double sd_m) { return std::exp(-0.5 * off_m * off_m / (sd_m * sd_m)); }

double field_value(double off_m, const MeasurementConfig& config) {
  return std::log((1.0 - config.random_share) * hit(off_m, config.hit_sd_m) + config.random_share);
}

/// The log of the likelihood of an end point in each cell, and in one more cell around the grid, so
/// that a look-up needs no branch: end points beyond are far from every wall.
std::vector<float> log_field(const DistanceField& distances, const MeasurementConfig& config) {
  const GridLayout& layout = distances.layout;
  const auto nowhere = static_cast<float>(std::log(config.random_share));
  std::vector<float> field(static_cast<std::size_t>((layout.columns + 2) * (layout.rows + 2)),
                           nowhere);
  for (long row = 0; row < layout.rows; ++row) {
    for (long column = 0; column < layout.columns; ++column) {
      const auto off_m = static_cast<double>(distances.metres[layout.index(column, row)]);
      field[static_cast<std::size_t>((row + 1) * (layout.columns + 2) + column + 1)] =
          static_cast<float>(field_value(off_m, config));
    }
  }
  return field;
}

}  // namespace

void choose_beams(const Scan& scan, const MeasurementConfig& config, BeamSubset& subset) {
  subset.x_m.clear();
  subset.y_m.clear();
  subset.range_m.clear();
  subset.bearing_rad.clear();
  subset.range_max_m = scan.geometry.range_max_m;
  const std::size_t valid = valid_beams(scan);
  const std::size_t wanted = std::min(config.beams, valid);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < scan.ranges_m.size() && subset.size() < wanted; ++i) {
    if (!is_valid(scan.ranges_m[i], scan.geometry)) continue;
    if (seen++ * wanted / valid < subset.size()) continue;  // the next is due later
    const auto range_m = static_cast<double>(scan.ranges_m[i]);
    const Pose& lidar = config.T_base_lidar;
    const double bearing_rad = lidar.theta_rad + scan.geometry.angle_min_rad +
                               static_cast<double>(i) * scan.geometry.angle_increment_rad;
    subset.x_m.push_back(static_cast<float>(lidar.x_m + range_m * std::cos(bearing_rad)));
    subset.y_m.push_back(static_cast<float>(lidar.y_m + range_m * std::sin(bearing_rad)));
    subset.range_m.push_back(scan.ranges_m[i]);
    subset.bearing_rad.push_back(static_cast<float>(bearing_rad));
  }
}

MeasuredMap::MeasuredMap(const GridMap& map, const MeasurementConfig& config)
    : config_(config), distances_(distance_field(map)), log_field_(log_field(distances_, config)) {
  assert(config.random_share > 0.0 && config.random_share < 1.0 && config.hit_sd_m > 0.0);
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    if (map.cells[i] == Cell::free) free_cells_.push_back(i);
  }
}

double MeasuredMap::log_likelihood(const Pose& T_map_base, const BeamSubset& beams) const {
  assert(beams.size() > 0);
  return config_.model == MeasurementModel::beam ? of_ranges(T_map_base, beams)
                                                 : of_end_points(T_map_base, beams);
}

double MeasuredMap::of_end_points(const Pose& T_map_base, const BeamSubset& beams) const {
  const GridLayout& layout = distances_.layout;
  const auto per_m = static_cast<float>(1.0 / layout.cell_m);
  // One more for the cell around the grid; negative numbers are rounded towards it.
  const auto x = static_cast<float>((T_map_base.x_m - layout.origin_x_m) / layout.cell_m + 1.0);
  const auto y = static_cast<float>((T_map_base.y_m - layout.origin_y_m) / layout.cell_m + 1.0);
  const auto c = per_m * static_cast<float>(std::cos(T_map_base.theta_rad));
  const auto s = per_m * static_cast<float>(std::sin(T_map_base.theta_rad));
  const auto last_column = static_cast<float>(layout.columns + 1);
  const auto last_row = static_cast<float>(layout.rows + 1);
  const long stride = layout.columns + 2;
  float sum = 0.0F;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const float column = std::clamp(x + c * beams.x_m[i] - s * beams.y_m[i], 0.0F, last_column);
    const float row = std::clamp(y + s * beams.x_m[i] + c * beams.y_m[i], 0.0F, last_row);
    const long cell = static_cast<long>(row) * stride + static_cast<long>(column);
    sum += log_field_[static_cast<std::size_t>(cell)];
  }
  return static_cast<double>(sum) / static_cast<double>(beams.size());
}

double MeasuredMap::of_ranges(const Pose& T_map_base, const BeamSubset& beams) const {
  const Pose lidar = T_map_base * config_.T_base_lidar;
  const double rest = 1.0 - config_.random_share - config_.short_share;
  double sum = 0.0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const auto bearing_rad = static_cast<double>(beams.bearing_rad[i]);
    const Pose ray{lidar.x_m, lidar.y_m, T_map_base.theta_rad + bearing_rad};
    const auto measured_m = static_cast<double>(beams.range_m[i]);
    const double reach_m = measured_m + kNoHit * config_.hit_sd_m;
    const double expected_m = cast_ray(distances_, ray, std::min(reach_m, beams.range_max_m));
    const double early =
        measured_m < expected_m ? std::exp(-config_.short_rate_per_m * measured_m) : 0.0;
    sum += std::log(rest * hit(measured_m - expected_m, config_.hit_sd_m) +
                    config_.short_share * early + config_.random_share);
  }
  return sum / static_cast<double>(beams.size());
}

}  // namespace kidnapwatch::core::baselines
