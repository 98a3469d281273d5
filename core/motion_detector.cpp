// SPDX-License-Identifier: Apache-2.0
// Scan against motion, scan after scan.
#include "core/motion_detector.hpp"

#include <algorithm>
#include <cmath>

namespace kidnapwatch::core {
namespace {

constexpr float kPriorMean = 1.0F;     // of the excesses that a robot's tail starts with
constexpr float kLearnable = 6.75F;    // higher scores are not natural driving
constexpr float kScreen = 0.9F;        // pairs below this quantile of the scores need no confirming
constexpr float kGapAllowance = 1.5F;  // per e-fold of missed scans
constexpr double kGapMax = 10.0;
constexpr double kGapBlindMax = 2.5;  // scans: after more, only wheels could tell what is expected
constexpr float kLearnedFormat = 2.0F;  // another number where their meaning changes
constexpr double kPeriodStep = 1.05;
constexpr double kCoast = 0.8;  // of the speed is kept, per scan that does not tell it
constexpr double kUsualRate = 0.05;
constexpr float kUnrestRate = 0.1F;
constexpr int kLearnTroubledEvery = 10;
constexpr float kUnrestMax = 0.35F;
constexpr float kBlindViolation = 0.35F;
constexpr float kGlitch = 0.6F;  // of what its own pairs show: the pair around a glitch fits
constexpr float kFit = 0.5F;     // quality of an alignment that says: these are the same walls

Pose scaled(const Pose& motion, double factor) {
  return {motion.x_m * factor, motion.y_m * factor, wrapped(motion.theta_rad * factor)};
}

/// One length for a motion, at a metre of lever: to tell who moved more.
double amount(const Pose& motion) {
  return std::hypot(motion.x_m, motion.y_m) + std::abs(motion.theta_rad);
}

Wheels joined(const Wheels& first, const Wheels& second) {
  return {first.motion * second.motion, first.scans + second.scans, first.before,
          first.before_scans, first.by_odometry && second.by_odometry};
}

/// Whether the scans on both sides of the last fit each other better than it, which was a glitch.
bool glitched(const Clues& into, const Clues& out_of, const Clues& around, float limit) {
  const auto unlike = [](const Clues& clues) { return clues.misfit + clues.unmatched; };
  return std::min(into.sum(), out_of.sum()) > 0.5F * limit &&
         (around.sum() < kGlitch * std::min(into.sum(), out_of.sum()) ||
          unlike(around) < kGlitch * std::min(unlike(into), unlike(out_of)));
}

Cause cause_of(const Comparison& pair, const Clues& clues) {
  if (clues.misfit >= 1.0F || pair.at_seen.quality() < kFit) return Cause::teleport;
  return amount(pair.seen) < 0.5 * amount(pair.claim.told) ? Cause::slip : Cause::displaced;
}

}  // namespace

MotionVerdict MotionDetector::observe(const Scan& scan, bool learning) {
  MotionVerdict verdict;
  const Wheels wheels = told(scan);
  newest_ = (newest_ + 1) % 3;
  trace(scan, views_[newest_]);
  const bool first = seen_ == 0;
  seen_ = std::min<std::size_t>(seen_ + 1, 3);
  keep_time(scan);
  verdict.threshold = threshold();
  if (first) return verdict;
  const float limit = verdict.threshold.value_or(static_cast<float>(config_.threshold_min));
  Pair latest = paired(view(1), view(0), wheels, wheels.scans);
  if (pending_) {
    const std::optional<Pair> around =
        suspicious(*pending_, limit) ? bridged(latest) : std::nullopt;
    verdict.jump = confirm(latest, around);
    verdict.jump->alarm = verdict.threshold && verdict.jump->score > limit;
    if (learning && !verdict.jump->alarm && may_learn()) learn(*pending_, *verdict.jump);
    skipped_ = !skipped_ && around && around->comparison.judged &&
               glitched(pending_->clues, latest.clues, around->clues, limit);
    if (skipped_) {  // the scan in between was a glitch: go on from the one before it
      latest = *around;
      std::swap(views_[(newest_ + 1) % 3], views_[(newest_ + 2) % 3]);
    }
  }
  verdict.judged = latest.comparison.judged;
  verdict.suspicion = latest.suspicion;
  if (verdict.jump && verdict.jump->alarm) carry_.reset();
  const bool quiet = !carry_.alarmed();
  const bool follows = latest.comparison.judged && latest.comparison.at_seen.quality() > kFit;
  if (follows && latest.comparison.claim.by_wheels)
    carry_.observe(latest.comparison.claim.expected, latest.comparison.followed, learning);
  verdict.carry = carry_.cusum();
  verdict.carried = quiet && carry_.alarmed();
  verdict.trouble = trouble(latest, limit);
  follow(latest, limit);
  earlier_ = pending_ && !(verdict.jump && verdict.jump->alarm) ? pending_->clues : Clues{};
  pending_ = latest;
  return verdict;
}

void MotionDetector::forget_scans() {
  seen_ = 0;
  pending_.reset();
  earlier_ = {};
  odometry_.reset();
  velocity_ = {};
  last_ = {};
  carry_.reset();
}

template <typename Self, typename Visit>
void MotionDetector::visit_learned(Self& self, Visit& visit) {
  Habits::visit_learned(self.habits_, visit);
  WheelModel::visit_learned(self.model_, visit);
  Tail::visit_learned(self.scores_, visit);
  Carry::visit_learned(self.carry_, visit);
  for (auto* number : {&self.period_s_, &self.usual_.x_m, &self.usual_.y_m}) visit(*number);
}

std::vector<float> MotionDetector::learned() const {
  std::vector<float> numbers{kLearnedFormat};
  const auto keep = [&](const auto& number) { numbers.push_back(static_cast<float>(number)); };
  visit_learned(*this, keep);
  return numbers;
}

bool MotionDetector::restore(std::span<const float> learned) {
  const bool is_finite = std::ranges::all_of(learned, [](float x) { return std::isfinite(x); });
  if (!is_finite || learned.size() != this->learned().size() || learned[0] != kLearnedFormat)
    return false;
  auto put_back = [next = learned.begin()](auto& number) mutable { number = *++next; };
  visit_learned(*this, put_back);
  habits_.rescale();
  return true;
}

std::optional<float> MotionDetector::threshold() const {
  const auto own = own_threshold();
  if (!own) return own;
  return std::max({*own, static_cast<float>(config_.threshold_min), fleet_threshold_});
}

std::optional<float> MotionDetector::own_threshold() const {
  if (static_cast<double>(habits_.pairs()) < config_.warmup_pairs) return std::nullopt;
  return predicted_threshold(scores_, static_cast<float>(config_.false_alarm_rate),
                             config_.tuning.prior_excesses, kPriorMean);
}

Wheels MotionDetector::told(const Scan& scan) const {
  const double elapsed = seen_ > 0 ? elapsed_s(stamp_, scan.stamp) : period_s_;
  const double scans = period_s_ > 0.0 ? std::max(1.0, std::round(elapsed / period_s_)) : 1.0;
  Wheels wheels{scaled(velocity_, scans), scans, last_.motion, last_.scans, false};
  if (scan.odometry && odometry_) {
    wheels.by_odometry = true;
    const Pose base = inverse(*odometry_) * *scan.odometry;
    wheels.motion = inverse(config_.sensor) * base * config_.sensor;
  }
  return wheels;
}

void MotionDetector::keep_time(const Scan& scan) {
  if (seen_ > 1) {
    const double elapsed = elapsed_s(stamp_, scan.stamp);
    if (period_s_ <= 0.0) period_s_ = elapsed;
    period_s_ *= elapsed > period_s_ ? kPeriodStep : 1.0 / kPeriodStep;
  }
  stamp_ = scan.stamp;
  odometry_ = scan.odometry;
}

Claim MotionDetector::claim(const Wheels& wheels) const {
  return {wheels.motion, model_.expected(wheels), wheels.by_odometry, scaled(usual_, wheels.scans)};
}

MotionDetector::Pair MotionDetector::paired(const Contour& before, const Contour& now,
                                            const Wheels& wheels, double gap) const {
  Pair pair;
  pair.wheels = wheels;
  pair.comparison = compare(before, now, claim(wheels), config_.tuning);
  if (!pair.comparison.judged) return pair;
  pair.clues = habits_.clues(pair.comparison.features);
  pair.allowance = habits_.allowance(pair.comparison.features);
  pair.allowance += kGapAllowance * static_cast<float>(std::log(std::min(wheels.scans, kGapMax)));
  const bool lost = !pair.comparison.claim.by_wheels && gap > kGapBlindMax;
  if (lost) pair.clues.unmatched = pair.clues.elsewhere = pair.clues.shift = pair.clues.turn = 0.0F;
  pair.suspicion = pair.clues.sum(pair.allowance, config_.tuning.motion_share);
  return pair;
}

bool MotionDetector::suspicious(const Pair& pair, float limit) const {
  const bool warm = scores_.count() >= static_cast<float>(config_.warmup_pairs);
  return !warm || !pair.comparison.judged || pair.clues.sum() > 0.5F * limit ||
         pair.suspicion > scores_.quantile(kScreen);
}

/// The pair of the latest scan and the one before the pending pair's second.
std::optional<MotionDetector::Pair> MotionDetector::bridged(const Pair& latest) const {
  return paired(view(2), view(0), joined(pending_->wheels, latest.wheels),
                std::max(pending_->wheels.scans, latest.wheels.scans));
}

/// What the latest scan makes of the pair before it.
MotionJump MotionDetector::confirm(const Pair& latest, const std::optional<Pair>& around) const {
  const Pair& suspect = *pending_;
  MotionJump jump{suspect.clues, suspect.allowance, suspect.suspicion, false, Cause::teleport};
  if (!around) return jump;
  const Clues after = habits_.clues(latest.comparison.lenient);
  jump.clues = confirmed(suspect.clues, around->clues, after, earlier_, config_.tuning.after);
  jump.score = jump.clues.sum(jump.allowance, config_.tuning.motion_share);
  jump.cause = cause_of(around->comparison, jump.clues);
  return jump;
}

/// What is in trouble is learned slowly: a robot that changed for good is believed in the end.
bool MotionDetector::may_learn() {
  if (!threshold() || unrest_ < kUnrestMax) return true;
  troubled_pairs_ = (troubled_pairs_ + 1) % kLearnTroubledEvery;
  return troubled_pairs_ == 0;
}

void MotionDetector::learn(const Pair& pair, const MotionJump& jump) {
  if (!pair.comparison.judged) return;
  const bool scaled_well = static_cast<double>(habits_.pairs()) >= 0.5 * config_.warmup_pairs;
  const bool plausible = jump.score < kLearnable;
  if (scaled_well && plausible) scores_.learn(jump.score);
  habits_.learn(pair.comparison.features);
  const Agreement& fit = pair.comparison.at_seen;
  if (fit.consistent > 0.5F && fit.violating < 0.2F && pair.comparison.matches > 30)
    model_.learn(pair.wheels, pair.comparison.seen);
}

/// Keeps what the next claim starts from.
void MotionDetector::follow(const Pair& pair, float limit) {
  last_ = pair.wheels;
  if (pair.comparison.claim.by_wheels) return;
  if (pair.suspicion >= limit || pair.comparison.at_seen.quality() < kFit) {  // perhaps a jump
    velocity_ = scaled(velocity_, kCoast);
    return;
  }
  velocity_ = scaled(pair.comparison.seen, 1.0 / pair.wheels.scans);
  usual_.x_m += kUsualRate * (velocity_.x_m - usual_.x_m);
  usual_.y_m += kUsualRate * (velocity_.y_m - usual_.y_m);
}

std::optional<Trouble> MotionDetector::trouble(const Pair& latest, float threshold) {
  const bool suspicious = !latest.comparison.judged || latest.suspicion >= threshold;
  unrest_ += kUnrestRate * ((suspicious ? 1.0F : 0.0F) - unrest_);
  if (!latest.comparison.judged || habits_.usual_violation() > kBlindViolation)
    return Trouble::blind;
  if (unrest_ < kUnrestMax) return std::nullopt;
  const Clues& clues = latest.clues;
  if (clues.misfit < clues.shift + clues.turn) return Trouble::odometry;
  const Agreement& fit = latest.comparison.at_seen;
  return fit.violating_elsewhere < 0.5F * fit.violating ? Trouble::crowd : Trouble::noise;
}

}  // namespace kidnapwatch::core
