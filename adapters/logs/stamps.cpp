// SPDX-License-Identifier: Apache-2.0
// Repairs a log's clock: no step back, no standstill, no leap.
#include "adapters/logs/stamps.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

constexpr double kShortestStep = 1e-6;            // s
constexpr double kLongestStep = 86'400.0;         // s
constexpr double kLatestStart = 4'102'444'800.0;  // 2100-01-01, s since 1970
constexpr double kLatest = 8'835'955'200.0;       // 2250-01-01, what nanoseconds can still count

bool believed(double step_s) { return step_s >= kShortestStep && step_s <= kLongestStep; }

/// The step that stands in for those not believed; 0 if too few are believed for one.
double usual_step(std::span<const double> logged_s) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < logged_s.size(); ++i) {
    const double step_s = logged_s[i] - logged_s[i - 1];
    if (believed(step_s)) steps.push_back(step_s);
  }
  if (2 * steps.size() < logged_s.size() - 1 || steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

core::Stamp stamp(double since_epoch_s) {
  return core::stamp_from_ns(std::llround(since_epoch_s * 1e9));
}

}  // namespace

std::vector<core::Stamp> increasing_stamps(std::span<const double> logged_s,
                                           const std::string& where) {
  std::vector<core::Stamp> stamps;
  if (logged_s.empty()) return stamps;
  const double usual_s = usual_step(logged_s);
  const bool start_believed = logged_s[0] >= 0.0 && logged_s[0] <= kLatestStart;
  double now_s = start_believed ? logged_s[0] : 0.0;
  double shift_s = now_s - logged_s[0];
  stamps.push_back(stamp(now_s));
  for (std::size_t i = 1; i < logged_s.size(); ++i) {
    if (usual_s > 0.0 && believed(logged_s[i] - logged_s[i - 1])) {
      now_s = logged_s[i] + shift_s;
    } else {
      now_s += usual_s > 0.0 ? usual_s : 1.0;
      shift_s = now_s - logged_s[i];
    }
    if (now_s > kLatest) throw core::BadInput(where, "the run ends after 2250");
    stamps.push_back(stamp(now_s));
  }
  return stamps;
}

void set_stamps(core::Recording& recording, std::span<const double> logged_s,
                const std::string& where) {
  assert(recording.scans.size() == logged_s.size());
  const auto stamps = increasing_stamps(logged_s, where);
  for (std::size_t i = 0; i < stamps.size(); ++i) recording.scans[i].scan.stamp = stamps[i];
}

}  // namespace kidnapwatch::adapters::logs
