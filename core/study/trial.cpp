// SPDX-License-Identifier: Apache-2.0
// A trial is driven once; its kidnappings are cut into it.
#include "core/study/trial.hpp"

#include <cassert>
#include <cmath>

#include "core/evaluation/splice.hpp"

namespace kidnapwatch::core::study {
namespace {

/// At the tour's beginning, facing along it.
Pose beginning(const sim::World& world) {
  const sim::Point at = world.path.back();
  const sim::Point towards = world.path.front();
  return {at.x_m, at.y_m, std::atan2(towards.y_m - at.y_m, towards.x_m - at.x_m)};
}

double seconds(const Recording& recording, std::size_t scan) {
  return elapsed_s(recording.scans.front().scan.stamp, recording.scans[scan].scan.stamp);
}

}  // namespace

Trial drive(const sim::World& world, const TrialConfig& config, std::uint64_t seed) {
  assert(!world.elsewhere.empty());
  sim::Drive robot(world, config.robot, seed, Stamp{}, beginning(world));
  Trial trial;
  for (std::size_t t = 0; t < config.steps; ++t) trial.run.push_back(robot.next(config.step_s));
  robot.kidnap(world.elsewhere.front());
  for (std::size_t t = 0; t < config.steps; ++t) trial.after.push_back(robot.next(config.step_s));
  return trial;
}

Recording kidnapped_at(const Trial& trial, std::size_t t_k) {
  assert(t_k >= 2 && t_k <= trial.run.size());
  Recording all{"trial", trial.run};
  all.scans.insert(all.scans.end(), trial.after.begin(), trial.after.end());
  const evaluation::Cut cut{seconds(all, t_k - 1), seconds(all, trial.run.size())};
  Recording spliced = evaluation::splice(all, {&cut, 1}).recording;
  spliced.scans.resize(trial.run.size());
  return spliced;
}

}  // namespace kidnapwatch::core::study
