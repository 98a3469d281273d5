// SPDX-License-Identifier: Apache-2.0
// Free-space test between two aligned scans.
#include "core/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace kidnapwatch::core {
namespace {

constexpr float kTolerance_m = 0.10F;
constexpr float kToleranceShare = 0.03F;
constexpr float kUnseenReach = 0.8F;  // of range_max: nearer, "nothing there" contradicts a point
constexpr float kPointsMin = 4.0F;

/// The points of `seen`, at T_observer_seen, held against what `observer` measured: calls
/// visit(point, observer's beam, saw through, fits) for each that says something.
template <typename Visit>
void hold(const Contour& observer, const Contour& seen, const Pose& pose, Visit visit) {
  const auto c = static_cast<float>(std::cos(pose.theta_rad));
  const auto s = static_cast<float>(std::sin(pose.theta_rad));
  const auto tx = static_cast<float>(pose.x_m);
  const auto ty = static_cast<float>(pose.y_m);
  const float reach = kUnseenReach * static_cast<float>(observer.geometry.range_max_m);
  const bool same_beams = seen.beams == observer.beams;
  for (std::size_t i = 0; i < seen.valid; ++i) {
    const float x = c * seen.px[i] - s * seen.py[i] + tx;
    const float y = s * seen.px[i] + c * seen.py[i] + ty;
    const int beam = beam_towards(observer, x, y);
    if (beam < 0) continue;
    const std::size_t k = Contour::kMargin + static_cast<std::size_t>(beam);
    const float r = std::sqrt(x * x + y * y);
    const float tolerance = kTolerance_m + kToleranceShare * r;
    const bool unseen = observer.far_m[k] <= 0.0F;
    const bool blind = unseen && same_beams && seen.far_m[k] <= 0.0F;
    const bool through = !blind && (unseen ? r < reach : r < observer.near_m[k] - tolerance);
    const bool fits = !unseen && !through && r < observer.far_m[k] + tolerance;
    const bool passing = through ? seen.foreground[seen.pbeam[i]] : observer.foreground[k];
    if (passing && !fits) continue;  // people come and go, and hide what is behind them
    visit(i, beam, through, fits);
  }
}

void judge(const Contour& observer, const Contour& seen, const Pose& pose,
           std::span<Tally, kSectors> sectors) {
  const float sector_beams = static_cast<float>(kSectors) *
                             static_cast<float>(std::abs(observer.geometry.angle_increment_rad)) /
                             (2.0F * std::numbers::pi_v<float>);
  hold(observer, seen, pose, [&](std::size_t, int beam, bool through, bool fits) {
    const auto at = static_cast<std::size_t>(static_cast<float>(beam) * sector_beams);
    Tally& tally = sectors[std::min(at, kSectors - 1)];
    tally.points += 1.0F;
    tally.violating += through ? 1.0F : 0.0F;
    tally.consistent += fits ? 1.0F : 0.0F;
  });
}

/// Share `count` of all points, without the quarter of the sectors that is first by `worse`.
template <class Worse>
float trimmed_share(std::array<Tally, 2 * kSectors>& sectors, std::size_t n, float Tally::*count,
                    Worse worse) {
  const auto begin = sectors.begin();
  const auto kept = begin + static_cast<std::ptrdiff_t>((n + 3) / 4);
  const auto end = begin + static_cast<std::ptrdiff_t>(n);
  std::nth_element(begin, kept, end, worse);
  float points = 0.0F;
  float counted = 0.0F;
  for (auto sector = kept; sector != end; ++sector) {
    points += sector->points;
    counted += (*sector).*count;
  }
  return points > 0.0F ? counted / points : 0.0F;
}

}  // namespace

Tallies contradictions(const Contour& before, const Contour& now, const Pose& motion) {
  Tallies tallies{};
  judge(before, now, motion, std::span(tallies).first<kSectors>());
  judge(now, before, inverse(motion), std::span(tallies).last<kSectors>());
  return tallies;
}

std::vector<std::size_t> violating_beams(const Contour& observer, const Contour& seen,
                                         const Pose& pose) {
  std::vector<std::size_t> beams;
  hold(observer, seen, pose, [&](std::size_t point, int, bool through, bool) {
    if (through) beams.push_back(seen.pbeam[point] - Contour::kMargin);
  });
  return beams;
}

Agreement agreement(const Tallies& tallies) {
  Agreement result;
  Tally all;
  Tallies filled{};
  for (const Tally& sector : tallies) {
    all.points += sector.points;
    all.consistent += sector.consistent;
    all.violating += sector.violating;
    if (sector.points >= kPointsMin) filled[result.sectors++] = sector;
  }
  if (result.sectors == 0) return result;
  result.consistent = all.consistent / all.points;
  result.violating = all.violating / all.points;
  result.violating_elsewhere =
      trimmed_share(filled, result.sectors, &Tally::violating, [](const Tally& a, const Tally& b) {
        return a.violating * b.points > b.violating * a.points;
      });
  result.consistent_elsewhere =
      trimmed_share(filled, result.sectors, &Tally::consistent, [](const Tally& a, const Tally& b) {
        return a.consistent * b.points < b.consistent * a.points;
      });
  return result;
}

}  // namespace kidnapwatch::core
