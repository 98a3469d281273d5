// SPDX-License-Identifier: Apache-2.0
// The way of one robot's scans: refuse, compare with the last good one, judge.
#include "core/session.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kidnapwatch::core {
namespace {

constexpr double kBlindRate = 0.1;            // of forgetting how many scans could not be compared
constexpr double kBlind = 0.8;                // share of them: hardly anything can be judged
constexpr double kMotionWarmup_pairs = 60.0;  // the least that its habits can be told from
constexpr double kOutstanding = 2.0;          // times the scores around it: a jump, not a fast turn

void require(bool usable, const char* field, const char* reason) {
  if (!usable) {
    throw BadInput(field, reason);
  }
}

bool is_positive(double value) { return std::isfinite(value) && value > 0.0; }

void check(const CalibrationConfig& config) {
  require(config.false_alarm_rate > 0.0 && config.false_alarm_rate < 0.05,
          "calibration.false_alarm_rate", "must be above 0 and below 0.05");
  require(config.window_pairs >= 20 && config.window_pairs <= 100'000, "calibration.window_pairs",
          "must be from 20 to 100000");
  require(config.warmup_pairs >= 20 && config.warmup_pairs <= config.window_pairs,
          "calibration.warmup_pairs", "must be from 20 to window_pairs");
}

void check(const std::vector<std::string>& detectors) {
  for (auto one = detectors.begin(); one != detectors.end(); ++one) {
    (void)detector_id(*one, "detectors");
    require(std::find(detectors.begin(), one, *one) == one, "detectors", "must not repeat a name");
  }
}

MotionConfig motion_config(const DetectionConfig& config) {
  MotionConfig motion = config.motion;
  motion.false_alarm_rate = config.calibration.false_alarm_rate;
  motion.warmup_pairs =
      std::max(kMotionWarmup_pairs, static_cast<double>(config.calibration.warmup_pairs));
  return motion;
}

MotionScore motion_score(const MotionVerdict& verdict) {
  MotionScore score{.score = static_cast<double>(verdict.suspicion),
                    .threshold = verdict.threshold,
                    .carry = static_cast<double>(verdict.carry)};
  if (verdict.jump) {
    score.confirmed = verdict.jump->score;
  }
  return score;
}

bool uses_motion(AlarmBy alarm) { return alarm != AlarmBy::qs2ddtw; }
bool uses_paper(AlarmBy alarm) { return alarm != AlarmBy::motion_consistency; }

}  // namespace

void check(const DetectionConfig& config) {
  const double significance = config.dissimilarity.significance;
  require(significance > 0.0 && significance < 1.0, "dissimilarity.significance",
          "must be above 0 and below 1");
  check(config.calibration);
  check(config.detectors);
  require(std::isfinite(config.motion.threshold_min) && config.motion.threshold_min > 0.0,
          "motion.threshold_min", "must be finite and above 0");
  require(std::isfinite(config.motion.sensor.x_m) && std::isfinite(config.motion.sensor.y_m) &&
              std::isfinite(config.motion.sensor.theta_rad),
          "motion.sensor", "must be finite");
  require(!config.threshold || is_positive(*config.threshold), "threshold",
          "must be finite and above 0, or null to calibrate it");
  require(is_positive(config.stale_after_s), "stale_after_s", "must be finite and above 0");
  require(std::isfinite(config.resolve_after_s) && config.resolve_after_s >= 0.0, "resolve_after_s",
          "must be finite and at least 0; 0 never resolves by rule");
  require(config.resync_scans >= 2 && config.resync_scans <= 1000, "resync_scans",
          "must be from 2 to 1000");
}

Session::Session(const DetectionConfig& config)
    : config_(config), calibration_(config.calibration), motion_(motion_config(config)) {}

void Session::resume(std::span<const double> natural_scores, bool incident_open, Stamp now) {
  for (const double score : natural_scores) {
    calibration_.learn(score);
  }
  incident_open_ = incident_open;
  arrival_ = now;
}

