// SPDX-License-Identifier: Apache-2.0
// Confounders as short episodes.
#include "core/evaluation/confounders.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace kidnapwatch::core::evaluation {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kPersonRadius_m = 0.22;
constexpr double kWalk_mps = 1.2;
constexpr double kNearest_m = 0.05;
constexpr double kPopup_rad = 40.0 * kDegree;
constexpr double kFastTurn_rad = 16.0 * kDegree;

struct Person {
  double x_m, y_m, vx_mps, vy_mps;
};

std::vector<Person> crowd(const Scan& scan, std::size_t people, Random& random) {
  const ScanGeometry& g = scan.geometry;
  const double sweep = g.angle_increment_rad * static_cast<double>(scan.ranges_m.size());
  std::vector<Person> all;
  for (std::size_t i = 0; i < people; ++i) {
    const double bearing = g.angle_min_rad + uniform(random, 0.0, 1.0) * sweep;
    const double range = uniform(random, 0.8, 3.0);
    const double heading = uniform(random, 0.0, 2.0 * std::numbers::pi);
    all.push_back({range * std::cos(bearing), range * std::sin(bearing),
                   kWalk_mps * std::cos(heading), kWalk_mps * std::sin(heading)});
  }
  return all;
}

void cover(float& range, double by_m) {
  const auto near = static_cast<float>(std::max(by_m, kNearest_m));
  if (!(range > 0.0F) || range > near) range = near;
}

void occlude(Scan& scan, std::span<const Person> people, double after_s) {
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const double bearing =
        scan.geometry.angle_min_rad + static_cast<double>(i) * scan.geometry.angle_increment_rad;
    const double c = std::cos(bearing);
    const double s = std::sin(bearing);
    for (const Person& person : people) {
      const double x = person.x_m + person.vx_mps * after_s;
      const double y = person.y_m + person.vy_mps * after_s;
      const double along = x * c + y * s;
      const double aside = y * c - x * s;
      if (along < kNearest_m || std::abs(aside) > kPersonRadius_m) continue;
      cover(scan.ranges_m[i], along - std::sqrt(kPersonRadius_m * kPersonRadius_m - aside * aside));
    }
  }
}

/// People come into sight one by one, scan by scan, and walk on.
void walk(Episode& episode, std::size_t people, Random& random) {
  const auto all = crowd(episode.scans.front(), people, random);
  const Stamp start = episode.scans.front().stamp;
  for (std::size_t i = 0; i < episode.scans.size(); ++i) {
    Scan& scan = episode.scans[i];
    const double after_s = std::min(elapsed_s(start, scan.stamp), 0.5 * static_cast<double>(i));
    occlude(scan, std::span(all).first(std::min(people, i + 1)), after_s);
  }
}

void garble(Scan& scan, Random& random) {
  for (float& range : scan.ranges_m) range *= static_cast<float>(uniform(random, 0.3, 1.3));
}

void pop_up(Episode& episode, bool stays, Random& random) {
  const Scan& first = episode.scans.front();
  const auto width =
      static_cast<std::size_t>(kPopup_rad / std::abs(first.geometry.angle_increment_rad));
  if (width >= first.ranges_m.size()) return;
  const std::size_t from = pick(random, first.ranges_m.size() - width);
  const double range = uniform(random, 0.5, 1.2);
  const std::size_t covered = stays ? episode.scans.size() : 1;
  for (std::size_t k = 0; k < covered; ++k)
    for (std::size_t i = from; i < from + width; ++i) cover(episode.scans[k].ranges_m[i], range);
}

void lose_beams(Scan& scan, Random& random) {
  for (float& range : scan.ranges_m)
    if (uniform(random, 0.0, 1.0) < 0.3) range = 0.0F;
}

void add_noise(Scan& scan, Random& random) {
  for (float& range : scan.ranges_m)
    if (is_valid(range, scan.geometry))
      range = std::max(0.02F, range + static_cast<float>(gaussian(random, 0.1)));
}

