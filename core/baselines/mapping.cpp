// SPDX-License-Identifier: Apache-2.0
// Occupancy by log-odds.
#include "core/baselines/mapping.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>

#include "core/cloud.hpp"

namespace kidnapwatch::core::baselines {
namespace {

constexpr float kHit = 0.85F;   // log-odds of 0.70
constexpr float kMiss = -0.4F;  // of 0.40
constexpr float kSurest = 4.0F;

/// Calls visit(lidar, end) with the lidar's pose and the end point, in the map frame, of every
/// valid beam within reach.
template <typename Visit>
void for_each_beam(const Scan& scan, const Pose& T_map_lidar, double reach_m, Bearings& bearings,
                   Visit visit) {
  bearings.fit(scan.geometry, scan.ranges_m.size());
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const auto range_m = static_cast<double>(scan.ranges_m[i]);
    if (!is_valid(scan.ranges_m[i], scan.geometry) || range_m > reach_m) continue;
    const Pose end{range_m * bearings.cosine(i), range_m * bearings.sine(i), 0.0};
    visit(T_map_lidar, T_map_lidar * end);
  }
}

class Mapper {
 public:
  explicit Mapper(const GridLayout& layout)
      : layout_(layout), log_odds_(layout.cells(), 0.0F), seen_(layout.cells(), 0) {}

  void add(const Scan& scan, const Pose& T_map_lidar, double reach_m) {
    ++scans_;
    for_each_beam(scan, T_map_lidar, reach_m, bearings_, [&](const Pose&, const Pose& end) {
      see(layout_.column_at(end.x_m), layout_.row_at(end.y_m), kHit);
    });
    for_each_beam(scan, T_map_lidar, reach_m, bearings_, [&](const Pose& lidar, const Pose& end) {
      for_each_cell_between(layout_, lidar, end,
                            [&](long column, long row) { see(column, row, kMiss); });
    });
  }

  [[nodiscard]] GridMap map() const {
    GridMap map{layout_, std::vector<Cell>(layout_.cells(), Cell::unknown)};
    for (std::size_t i = 0; i < map.cells.size(); ++i) {
      if (log_odds_[i] > 0.5F * kHit) map.cells[i] = Cell::occupied;
      if (log_odds_[i] < 0.5F * kMiss) map.cells[i] = Cell::free;
    }
    return map;
  }

 private:
  /// Once per scan and cell: what comes first counts.
  void see(long column, long row, float log_odds) {
    assert(layout_.contains(column, row));
    const std::size_t cell = layout_.index(column, row);
    if (seen_[cell] == scans_) return;
    seen_[cell] = scans_;
    log_odds_[cell] = std::clamp(log_odds_[cell] + log_odds, -kSurest, kSurest);
  }

  GridLayout layout_;
  std::vector<float> log_odds_;
  std::vector<std::uint32_t> seen_;  // the last scan that saw the cell, from 1
  std::uint32_t scans_ = 0;
  Bearings bearings_;
};

}  // namespace

GridMap map_from(std::span<const RecordedScan> scans, std::span<const Pose> poses,
                 const MappingConfig& config) {
  assert(!scans.empty() && scans.size() == poses.size());
  Bearings bearings;
  Pose low = poses.front();
  Pose high = low;
  const auto include = [&](const Pose& at) {
    low = {std::min(low.x_m, at.x_m), std::min(low.y_m, at.y_m), 0.0};
    high = {std::max(high.x_m, at.x_m), std::max(high.y_m, at.y_m), 0.0};
  };
  for (std::size_t i = 0; i < scans.size(); ++i) {
    include(poses[i] * config.T_base_lidar);
    for_each_beam(scans[i].scan, poses[i] * config.T_base_lidar, config.reach_m, bearings,
                  [&](const Pose&, const Pose& end) { include(end); });
  }
  Mapper mapper(layout_around(low, high, config.cell_m, config.cell_m));
  for (std::size_t i = 0; i < scans.size(); ++i) {
    mapper.add(scans[i].scan, poses[i] * config.T_base_lidar, config.reach_m);
  }
  return mapper.map();
}

}  // namespace kidnapwatch::core::baselines
