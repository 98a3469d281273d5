// SPDX-License-Identifier: Apache-2.0
// `evaluate localization`: how well Monte Carlo localization follows a recorded run.
#include "service/evaluate/localization.hpp"

#include <chrono>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <numbers>

#include <CLI/CLI.hpp>

#include "adapters/codecs/json.hpp"
#include "adapters/logs/grid_map.hpp"
#include "adapters/logs/log.hpp"
#include "core/baselines/localization.hpp"
#include "core/baselines/mapping.hpp"

namespace kidnapwatch::service {
namespace {

namespace baselines = core::baselines;
namespace logs = adapters::logs;

constexpr double kDegree = std::numbers::pi / 180.0;

struct LocalizationOptions {
  std::string log;
  std::string map;
  std::string map_from;
  std::string lidar = "0:0:0";
  std::string start;
  bool anywhere = false;
  baselines::MeasurementConfig measurement;
  baselines::MclConfig mcl;
  std::uint64_t seed = 1;
};

/// "X:Y:DEGREES".
core::Pose pose_of(const std::string& text, const char* option) {
  core::Pose pose;
  char rest = 0;
  const int read =
      std::sscanf(text.c_str(), "%lf:%lf:%lf%c", &pose.x_m, &pose.y_m, &pose.theta_rad, &rest);
  if (read != 3) throw core::BadInput(option, "must be X:Y:DEGREES, not '" + text + "'");
  pose.theta_rad = core::wrapped(pose.theta_rad * kDegree);
  return pose;
}

/// At the run's true poses, or at odometry that scan matching straightened.
baselines::GridMap map_from(const std::string& file, const core::Pose& T_base_lidar) {
  const auto run = logs::read_log(file).recording;
  baselines::RefinementConfig config;
  config.mapping.T_base_lidar = T_base_lidar;
  return baselines::map_from(run.scans, baselines::poses_of(run.scans, config), config.mapping);
}

std::optional<core::Pose> start_of(const LocalizationOptions& options, const core::Recording& run) {
  if (!options.start.empty()) return pose_of(options.start, "--start");
  if (options.anywhere) return std::nullopt;
  return run.scans.front().true_pose;
}

std::string to_json(const core::Recording& run, const baselines::Localization& localization,
                    double seconds) {
  using adapters::codecs::set;
  adapters::codecs::Json json{{"run", run.name}, {"scans", run.scans.size()}};
  if (const auto errors = baselines::errors(localization, run.scans)) {
    set(json, "position_error_median_m", errors->median_m);
    set(json, "position_error_q95_m", errors->q95_m);
    set(json, "position_error_max_m", errors->largest_m);
    set(json, "position_error_last_m", errors->last_m);
    set(json, "heading_error_median_deg", errors->median_rad / kDegree);
  }
  set(json, "max_current_weight_median", baselines::median_max_current_weight(localization));
  if (localization.back()) {
    const core::Pose& last = localization.back()->T_map_base;
    json["last_pose"] = {last.x_m, last.y_m, last.theta_rad / kDegree};
  }
  set(json, "ms_per_update", 1e3 * seconds / static_cast<double>(run.scans.size()));
  return adapters::codecs::text(json);
}

int follow(LocalizationOptions options) {
  if (options.map.empty() == options.map_from.empty()) {
    throw core::BadInput("--map", "give either --map or --map-from");
  }
  options.measurement.T_base_lidar = pose_of(options.lidar, "--lidar");
  const auto run = logs::read_log(options.log).recording;
  const baselines::GridMap grid = options.map.empty()
                                      ? map_from(options.map_from, options.measurement.T_base_lidar)
                                      : logs::read_grid_map(options.map);
  const baselines::MeasuredMap map(grid, options.measurement);
  if (map.free_cells().empty()) throw core::BadInput("--map", "has no free space");
  const auto start = start_of(options, run);
  const auto begin = std::chrono::steady_clock::now();
  const auto localization =
      baselines::localized(run.scans, {map, options.mcl, options.seed}, start);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  std::cout << to_json(run, localization, took.count()) << '\n';
  return kOk;
}

void add_options(CLI::App& command, LocalizationOptions& options) {
  using baselines::MeasurementModel;
  using baselines::Relocalization;
  static const std::map<std::string, MeasurementModel> kModels{
      {"field", MeasurementModel::likelihood_field}, {"beam", MeasurementModel::beam}};
  static const std::map<std::string, Relocalization> kRelocalizations{
      {"none", Relocalization::none},
      {"global", Relocalization::global},
      {"perfect", Relocalization::perfect}};
  command.add_option("LOG", options.log, "The run")->required();
  command.add_option("--map", options.map, "map_server's YAML, or a CMU map");
  command.add_option("--map-from", options.map_from, "Make the map from the scans of this run");
  command.add_option("--lidar", options.lidar, "Where the lidar sits on the base, X:Y:DEGREES");
  command.add_option("--start", options.start,
                     "X:Y:DEGREES in the map; without it the first true pose");
  command.add_flag("--anywhere", options.anywhere, "Start anywhere, as without true poses");
  command.add_option("--model", options.measurement.model, "field or beam")
      ->transform(CLI::CheckedTransformer(kModels));
  command.add_option("--relocalization", options.mcl.relocalization, "none, global or perfect")
      ->transform(CLI::CheckedTransformer(kRelocalizations));
  command.add_option("--particles", options.mcl.particles)->check(CLI::Range(1, 1'000'000));
  command.add_option("--beams", options.measurement.beams, "Of each scan")
      ->check(CLI::Range(1, 65'536));
  command.add_option("--seed", options.seed, "The same seed gives the same result");
}

}  // namespace

void add_evaluate_localization(CLI::App& evaluate, Command& chosen) {
  auto* command =
      evaluate.add_subcommand("localization", "Follow a recorded run by Monte Carlo localization");
  command->footer(
      "Example: kidnapwatch evaluate localization run.log.gz --map floor.yaml --lidar 0.25:0:0");
  const auto options = std::make_shared<LocalizationOptions>();
  add_options(*command, *options);
  command->callback([=, &chosen] { chosen = [=] { return follow(*options); }; });
}

}  // namespace kidnapwatch::service
