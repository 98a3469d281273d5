// SPDX-License-Identifier: Apache-2.0
// Kidnappings as short episodes.
#include "core/evaluation/kidnaps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kidnapwatch::core::evaluation {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kFar_m = 4.0;
constexpr double kLookAlike_m = 2.0;
constexpr int kPlaces = 40;
constexpr double kSameHeading_rad = 10.0 * kDegree;
constexpr double kSamePlace_m = 0.25;
constexpr std::size_t kDriftFree_scans = 400;  // without true poses: as far as odometry is believed
constexpr double kCarryLeast_m = 0.3;

/// T_at_place: where the robot was at `place`, seen from where it was at `at`.
std::optional<Pose> away(const Recording& recording, std::size_t at, std::size_t place) {
  const auto here = pose_of(recording.scans[at]);
  const auto there = pose_of(recording.scans[place]);
  if (!here || !there) return std::nullopt;
  return inverse(*here) * *there;
}

std::optional<std::size_t> place_beyond(const Recording& recording, std::size_t at, double least_m,
                                        std::size_t count, Random& random) {
  if (recording.scans.size() < count + 2) return std::nullopt;
  for (int tries = 0; tries < 200; ++tries) {
    const std::size_t place = 1 + pick(random, recording.scans.size() - count - 1);
    const auto motion = away(recording, at, place);
    if (motion && std::hypot(motion->x_m, motion->y_m) >= least_m) return place;
  }
  return std::nullopt;
}

double unlikeness(const Scan& a, const Scan& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < std::min(a.ranges_m.size(), b.ranges_m.size()); i += 2) {
    const float p = is_valid(a.ranges_m[i], a.geometry) ? a.ranges_m[i] : 0.0F;
    const float q = is_valid(b.ranges_m[i], b.geometry) ? b.ranges_m[i] : 0.0F;
    sum += std::min(std::abs(p - q), 1.0F);
  }
  return sum;
}

std::optional<std::size_t> look_alike(const Recording& recording, std::size_t at, std::size_t count,
                                      Random& random) {
  std::optional<std::size_t> best;
  double least = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const auto place = place_beyond(recording, at, kLookAlike_m, count, random);
    if (!place) return best;
    const double cost = unlikeness(recording.scans[at].scan, recording.scans[*place].scan);
    if (best && cost >= least) continue;
    best = place;
    least = cost;
  }
  return best;
}

/// A place whose pose seen from `at` satisfies `wanted`.
template <class Wanted>
std::optional<std::size_t> place_where(const Recording& recording, std::size_t at,
                                       std::size_t count, Random& random, Wanted wanted) {
  std::vector<std::size_t> places;
  for (std::size_t i = 1; i + count <= recording.scans.size(); ++i) {
    const bool drifted =
        !recording.scans[i].true_pose && std::max(i, at) - std::min(i, at) > kDriftFree_scans;
    const auto motion = away(recording, at, i);
    if (motion && !drifted && wanted(*motion)) places.push_back(i);
  }
  if (places.empty()) return std::nullopt;
  return places[pick(random, places.size())];
}

std::optional<std::size_t> place_at(const Recording& recording, std::size_t at, double distance,
                                    std::size_t count, Random& random) {
  return place_where(recording, at, count, random, [distance](const Pose& motion) {
    const double way = std::hypot(motion.x_m, motion.y_m);
    return std::abs(way - distance) < 0.2 * distance &&
           std::abs(motion.theta_rad) < kSameHeading_rad;
  });
}

bool sweeps_whole_turn(const Scan& scan) {
  return std::abs(scan.geometry.angle_increment_rad) * static_cast<double>(scan.ranges_m.size()) >
         6.2;
}

void turn(Scan& scan, double angle_rad) {
  const double step = scan.geometry.angle_increment_rad;
  const auto whole = static_cast<std::size_t>(std::lround(2.0 * std::numbers::pi / std::abs(step)));
  const auto n = static_cast<std::ptrdiff_t>(std::min(scan.ranges_m.size(), whole));
  const auto shift = ((std::lround(angle_rad / step) % n) + n) % n;
  std::rotate(scan.ranges_m.begin(), scan.ranges_m.begin() + shift, scan.ranges_m.begin() + n);
}