Observation Session::observe(Scan& scan, Stamp arrival, DissimilarityWorkspace& workspace) {
  arrival_ = arrival;
  if (const auto outcome = refusal(scan)) {
    return {*outcome, {}};
  }
  const MotionVerdict motion =
      uses_motion(config_.alarm) ? motion_.observe(scan, !incident_open_) : MotionVerdict{};
  note_trouble(motion);
  prepare(scan, config_.dissimilarity, bearings_, sample_);
  Observation seen{Outcome::first, {}};
  if (std::exchange(has_reference_, true)) {
    seen = {Outcome::scored, judge(scan, motion, workspace)};
  }
  std::swap(reference_, scan);
  std::swap(reference_sample_, sample_);
  return seen;
}

std::optional<Outcome> Session::refusal(const Scan& scan) {
  if (has_reference_ && scan.stamp == reference_.stamp) {
    return Outcome::repeated;
  }
  if (has_reference_ && scan.stamp < reference_.stamp) {
    if (!clock_was_set_back(scan.stamp)) {
      return Outcome::out_of_order;
    }
    forget_scans();
  }
  old_stamps_ = 0;
  const bool blind = !is_comparable(scan);
  blindness_ += kBlindRate * ((blind ? 1.0 : 0.0) - blindness_);
  if (blind && blindness_ > kBlind) {
    trouble_ = Trouble::blind;
  }
  return blind ? std::optional(Outcome::not_comparable) : std::nullopt;
}

void Session::forget_scans() {
  has_reference_ = false;
  motion_.forget_scans();
  suspicion_.reset();
  quiet_since_.reset();
  last_score_ = 0.0;
  old_stamps_ = 0;
}

bool Session::clock_was_set_back(Stamp stamp) {
  const bool goes_on = old_stamps_ > 0 && stamp > last_old_stamp_;
  old_stamps_ = goes_on ? old_stamps_ + 1 : 1;
  last_old_stamp_ = stamp;
  return old_stamps_ >= config_.resync_scans;
}

void Session::note_trouble(const MotionVerdict& motion) {
  trouble_.reset();
  if (blindness_ > kBlind) {
    trouble_ = Trouble::blind;
  } else if (uses_motion(config_.alarm)) {
    trouble_ = motion.trouble;
  }
}

Verdict Session::judge(const Scan& scan, const MotionVerdict& motion,
                       DissimilarityWorkspace& workspace) {
  Verdict verdict;
  Score& score = verdict.score;
  score.stamp = scan.stamp;
  score.reference = reference_.stamp;
  score.dissimilarity = dissimilarity(reference_sample_, sample_, config_.dissimilarity, workspace);
  score.threshold = threshold();
  if (uses_motion(config_.alarm)) score.motion = motion_score(motion);
  verdict.change = advance(scan, score, motion, workspace);
  last_score_ = score.dissimilarity.cost;
  score.state = state();
  return verdict;
}

std::optional<EpisodeChange> Session::advance(const Scan& scan, const Score& score,
                                              const MotionVerdict& motion,
                                              DissimilarityWorkspace& workspace) {
  if (auto jump = found(scan, score, motion, workspace)) {
    return alarm(std::move(*jump));
  }
  dismiss_suspicion();
  if (is_suspect(score, motion)) {
    suspicion_ =
        Suspicion{{reference_, scan}, score.dissimilarity.cost, reference_sample_, last_score_};
    return std::nullopt;
  }
  learn(score.dissimilarity.cost);
  return rest(scan.stamp);
}

/// The jump or carry that the latest scan proves, as the configured detectors see it.
std::optional<Jump> Session::found(const Scan& scan, const Score& score,
                                   const MotionVerdict& motion, DissimilarityWorkspace& workspace) {
  const bool by_paper = suspicion_ && uses_paper(config_.alarm) && stands_out(score, workspace);
  const bool by_motion =
      suspicion_ && uses_motion(config_.alarm) && motion.jump && motion.jump->alarm;
  const bool agreed = config_.alarm != AlarmBy::both || (by_paper && by_motion);
  if (by_motion && agreed) {
    return Jump{std::move(suspicion_->scans), motion.jump->score, motion.threshold.value_or(0.0F),
                "motion_consistency", motion.jump->cause};
  }
  if (by_paper && agreed) {
    return Jump{std::move(suspicion_->scans), suspicion_->score, *score.threshold,
                std::string(detector_name(config_.dissimilarity)), Cause::teleport};
  }
  const bool may_carry =
      config_.alarm == AlarmBy::motion_consistency || config_.alarm == AlarmBy::either;
  if (motion.carried && may_carry) {
    return Jump{
        {reference_, scan}, motion.carry, Carry::kAlarm, "motion_consistency", Cause::carry};
  }
  return std::nullopt;
}

