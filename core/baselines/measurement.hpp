// SPDX-License-Identifier: Apache-2.0
// How likely a scan is from a pose in a map: the likelihood field and the beam model.
#pragma once

#include <cstddef>
#include <vector>

#include "core/baselines/distance_field.hpp"
#include "core/baselines/grid_map.hpp"
#include "core/scan.hpp"

namespace kidnapwatch::core::baselines {

enum class MeasurementModel {
  likelihood_field,  ///< how near end points are to walls (Thrun, Burgard, Fox 2005, Table 6.3)
  beam,  ///< measured range against the range to the wall (Table 6.1); some 20 times slower
};

struct MeasurementConfig {
  MeasurementModel model = MeasurementModel::likelihood_field;
  std::size_t beams = 60;     ///< of a scan's valid beams, evenly spread over them
  double hit_sd_m = 0.15;     ///< of a hit about its wall: noise, cells and an imperfect map
  double random_share = 0.1;  ///< of beams that hit something the map does not have
  double short_share = 0.1;   ///< beam model: of beams that end early, at people and other things
  double short_rate_per_m = 0.3;
  Pose T_base_lidar;
};

/// The beams of a scan that are looked at.
struct BeamSubset {
  std::vector<float> x_m;  ///< end points in the base's frame
  std::vector<float> y_m;
  std::vector<float> range_m;
  std::vector<float> bearing_rad;  ///< from the lidar, in the base's frame
  double range_max_m = 0.0;

  [[nodiscard]] std::size_t size() const { return x_m.size(); }
};

/// Of `scan`, as `config` says; `subset` is replaced, its memory reused.
void choose_beams(const Scan& scan, const MeasurementConfig& config, BeamSubset& subset);

/// A map, prepared for measurements. Unchanging: any number of filters may share it.
class MeasuredMap {
 public:
  MeasuredMap(const GridMap& map, const MeasurementConfig& config);

  /// Mean over the beams of ln p(beam | pose), p from random_share to 1: 0 if every beam ends
  /// exactly where it should. At least one beam.
  [[nodiscard]] double log_likelihood(const Pose& T_map_base, const BeamSubset& beams) const;

  [[nodiscard]] const MeasurementConfig& config() const { return config_; }
  [[nodiscard]] const DistanceField& distances() const { return distances_; }
  /// Indices of the free cells.
  [[nodiscard]] const std::vector<std::size_t>& free_cells() const { return free_cells_; }

 private:
  [[nodiscard]] double of_end_points(const Pose& T_map_base, const BeamSubset& beams) const;
  [[nodiscard]] double of_ranges(const Pose& T_map_base, const BeamSubset& beams) const;

  MeasurementConfig config_;
  DistanceField distances_;
  std::vector<std::size_t> free_cells_;
  std::vector<float> log_field_;  // per cell, with one cell around the grid
};

}  // namespace kidnapwatch::core::baselines
