// SPDX-License-Identifier: Apache-2.0
// Features of a pair of scans and their clues.
#include "core/motion_consistency.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kidnapwatch::core {
namespace {

constexpr float kShareFloor = 0.1F;      // added to shares, metres and radians before the logarithm
constexpr float kGoodQuality = 0.75F;    // an alignment that needs no second opinion
constexpr float kSeedPenalty = 0.02F;    // of quality, for seeds the wheels do not support
constexpr float kAlignedBonus = 0.005F;  // an alignment as good as the expectation is preferred
constexpr float kFollowed = 0.05F;       // worse in quality than the best alignment, at most
constexpr double kSeedTurn_rad = 0.03;   // a turn of the range profile that is worth a seed
constexpr double kTurnReach_rad = 0.8;   // of the range profile, if the field of view is partial
constexpr double kSearchStep_rad = 0.25;
constexpr std::size_t kSectorsMin = 4;
constexpr float kClueMax = 25.0F;
constexpr double kGraveDoubt_m = 0.15;  // and 0.7 of it in radians: believe whichever fits
constexpr int kRescaleEvery = 8;

std::size_t index(Feature feature) { return static_cast<std::size_t>(feature); }

struct Laid {
  Pose motion;
  Agreement agreement;
  float merit = -1e9F;
  int matches = 0;
};

/// The best of several ways to lay the scans on each other.
class BestFit {
 public:
  BestFit(const Contour& before, const Contour& now) : before_(before), now_(now) {}

  Agreement at(const Pose& motion) { return keep(motion, 0, -kAlignedBonus); }
  Laid from(const Pose& seed, const AlignmentConfig& config, float penalty) {
    const Alignment found = aligned(before_, now_, seed, config);
    const Agreement fit = keep(found.motion, found.matches, -penalty);
    return {found.motion, fit, fit.quality(), found.matches};
  }
  [[nodiscard]] const Laid& best() const { return best_; }

 private:
  Agreement keep(const Pose& motion, int matches, float bonus) {
    const Agreement found = agreement(contradictions(before_, now_, motion));
    if (found.quality() + bonus > best_.merit)
      best_ = {motion, found, found.quality() + bonus, matches};
    return found;
  }

  const Contour& before_;
  const Contour& now_;
  Laid best_;
};

/// Without wheels a robot may have turned, sped up or braked: tries the usual ways with every turn.
void search(const Claim& claim, BestFit& fit) {
  AlignmentConfig coarse;
  coarse.iterations = 6;
  coarse.points = 120;
  const Laid before_search = fit.best();
  for (const Pose& way : {claim.usual, claim.expected}) {
    for (int turn = -4; turn <= 4 && fit.best().merit < kGoodQuality; ++turn)
      fit.from({way.x_m, way.y_m, kSearchStep_rad * turn}, coarse, kSeedPenalty);
  }
  if (fit.best().merit > before_search.merit) fit.from(fit.best().motion, {}, kSeedPenalty);
}

/// The best alignment from as many seeds as it takes, and how the scans agree where expected.
Laid laid(const Contour& before, const Contour& now, const Claim& claim, Agreement& at_expected,
          Laid& followed) {
  AlignmentConfig first;
  first.iterations = 8;
  first.gate_m = 0.3F;
  AlignmentConfig wide;
  if (!claim.by_wheels) wide.reach_m = first.reach_m = 1.2;
  BestFit fit(before, now);
  at_expected = fit.at(claim.expected);
  followed = fit.from(claim.expected, first, 0.0F);
  if (fit.best().merit >= kGoodQuality) return fit.best();
  fit.from({0.0, 0.0, claim.expected.theta_rad}, wide, kSeedPenalty);
  const double reach_rad = before.whole_turn ? std::numbers::pi : kTurnReach_rad;
  const double turn_rad = profile_turn_rad(before, now, claim.expected.theta_rad, reach_rad);
  if (std::abs(wrapped(turn_rad - claim.expected.theta_rad)) > kSeedTurn_rad)
    fit.from({claim.expected.x_m, claim.expected.y_m, turn_rad}, wide, kSeedPenalty);
  if (!claim.by_wheels) search(claim, fit);
  return fit.best();
}

/// Pose on the way from `a` to `b` nearest to `to`, translation and angle each for itself.
Pose nearest_between(const Pose& a, const Pose& b, const Pose& to) {
  const double x = b.x_m - a.x_m;
  const double y = b.y_m - a.y_m;
  const double turn = wrapped(b.theta_rad - a.theta_rad);
  const double length2 = x * x + y * y;
  const double along =
      length2 > 1e-9 ? std::clamp(((to.x_m - a.x_m) * x + (to.y_m - a.y_m) * y) / length2, 0.0, 1.0)
                     : 0.0;
  const double around = std::abs(turn) > 1e-6
                            ? std::clamp(wrapped(to.theta_rad - a.theta_rad) / turn, 0.0, 1.0)
                            : 0.0;
  return {a.x_m + along * x, a.y_m + along * y, wrapped(a.theta_rad + around * turn)};
}

bool differ(const Pose& a, const Pose& b, double by) {
  return distance_m(a, b) > by || std::abs(wrapped(a.theta_rad - b.theta_rad)) > 0.7 * by;
}

float log_share(double value) { return std::log(static_cast<float>(value) + kShareFloor); }

/// The features of `seen` and `at_expected` against `expected`.
Features features_of(const Comparison& pair, const Pose& expected, const Agreement& at_expected,
                     double doubt) {
  const double way = std::hypot(pair.claim.told.x_m, pair.claim.told.y_m);
  const double turning = std::abs(pair.claim.told.theta_rad);
  const double doubt_m = distance_m(pair.claim.told, pair.claim.expected);
  const double doubt_rad =
      std::abs(wrapped(pair.claim.told.theta_rad - pair.claim.expected.theta_rad));
  const double shift =
      distance_m(pair.seen, expected) / (0.02 + 0.1 * way + 0.05 * turning + doubt * doubt_m);
  const double turn = std::abs(wrapped(pair.seen.theta_rad - expected.theta_rad)) /
                      (0.01 + 0.05 * way + 0.1 * turning + doubt * doubt_rad);
  return {log_share(pair.at_seen.violating),
          log_share(pair.at_seen.violating_elsewhere),
          log_share(1.0F - at_expected.consistent),
          log_share(1.0F - at_expected.consistent_elsewhere),
          log_share(1.0F - pair.at_seen.consistent),
          log_share(1.0F - pair.at_seen.consistent_elsewhere),
          static_cast<float>(std::log1p(shift)),
          static_cast<float>(std::log1p(turn)),
          log_share(way),
          log_share(turning)};
}

}  // namespace