bool Session::is_suspect(const Score& score, const MotionVerdict& motion) const {
  const bool by_paper = score.threshold && score.dissimilarity.cost > *score.threshold;
  const bool by_motion = motion.threshold && motion.suspicion > *motion.threshold;
  return (by_paper && uses_paper(config_.alarm)) || (by_motion && uses_motion(config_.alarm));
}

bool Session::stands_out(const Score& score, DissimilarityWorkspace& workspace) {
  const double around = std::max(suspicion_->score_before, score.dissimilarity.cost);
  return score.threshold && suspicion_->score > *score.threshold &&
         suspicion_->score > kOutstanding * around &&
         dissimilarity(suspicion_->before_jump, sample_, config_.dissimilarity, workspace).cost >
             *score.threshold;
}

EpisodeChange Session::alarm(Jump jump) {
  jump_ = std::move(jump);
  suspicion_.reset();
  quiet_since_.reset();
  return std::exchange(incident_open_, true) ? EpisodeChange::updated : EpisodeChange::opened;
}

/// What was no kidnapping was natural, and is to be learned as such.
void Session::dismiss_suspicion() {
  if (const auto dismissed = std::exchange(suspicion_, std::nullopt)) {
    learn(dismissed->score);
  }
}

void Session::learn(double score) {
  if (!incident_open_) {
    calibration_.learn(score);
  }
}

std::optional<EpisodeChange> Session::rest(Stamp stamp) {
  if (!incident_open_) {
    return std::nullopt;
  }
  if (!quiet_since_) {
    quiet_since_ = stamp;
  }
  const bool over =
      config_.resolve_after_s > 0.0 && elapsed_s(*quiet_since_, stamp) >= config_.resolve_after_s;
  return over && resolve() ? std::optional(EpisodeChange::resolved) : std::nullopt;
}

bool Session::resolve() {
  quiet_since_.reset();
  return std::exchange(incident_open_, false);
}

void Session::configure(const DetectionConfig& config) {
  if (config.dissimilarity == config_.dissimilarity) {
    calibration_.configure(config.calibration);
  } else {
    calibration_ = Calibration(config.calibration);
    suspicion_.reset();
    last_score_ = 0.0;
    if (has_reference_) {
      prepare(reference_, config.dissimilarity, bearings_, reference_sample_);
    }
  }
  motion_.configure(motion_config(config));
  if (!uses_motion(config_.alarm)) {
    motion_.forget_scans();  // it has not seen the latest ones
  }
  config_ = config;
}

std::size_t Session::calibration_pairs() const {
  const auto motion = static_cast<std::size_t>(motion_.pairs());
  return config_.alarm == AlarmBy::qs2ddtw ? calibration_.pairs() : motion;
}

bool Session::is_ready() const {
  switch (config_.alarm) {
    case AlarmBy::motion_consistency:
      return motion_.threshold().has_value();
    case AlarmBy::qs2ddtw:
      return threshold().has_value();
    case AlarmBy::either:
      return threshold() || motion_.threshold();
    case AlarmBy::both:
      return threshold() && motion_.threshold();
  }
  return false;
}

RobotState Session::state() const {
  if (incident_open_) {
    return RobotState::kidnapped;
  }
  if (trouble_) {
    return RobotState::degraded;
  }
  if (suspicion_) {
    return RobotState::suspect;
  }
  return is_ready() ? RobotState::normal : RobotState::unknown;
}

RobotState Session::state(Stamp now) const {
  if (!arrival_ || elapsed_s(*arrival_, now) <= config_.stale_after_s) {
    return state();
  }
  return RobotState::stale;
}

std::optional<double> Session::threshold() const {
  return config_.threshold ? config_.threshold : calibration_.threshold();
}

std::optional<double> Session::motion_threshold() const {
  return uses_motion(config_.alarm) ? motion_.threshold() : std::nullopt;
}

std::optional<double> Session::own_motion_threshold() const {
  return uses_motion(config_.alarm) ? motion_.own_threshold() : std::nullopt;
}

}  // namespace kidnapwatch::core
