// SPDX-License-Identifier: Apache-2.0
// Derived arrays of a scan, computed once and used by every comparison with it.
#include "core/contour.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kidnapwatch::core {
namespace {

constexpr std::size_t kMargin = Contour::kMargin;
constexpr float kStep_m = 0.3F;  // and 5 % of the range: farther away is another surface
constexpr float kStepShare = 0.05F;
constexpr std::uint32_t kMissesMax = 5;  // in a surface
constexpr float kPersonWidth_m = 0.9F;   // wider things are walls
constexpr float kGapMax_m = 1.0F;        // neighbours farther apart than this are not one surface

void aim(const ScanGeometry& geometry, std::size_t beams, Contour& contour) {
  if (contour.beams == beams && contour.geometry == geometry) return;
  contour.geometry = geometry;
  contour.beams = beams;
  contour.cos_bearing.resize(beams);
  contour.sin_bearing.resize(beams);
  for (std::size_t i = 0; i < beams; ++i) {
    const double bearing =
        geometry.angle_min_rad + static_cast<double>(i) * geometry.angle_increment_rad;
    contour.cos_bearing[i] = static_cast<float>(std::cos(bearing));
    contour.sin_bearing[i] = static_cast<float>(std::sin(bearing));
  }
  const double swept = std::abs(geometry.angle_increment_rad) * static_cast<double>(beams);
  contour.whole_turn =
      swept > 2.0 * std::numbers::pi - 1.5 * std::abs(geometry.angle_increment_rad);
  for (auto* array : {&contour.x, &contour.y, &contour.normal_x, &contour.normal_y, &contour.near_m,
                      &contour.far_m}) {
    array->resize(beams + 2 * kMargin);
  }
  contour.foreground.resize(beams + 2 * kMargin);
  for (auto* list : {&contour.px, &contour.py}) list->reserve(beams);
  for (auto* list : {&contour.pbeam, &contour.segment_ends}) list->reserve(beams);
}

/// Fills the margins with the other end of a whole turn, or with `nothing`.
void close(std::vector<float>& array, const Contour& contour, float nothing) {
  const std::size_t n = contour.beams;
  for (std::size_t i = 0; i < kMargin; ++i) {
    const bool wraps = contour.whole_turn && n >= kMargin;
    array[i] = wraps ? array[n + i] : nothing;
    array[kMargin + n + i] = wraps ? array[kMargin + i] : nothing;
  }
}

void place(const Scan& scan, Contour& contour) {
  contour.px.clear();
  contour.py.clear();
  contour.pbeam.clear();
  float sum_m = 0.0F;
  for (std::size_t i = 0; i < contour.beams; ++i) {
    const float r = scan.ranges_m[i];
    const bool hit = is_valid(r, scan.geometry);
    contour.x[kMargin + i] = hit ? r * contour.cos_bearing[i] : Contour::kNowhere;
    contour.y[kMargin + i] = hit ? r * contour.sin_bearing[i] : Contour::kNowhere;
    contour.near_m[kMargin + i] = hit ? r : 0.0F;
    if (!hit) continue;
    contour.px.push_back(contour.x[kMargin + i]);
    contour.py.push_back(contour.y[kMargin + i]);
    contour.pbeam.push_back(static_cast<std::uint32_t>(kMargin + i));
    sum_m += r;
  }
  contour.valid = contour.px.size();
  contour.mean_range_m = contour.valid > 0 ? sum_m / static_cast<float>(contour.valid) : 0.0F;
  close(contour.x, contour, Contour::kNowhere);
  close(contour.y, contour, Contour::kNowhere);
  close(contour.near_m, contour, 0.0F);
}

/// Least and largest valid range among three neighbours; near_m holds the ranges on entry.
void bound(Contour& contour) {
  float left = contour.near_m[kMargin - 1];
  for (std::size_t i = kMargin; i < kMargin + contour.beams; ++i) {
    const float here = contour.near_m[i];
    const float right = contour.near_m[i + 1];
    float least = 1e9F;
    for (const float r : {left, here, right}) least = r > 0.0F ? std::min(least, r) : least;
    contour.far_m[i] = std::max({left, here, right});
    contour.near_m[i] = contour.far_m[i] > 0.0F ? least : 0.0F;
    left = here;
  }
}

/// Where surfaces end: before a step in range, or too many misses.
void part(Contour& contour, const Scan& scan) {
  contour.segment_ends.clear();
  for (std::size_t i = 1; i <= contour.valid; ++i) {
    if (i < contour.valid) {
      const float a = scan.ranges_m[contour.pbeam[i - 1] - kMargin];
      const float b = scan.ranges_m[contour.pbeam[i] - kMargin];
      const bool near = std::abs(a - b) < kStep_m + kStepShare * std::min(a, b);
      if (near && contour.pbeam[i] - contour.pbeam[i - 1] <= kMissesMax) continue;
    }
    contour.segment_ends.push_back(static_cast<std::uint32_t>(i));
  }
}

/// People, poles and legs: narrow, and nearer than what is seen to their left and right.
void tell_foreground(const Scan& scan, Contour& contour) {
  std::fill(contour.foreground.begin(), contour.foreground.end(), 0);
  part(contour, scan);
  const std::size_t n = contour.segment_ends.size();
  const auto step_rad = static_cast<float>(std::abs(scan.geometry.angle_increment_rad));
  const auto range_of = [&](std::size_t point) {
    return scan.ranges_m[contour.pbeam[point] - kMargin];
  };
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t first = k == 0 ? 0 : contour.segment_ends[k - 1];
    const std::size_t last = contour.segment_ends[k] - 1;
    const auto beams = static_cast<float>(contour.pbeam[last] - contour.pbeam[first]);
    const float width = beams * step_rad * range_of(first);  // along the arc: a room may close
    const bool behind_left = first == 0 || range_of(first - 1) > range_of(first) + kStep_m;
    const bool behind_right =
        last + 1 == contour.valid || range_of(last + 1) > range_of(last) + kStep_m;
    if (width > kPersonWidth_m || !behind_left || !behind_right) continue;
    for (std::size_t i = first; i <= last; ++i) contour.foreground[contour.pbeam[i]] = 1;
  }
}