Comparison compare(const Contour& before, const Contour& now, const Claim& claim,
                   const MotionTuning& tuning) {
  Comparison pair;
  pair.claim = claim;
  Agreement at_expected;
  Laid followed;
  const Laid best = laid(before, now, claim, at_expected, followed);
  pair.seen = best.motion;
  pair.followed = followed.merit > best.merit - kFollowed ? followed.motion : best.motion;
  pair.matches = best.matches;
  pair.at_seen = best.agreement;
  pair.judged = best.agreement.sectors >= kSectorsMin;
  pair.features = features_of(pair, claim.expected, at_expected, tuning.doubt);
  pair.lenient = pair.features;
  if (!differ(claim.told, claim.expected, 0.01)) return pair;
  const Agreement at_told = agreement(contradictions(before, now, claim.told));
  const Agreement& better = at_told.quality() > at_expected.quality() ? at_told : at_expected;
  pair.lenient = features_of(pair, nearest_between(claim.expected, claim.told, pair.seen), better,
                             tuning.doubt);
  if (differ(claim.told, claim.expected, kGraveDoubt_m))
    pair.features = features_of(pair, claim.expected, better, tuning.doubt);
  return pair;
}

Clues confirmed(const Clues& before_now, const Clues& before_next, const Clues& now_next,
                const Clues& earlier, float after_weight) {
  const auto both = [after_weight](float a, float b, float after) {
    return std::max(0.0F, std::min(a, b) - after_weight * after);
  };
  return {both(before_now.misfit, before_next.misfit, now_next.misfit),
          both(before_now.unmatched, before_next.unmatched, now_next.unmatched),
          both(before_now.elsewhere, before_next.elsewhere, now_next.elsewhere),
          both(before_now.shift, before_next.shift, std::max(now_next.shift, earlier.shift)),
          both(before_now.turn, before_next.turn, std::max(now_next.turn, earlier.turn))};
}

Habits::Habits(const MotionTuning& tuning)
    : tuning_(tuning), tails_{Tail(-2.5F, 5.0F, 2000.0F), Tail(-2.5F, 5.0F, 2000.0F),
                              Tail(-2.5F, 5.0F, 2000.0F), Tail(-2.5F, 5.0F, 2000.0F),
                              Tail(-2.5F, 5.0F, 2000.0F), Tail(-2.5F, 5.0F, 2000.0F),
                              Tail(-2.5F, 5.0F, 2000.0F), Tail(-2.5F, 5.0F, 2000.0F),
                              Tail(-2.5F, 5.0F, 2000.0F), Tail(-2.5F, 5.0F, 2000.0F)} {}

void Habits::learn(const Features& features) {
  for (std::size_t i = 0; i < kFeatures; ++i) tails_[i].learn(features[i]);
  if (++unscaled_ >= kRescaleEvery) rescale();
}

void Habits::rescale() {
  unscaled_ = 0;
  for (std::size_t i = 0; i < kFeatures; ++i) {
    const float q90 = tails_[i].quantile(0.9F);
    const Tail::Excess excess = tails_[i].excess(q90);
    scales_[i] = {
        q90, std::max(excess.count > 0.0F ? excess.sum / excess.count : 0.0F, tuning_.scale_min)};
  }
}

float Habits::unusual(Feature feature, const Features& features) const {
  const Scale& scale = scales_[index(feature)];
  return std::clamp((features[index(feature)] - scale.q90) / scale.mean_excess, 0.0F, kClueMax);
}

Clues Habits::clues(const Features& features) const {
  using enum Feature;
  return {std::min(unusual(violating, features),
                   tuning_.elsewhere_factor * unusual(violating_elsewhere, features)),
          std::min(unusual(unmatched, features),
                   tuning_.elsewhere_factor * unusual(unmatched_elsewhere, features)),
          std::min(unusual(inconsistent, features),
                   tuning_.elsewhere_factor * unusual(inconsistent_elsewhere, features)),
          unusual(shift, features), unusual(turn, features)};
}

float Habits::allowance(const Features& features) const {
  return unusual(Feature::way, features) + unusual(Feature::turning, features);
}

float Habits::usual_violation() const {
  if (pairs() < kRescaleEvery) return 0.0F;
  return std::exp(scales_[index(Feature::violating)].q90) - kShareFloor;
}

}  // namespace kidnapwatch::core
