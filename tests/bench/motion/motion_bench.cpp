// SPDX-License-Identifier: Apache-2.0
// What motion consistency costs per scan, and all default scores together.
#include <vector>

#include <benchmark/benchmark.h>

#include "core/session.hpp"
#include "core/sim/drive.hpp"

namespace kidnapwatch {
namespace {

constexpr std::size_t kScans = 1024;
constexpr double kStep_s = 0.2;

std::vector<core::Scan> scans(std::size_t beams, bool with_odometry) {
  static const core::sim::World world = core::sim::corridor_world();
  core::sim::Drive drive(world, {.beams = beams, .range_max_m = 12.0}, 7, core::Stamp{});
  std::vector<core::Scan> all;
  for (std::size_t i = 0; i < kScans; ++i) {
    all.push_back(drive.next(kStep_s).scan);
    if (!with_odometry) all.back().odometry.reset();
  }
  return all;
}

/// The tour again and again; stamps go on, and so does odometry as far as it matters.
void BM_MotionDetector(benchmark::State& state) {
  const auto all = scans(static_cast<std::size_t>(state.range(0)), state.range(1) != 0);
  core::MotionDetector detector{core::MotionConfig{}};
  for (const core::Scan& scan : all) benchmark::DoNotOptimize(detector.observe(scan));
  std::size_t at = 0;
  for (auto _ : state) {
    if (at == all.size()) {
      detector.forget_scans();
      at = 0;
    }
    benchmark::DoNotOptimize(detector.observe(all[at++]));
  }
}
BENCHMARK(BM_MotionDetector)->ArgsProduct({{180, 360, 720}, {1, 0}})->Unit(benchmark::kMicrosecond);

void BM_AllDefaultScores(benchmark::State& state) {
  const auto all = scans(static_cast<std::size_t>(state.range(0)), true);
  core::Session session{core::DetectionConfig{}};
  core::DissimilarityWorkspace workspace;
  core::Scan scan;
  core::Stamp stamp;
  std::size_t at = 0;
  for (auto _ : state) {
    scan = all[at++ % all.size()];
    scan.stamp = stamp = core::later_by_s(stamp, kStep_s);
    benchmark::DoNotOptimize(session.observe(scan, stamp, workspace));
  }
}
BENCHMARK(BM_AllDefaultScores)->Arg(360)->Arg(720)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace kidnapwatch

BENCHMARK_MAIN();