void mistell(const Recording& recording, Episode& episode, double sign) {
  std::optional<Pose> last = recording.scans[episode.at - 1].scan.odometry;
  std::optional<Pose> told = last;
  for (Scan& scan : episode.scans) {
    if (!last || !scan.odometry) return;
    const Pose motion = inverse(*last) * *scan.odometry;
    last = scan.odometry;
    told = *told * Pose{motion.x_m * (1.0 + 0.1 * sign), motion.y_m * (1.0 + 0.1 * sign),
                        motion.theta_rad + 3.0 * kDegree * sign};
    scan.odometry = told;
  }
}

/// Every motion is told one scan late, as it has always been.
bool delay(const Recording& recording, Episode& episode) {
  std::optional<Pose> told = recording.scans[episode.at - 1].scan.odometry;
  if (episode.at < 2 || !told) return false;
  for (std::size_t i = 0; i < episode.scans.size(); ++i) {
    const std::size_t late = episode.at - 1 + i;
    told = *told * told_motion(recording, late - 1, late);
    episode.scans[i].odometry = told;
  }
  return true;
}

int gap(Confounder kind) {
  return kind == Confounder::gap_2 ? 2 : kind == Confounder::gap_5 ? 5 : 10;
}

std::size_t people(Confounder kind) {
  return kind == Confounder::person_1 ? 1 : kind == Confounder::people_3 ? 3 : 5;
}

/// Applies the confounder to scans that are otherwise as recorded; false if it does not apply.
bool apply(const Recording& recording, Confounder kind, Episode& episode, Random& random) {
  const double sign = pick(random, 2) == 0 ? 1.0 : -1.0;
  switch (kind) {
    case Confounder::gap_2:
    case Confounder::gap_5:
    case Confounder::gap_10:
      return true;
    case Confounder::glitch:
      garble(episode.scans.front(), random);
      return true;
    case Confounder::popup:
      pop_up(episode, false, random);
      return true;
    case Confounder::popup_stays:
      pop_up(episode, true, random);
      return true;
    case Confounder::person_1:
    case Confounder::people_3:
    case Confounder::people_5:
      walk(episode, people(kind), random);
      return true;
    case Confounder::beam_loss:
      for (Scan& scan : episode.scans) lose_beams(scan, random);
      return true;
    case Confounder::range_noise:
      for (Scan& scan : episode.scans) add_noise(scan, random);
      return true;
    case Confounder::bad_odometry:
      mistell(recording, episode, sign);
      break;
    case Confounder::late_odometry:
      return delay(recording, episode);
    case Confounder::odometry_glitch: {
      auto& odometry = episode.scans.front().odometry;
      if (odometry)
        *odometry = *odometry * Pose{uniform(random, 0.2, 0.6), 0.0, uniform(random, -0.35, 0.35)};
      break;
    }
    case Confounder::fast_turn:
      return std::abs(told_motion(recording, episode.at - 1, episode.at).theta_rad) > kFastTurn_rad;
  }
  return recording.scans[episode.at].scan.odometry.has_value();
}

}  // namespace

std::string_view name(Confounder kind) {
  static constexpr std::array<std::string_view, kConfounders.size()> names{
      "gap_2",       "gap_5",        "gap_10",        "glitch",          "popup",
      "popup_stays", "person_1",     "people_3",      "people_5",        "beam_loss",
      "range_noise", "bad_odometry", "late_odometry", "odometry_glitch", "fast_turn"};
  return names[static_cast<std::size_t>(kind)];
}

std::optional<Episode> confounded(const Recording& recording, Confounder kind, std::size_t at,
                                  std::size_t count, Random& random) {
  const bool gaps = kind <= Confounder::gap_10;
  const std::size_t missed = gaps ? static_cast<std::size_t>(gap(kind)) - 1 : 0;
  if (at <= missed) return std::nullopt;
  auto episode = excerpt(recording, at - missed, at, count);
  if (!episode || !apply(recording, kind, *episode, random)) return std::nullopt;
  return episode;
}

}  // namespace kidnapwatch::core::evaluation