std::optional<Episode> turned(const Recording& recording, std::size_t at, double angle_rad,
                              std::size_t count, Random& random) {
  const Pose told = told_motion(recording, at - 1, at);
  if (sweeps_whole_turn(recording.scans[at].scan)) {
    auto episode = relocated(recording, at, at, count, told);
    const double angle = pick(random, 2) == 0 ? angle_rad : -angle_rad;
    if (episode) std::ranges::for_each(episode->scans, [angle](Scan& scan) { turn(scan, angle); });
    return episode;
  }
  const auto place = place_where(recording, at, count, random, [angle_rad](const Pose& motion) {
    return std::hypot(motion.x_m, motion.y_m) < kSamePlace_m &&
           std::abs(std::abs(motion.theta_rad) - angle_rad) < 0.15 * angle_rad + 0.02;
  });
  return place ? relocated(recording, at, *place, count, told) : std::nullopt;
}

std::optional<Episode> moved_to(const Recording& recording, std::size_t at,
                                std::optional<std::size_t> place, std::size_t count) {
  if (!place) return std::nullopt;
  return relocated(recording, at, *place, count, told_motion(recording, at - 1, at));
}

std::optional<Episode> woken(const Recording& recording, std::size_t at, std::size_t count,
                             Random& random) {
  const auto place = place_beyond(recording, at, kFar_m, count, random);
  if (!place) return std::nullopt;
  auto episode = relocated(recording, at, *place, count, Pose{});
  if (episode)
    for (Scan& scan : episode->scans) scan.stamp = later_by_s(scan.stamp, 10.0);
  return episode;
}

std::optional<Episode> slipped(const Recording& recording, std::size_t at, const Pose& error,
                               std::size_t count) {
  if (!recording.scans[at].scan.odometry) return std::nullopt;
  return relocated(recording, at, at, count, told_motion(recording, at - 1, at) * error);
}

std::optional<Episode> carried(const Recording& recording, std::size_t at, std::size_t count) {
  auto episode = relocated(recording, at, at, count, Pose{});
  if (!episode || !episode->scans.front().odometry) return std::nullopt;
  for (const std::size_t part : {2U, 1U}) {  // half of it in half the time: not standing first
    const auto motion = away(recording, at - 1, at + count / part - 1);
    if (!motion || std::hypot(motion->x_m, motion->y_m) < kCarryLeast_m / static_cast<double>(part))
      return std::nullopt;
  }
  for (Scan& scan : episode->scans) scan.odometry = recording.scans[at - 1].scan.odometry;
  return episode;
}

}  // namespace

std::string_view name(Kidnap kind) {
  static constexpr std::array<std::string_view, kKidnaps.size()> names{
      "far",        "look_alike", "move_025m",   "move_05m", "move_1m",  "move_2m",   "turn_15deg",
      "turn_30deg", "turn_90deg", "turn_180deg", "wake",     "slip_way", "slip_turn", "carry"};
  return names[static_cast<std::size_t>(kind)];
}

std::optional<Episode> kidnapped(const Recording& recording, Kidnap kind, std::size_t at,
                                 std::size_t count, Random& random) {
  if (at == 0 || at + count > recording.scans.size()) return std::nullopt;
  const double sign = pick(random, 2) == 0 ? 1.0 : -1.0;
  const auto move = [&](double m) {
    return moved_to(recording, at, place_at(recording, at, m, count, random), count);
  };
  switch (kind) {
    case Kidnap::far:
      return moved_to(recording, at, place_beyond(recording, at, kFar_m, count, random), count);
    case Kidnap::look_alike:
      return moved_to(recording, at, look_alike(recording, at, count, random), count);
    case Kidnap::move_025m:
      return move(0.25);
    case Kidnap::move_05m:
      return move(0.5);
    case Kidnap::move_1m:
      return move(1.0);
    case Kidnap::move_2m:
      return move(2.0);
    case Kidnap::turn_15deg:
      return turned(recording, at, 15.0 * kDegree, count, random);
    case Kidnap::turn_30deg:
      return turned(recording, at, 30.0 * kDegree, count, random);
    case Kidnap::turn_90deg:
      return turned(recording, at, 90.0 * kDegree, count, random);
    case Kidnap::turn_180deg:
      return turned(recording, at, 180.0 * kDegree, count, random);
    case Kidnap::wake:
      return woken(recording, at, count, random);
    case Kidnap::slip_way:
      return slipped(recording, at, {sign * 0.5, 0.0, 0.0}, count);
    case Kidnap::slip_turn:
      return slipped(recording, at, {0.0, 0.0, sign * 30.0 * kDegree}, count);
    case Kidnap::carry:
      return carried(recording, at, count);
  }
  return std::nullopt;
}

}  // namespace kidnapwatch::core::evaluation
