// SPDX-License-Identifier: Apache-2.0
// A scan's whole way, from the payload's bytes to the verdict, and its steps; beside it the plain
// way: a DOM of JSON, libm for every beam, two rows of doubles.
#include <array>
#include <limits>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "adapters/codecs/json.hpp"
#include "adapters/codecs/scan_encode.hpp"
#include "adapters/codecs/scan_payload.hpp"
#include "core/session.hpp"
#include "core/sim/drive.hpp"
#include "tests/bench/plain_dtw.hpp"

namespace kidnapwatch {
namespace {

namespace codecs = adapters::codecs;

constexpr std::size_t kScans = 256;

std::vector<core::Scan> scans(std::size_t beams) {
  static const core::sim::World world = core::sim::corridor_world();
  core::sim::Drive drive(world, {.beams = beams, .range_max_m = 30.0}, 7, core::Stamp{});
  std::vector<core::Scan> all;
  for (std::size_t i = 0; i < kScans; ++i) {
    all.push_back(drive.next(0.2).scan);
  }
  return all;
}

std::vector<std::string> json_payloads(std::size_t beams) {
  std::vector<std::string> all;
  for (const auto& scan : scans(beams)) {
    codecs::append_json(all.emplace_back(), scan);
  }
  return all;
}

std::vector<std::string> cbor_payloads(std::size_t beams) {
  std::vector<std::string> all;
  for (const auto& scan : scans(beams)) {
    codecs::append_cbor(all.emplace_back(), scan);
  }
  return all;
}

/// Sends the payloads round and round, with stamps that go on: the session must not refuse them.
void run_path(benchmark::State& state, const std::vector<std::string>& payloads,
              std::string_view content_type) {
  codecs::ScanDecoder decoder;
  core::Scan scan;
  core::DissimilarityWorkspace workspace;
  core::DetectionConfig config;
  config.alarm = core::AlarmBy::qs2ddtw;  // the rest is in motion_bench
  core::Session session(config);
  core::Stamp stamp{};
  std::size_t i = 0;
  for (auto _ : state) {
    decoder.decode(payloads[i++ % payloads.size()], content_type, scan);
    scan.stamp = stamp += std::chrono::milliseconds(200);
    benchmark::DoNotOptimize(session.observe(scan, stamp, workspace));
  }
}

void BM_PathJson(benchmark::State& state) {
  run_path(state, json_payloads(static_cast<std::size_t>(state.range(0))),
           codecs::kJsonContentType);
}
BENCHMARK(BM_PathJson)->Arg(360)->Arg(1081);

void BM_PathCbor(benchmark::State& state) {
  run_path(state, cbor_payloads(static_cast<std::size_t>(state.range(0))),
           codecs::kCborContentType);
}
BENCHMARK(BM_PathCbor)->Arg(360)->Arg(1081);

void run_decode(benchmark::State& state, const std::vector<std::string>& payloads,
                std::string_view content_type) {
  codecs::ScanDecoder decoder;
  core::Scan scan;
  std::size_t i = 0;
  for (auto _ : state) {
    decoder.decode(payloads[i++ % payloads.size()], content_type, scan);
    benchmark::DoNotOptimize(scan.ranges_m.data());
  }
}

void BM_DecodeJson(benchmark::State& state) {
  run_decode(state, json_payloads(static_cast<std::size_t>(state.range(0))),
             codecs::kJsonContentType);
}
BENCHMARK(BM_DecodeJson)->Arg(360)->Arg(1081);

/// A bare NaN in the place of one range, which no JSON parser takes.
void BM_DecodeTolerantJson(benchmark::State& state) {
  auto payloads = json_payloads(static_cast<std::size_t>(state.range(0)));
  for (std::string& payload : payloads) {
    const std::size_t first = payload.find('[', payload.find("\"ranges\"")) + 1;
    payload.replace(first, payload.find(',', first) - first, "NaN");
  }
  run_decode(state, payloads, codecs::kJsonContentType);
}
BENCHMARK(BM_DecodeTolerantJson)->Arg(360)->Arg(1081);

void BM_DecodeCbor(benchmark::State& state) {
  run_decode(state, cbor_payloads(static_cast<std::size_t>(state.range(0))),
             codecs::kCborContentType);
}
BENCHMARK(BM_DecodeCbor)->Arg(360)->Arg(1081);

void BM_Prepare(benchmark::State& state) {
  const auto all = scans(static_cast<std::size_t>(state.range(0)));
  core::Bearings bearings;
  core::Sample sample;
  std::size_t i = 0;
  for (auto _ : state) {
    core::prepare(all[i++ % all.size()], {}, bearings, sample);
    benchmark::DoNotOptimize(sample);
  }
}
BENCHMARK(BM_Prepare)->Arg(360)->Arg(1081);

void BM_Compare(benchmark::State& state) {
  const auto all = scans(static_cast<std::size_t>(state.range(0)));
  core::Bearings bearings;
  std::vector<core::Sample> samples(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    core::prepare(all[i], {}, bearings, samples[i]);
  }
  core::DissimilarityWorkspace workspace;
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t at = i++ % (samples.size() - 1);
    benchmark::DoNotOptimize(core::dissimilarity(samples[at], samples[at + 1], {}, workspace));
  }
}
BENCHMARK(BM_Compare)->Arg(360)->Arg(1081);

/// As a first version does it: nothing kept from scan to scan.
core::Scan plainly_decoded(const std::string& payload) {
  const auto message = codecs::Json::parse(payload);
  core::Scan scan;
  scan.geometry = {message.at("angle_min"), message.at("angle_increment"), message.at("range_min"),
                   message.at("range_max")};
  for (const auto& range : message.at("ranges")) {
    scan.ranges_m.push_back(range.is_null() ? std::numeric_limits<float>::infinity()
                                            : range.get<float>());
  }
  return scan;
}

void BM_PathPlain(benchmark::State& state) {
  const auto payloads = json_payloads(static_cast<std::size_t>(state.range(0)));
  core::Scan before = plainly_decoded(payloads[0]);
  std::size_t i = 0;
  for (auto _ : state) {
    core::Scan now = plainly_decoded(payloads[++i % payloads.size()]);
    const auto p = core::cloud(before, core::InvalidPolicy::drop);
    const auto q = core::cloud(now, core::InvalidPolicy::drop);
    double v = core::variance_statistic(core::VarianceTest::bartlett, p.x, q.x);
    v += core::variance_statistic(core::VarianceTest::bartlett, p.y, q.y);
    v += core::critical_value(0.05, p.size() + q.size());
    benchmark::DoNotOptimize(v + bench::two_rows(p, q));
    before = std::move(now);
  }
}
BENCHMARK(BM_PathPlain)->Arg(360)->Arg(1081);

}  // namespace
}  // namespace kidnapwatch

BENCHMARK_MAIN();