void raise_normals(Contour& contour) {
  for (std::size_t i = kMargin; i < kMargin + contour.beams; ++i) {
    const float dx = contour.x[i + 1] - contour.x[i - 1];
    const float dy = contour.y[i + 1] - contour.y[i - 1];
    const float length = std::sqrt(dx * dx + dy * dy);
    const bool surface = length > 1e-6F && length < kGapMax_m && contour.x[i] < Contour::kNowhere &&
                         contour.x[i + 1] < Contour::kNowhere;
    contour.normal_x[i] = surface ? -dy / length : 0.0F;
    contour.normal_y[i] = surface ? dx / length : 0.0F;
  }
  close(contour.normal_x, contour, 0.0F);
  close(contour.normal_y, contour, 0.0F);
}

}  // namespace

void trace(const Scan& scan, Contour& contour) {
  aim(scan.geometry, scan.ranges_m.size(), contour);
  place(scan, contour);
  raise_normals(contour);
  bound(contour);
  tell_foreground(scan, contour);
}

float bearing_rad(float y, float x) {
  const float ax = std::abs(x);
  const float ay = std::abs(y);
  const float a = std::min(ax, ay) / std::max({ax, ay, 1e-12F});
  const float s = a * a;
  float r = ((-0.0464964749F * s + 0.15931422F) * s - 0.327622764F) * s * a + a;
  r = ay > ax ? std::numbers::pi_v<float> / 2 - r : r;
  r = x < 0.0F ? std::numbers::pi_v<float> - r : r;
  return y < 0.0F ? -r : r;
}

int beam_towards(const Contour& contour, float x_m, float y_m) {
  const auto increment = static_cast<float>(contour.geometry.angle_increment_rad);
  constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;
  float ahead = bearing_rad(y_m, x_m) - static_cast<float>(contour.geometry.angle_min_rad);
  ahead = increment < 0.0F ? -ahead : ahead;
  const float step = std::abs(increment);
  ahead += 0.5F * step;
  ahead -= kTurn * std::floor(ahead / kTurn);
  const float beam = ahead / step;
  if (beam < static_cast<float>(contour.beams)) return static_cast<int>(beam);
  return contour.whole_turn ? 0 : -1;
}

}  // namespace kidnapwatch::core
