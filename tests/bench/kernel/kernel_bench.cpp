// SPDX-License-Identifier: Apache-2.0
// The warping kernel beside plain versions of it, on the same pairs of clouds.
//
// Names are cost/WAY/PAIRS/BEAMS; for recorded runs PAIRS is recorded:RUN, and BEAMS how many are
// valid in the median. Argument --logs=DIR: a folder of folders of recorded runs.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "adapters/logs/log.hpp"
#include "core/dtw.hpp"
#include "core/dtw_kernel.hpp"
#include "tests/bench/plain_dtw.hpp"
#include "tests/core/dtw_kernel_cases.hpp"

namespace kidnapwatch::bench {
namespace {

using core::Cloud;
using core::DtwWorkspace;
using core::Pair;
using core::Precision;

constexpr std::size_t kPairs = 4;  // enough that branches are not learned by heart
constexpr std::size_t kBeams[] = {90, 180, 360, 541, 720, 1081, 1440, 2160, 4320};
constexpr core::Kind kKinds[] = {core::Kind::normal, core::Kind::kidnap, core::Kind::random};

struct Pairs {
  std::string name;
  std::vector<Pair> pairs;
};

/// A way to compute the cost, on one instruction set.
struct Way {
  std::string name;
  std::int64_t instruction_set;
  std::function<double(const Pair&, DtwWorkspace&)> cost;
};

std::vector<Way> kernel_ways() {
  std::vector<Way> ways;
  for (const std::int64_t set : core::instruction_sets()) {
    std::string suffix = std::string("_") + hwy::TargetName(set);
    const auto add = [&](const char* name, Precision precision, bool banded) {
      ways.push_back({name + suffix, set, [=](const Pair& pair, DtwWorkspace& workspace) {
                        workspace.band_from = banded ? DtwWorkspace().band_from
                                                     : std::numeric_limits<std::size_t>::max();
                        return core::dtw_cost(pair.p, pair.q, precision, workspace);
                      }});
    };
    add("f32", Precision::f32, true);
    add("f64", Precision::f64, true);
    add("f32_whole", Precision::f32, false);
  }
  return ways;
}

std::vector<Way> all_ways() {
  std::vector<Way> ways = kernel_ways();
  const std::int64_t best = core::instruction_sets().back();
  ways.push_back({"two_rows", best, [](const Pair& pair, DtwWorkspace& /*unused*/) {
                    return two_rows(pair.p, pair.q);
                  }});
  ways.push_back({"one_row", best, [](const Pair& pair, DtwWorkspace& /*unused*/) {
                    return core::dtw_cost(pair.p, pair.q);
                  }});
  ways.push_back({"wavefront", best, [](const Pair& pair, DtwWorkspace& /*unused*/) {
                    return static_cast<double>(wavefront(pair.p, pair.q));
                  }});
  return ways;
}

void run(benchmark::State& state, const Way& way, const std::vector<Pair>& pairs) {
  const core::Lowered lowered(way.instruction_set);
  DtwWorkspace workspace;
  for (const Pair& pair : pairs) {
    const double exact = core::dtw_cost(pair.p, pair.q);
    if (std::abs(way.cost(pair, workspace) - exact) > 1e-4 * exact) {
      state.SkipWithError("not the cost");
      return;
    }
  }
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(way.cost(pairs[i++ % pairs.size()], workspace));
  }
}

/// Nanoseconds of a cycle: additions that wait for each other take one each.
void clock_cycle(benchmark::State& state) {
#ifdef __x86_64__
  constexpr std::uint64_t kAdditions = 1000;
  std::uint64_t sum = 1;
  for (auto _ : state) {
    for (std::uint64_t i = 0; i < kAdditions / 10; ++i) {
      asm volatile(".rept 10\n\taddq %0, %0\n\t.endr" : "+r"(sum));
    }
  }
  state.counters["cycles"] = static_cast<double>(kAdditions);
#else
  state.SkipWithError("written for x86-64 only");
#endif
}

Pairs made_up(core::Kind kind, std::size_t beams) {
  Pairs made{
      std::string(core::kKindNames[static_cast<std::size_t>(kind)]) + "/" + std::to_string(beams),
      {}};
  for (std::size_t seed = 1; seed <= kPairs; ++seed) {
    made.pairs.push_back(core::pair_of(kind, beams, beams, seed));
  }
  return made;
}

/// Pairs of consecutive scans from the middle of a run.
Pairs recorded(const std::filesystem::path& file) {
  const auto scans = adapters::logs::read_log(file).recording.scans;
  Pairs made{"recorded:" + file.parent_path().filename().string() + "/", {}};
  std::vector<std::size_t> sizes;
  for (std::size_t i = scans.size() / 2; i + 1 < scans.size() && made.pairs.size() < 16; ++i) {
    if (core::is_comparable(scans[i].scan) && core::is_comparable(scans[i + 1].scan)) {
      made.pairs.push_back({core::cloud(scans[i].scan, core::InvalidPolicy::drop),
                            core::cloud(scans[i + 1].scan, core::InvalidPolicy::drop)});
      sizes.push_back(made.pairs.back().p.size());
    }
  }
  std::ranges::sort(sizes);
  made.name += std::to_string(sizes.empty() ? 0 : sizes[sizes.size() / 2]);
  return made;
}

/// The first run of each folder in `folder`; none if it is not there.
std::vector<Pairs> recorded_below(const std::filesystem::path& folder) {
  std::vector<Pairs> all;
  if (!std::filesystem::is_directory(folder)) return all;
  const std::filesystem::directory_iterator below(folder);
  for (const auto& entry : std::set<std::filesystem::path>(begin(below), end(below))) {
    if (!std::filesystem::is_directory(entry)) continue;
    std::set<std::filesystem::path> runs;
    for (const auto& file : std::filesystem::directory_iterator(entry)) {
      if (file.path().string().ends_with(".scan.gz")) runs.insert(file.path());
    }
    if (runs.empty()) continue;
    if (Pairs pairs = recorded(*runs.begin()); !pairs.pairs.empty()) all.push_back(pairs);
  }
  return all;
}

void add(const Pairs& pairs, const std::vector<Way>& ways) {
  const auto shared = std::make_shared<const std::vector<Pair>>(pairs.pairs);
  for (const Way& way : ways) {
    benchmark::RegisterBenchmark(
        ("cost/" + way.name + "/" + pairs.name).c_str(),
        [way, shared](benchmark::State& state) { run(state, way, *shared); });
  }
}

}  // namespace
}  // namespace kidnapwatch::bench

int main(int argc, char** argv) {
  using namespace kidnapwatch;
  benchmark::Initialize(&argc, argv);
  benchmark::RegisterBenchmark("clock_cycle", bench::clock_cycle);
  const auto ways = bench::all_ways();
  for (const std::size_t beams : bench::kBeams) {
    for (const core::Kind kind : bench::kKinds) {
      bench::add(bench::made_up(kind, beams), ways);
    }
  }
  constexpr std::string_view kLogs = "--logs=";
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]).starts_with(kLogs)) {
      for (const auto& pairs : bench::recorded_below(argv[i] + kLogs.size())) {
        bench::add(pairs, ways);
      }
    }
  }
  benchmark::RunSpecifiedBenchmarks();
}
