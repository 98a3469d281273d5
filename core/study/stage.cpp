// SPDX-License-Identifier: Apache-2.0
// A stage is set once, and trials run on it.
#include "core/study/stage.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/baselines/grid_map.hpp"
#include "core/study/systems.hpp"

namespace kidnapwatch::core::study {
namespace {

using baselines::Relocalization;

constexpr double kCell = 0.05;       // m, of MCL's map
constexpr double kLeastHitSd = 0.1;  // m: cells, and a pose between particles

baselines::MeasuredMap measured(const sim::World& world, double noise_sd_m) {
  std::vector<baselines::Segment> walls;
  for (const auto& [from, to] : world.walls) walls.push_back({from.x_m, from.y_m, to.x_m, to.y_m});
  const sim::Point inside = world.path.front();
  return {reachable(baselines::rasterised(walls, kCell), {inside.x_m, inside.y_m, 0.0}),
          {.hit_sd_m = std::hypot(noise_sd_m, kLeastHitSd)}};
}

void append(std::vector<TrialRecord>&& more, std::vector<TrialRecord>& records) {
  std::ranges::move(more, std::back_inserter(records));
}

}  // namespace

Stage::Stage(const sim::World& world, const Setting& setting) : world_(world), setting_(setting) {
  if (setting.systems.mcl) map_ = measured(world, std::sqrt(setting.noise_variance_m2));
}

std::vector<TrialRecord> Stage::trial(std::uint64_t seed) const {
  TrialConfig config;
  config.steps = setting_.steps;
  config.robot.range_max_m = setting_.range_max_m;
  config.robot.range_noise_sd_m = std::sqrt(setting_.noise_variance_m2);
  const Trial trial = drive(world_, config, seed);
  std::vector<TrialRecord> records;
  if (setting_.systems.dtw) append(pairwise_records(trial, dtw_systems), records);
  if (setting_.systems.ndt) append(pairwise_records(trial, ndt_systems), records);
  if (!map_) return records;
  for (const auto how : {Relocalization::none, Relocalization::global, Relocalization::perfect}) {
    const baselines::MclConfig mcl{.particles = setting_.particles, .relocalization = how};
    append(mcl_records(trial, *map_, mcl, seed), records);
  }
  return records;
}

}  // namespace kidnapwatch::core::study
