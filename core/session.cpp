// SPDX-License-Identifier: Apache-2.0
// The way of one robot's scans: refuse, compare with the last good one, judge.
#include "core/session.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kidnapwatch::core {
namespace {

constexpr double kOutstanding = 2.0;  // times the scores around it: a jump, not a fast turn

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

}  // namespace

void check(const DetectionConfig& config) {
  const double significance = config.dissimilarity.significance;
  require(significance > 0.0 && significance < 1.0, "dissimilarity.significance",
          "must be above 0 and below 1");
  check(config.calibration);
  check(config.detectors);
  require(!config.threshold || is_positive(*config.threshold), "threshold",
          "must be finite and above 0, or null to calibrate it");
  require(is_positive(config.stale_after_s), "stale_after_s", "must be finite and above 0");
  require(std::isfinite(config.resolve_after_s) && config.resolve_after_s >= 0.0, "resolve_after_s",
          "must be finite and at least 0; 0 never resolves by rule");
  require(config.resync_scans >= 2 && config.resync_scans <= 1000, "resync_scans",
          "must be from 2 to 1000");
}

Session::Session(const DetectionConfig& config)
    : config_(config), calibration_(config.calibration) {}

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
  prepare(scan, config_.dissimilarity, bearings_, sample_);
  Observation seen{Outcome::first, {}};
  if (std::exchange(has_reference_, true)) {
    seen = {Outcome::scored, judge(scan, workspace)};
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
    has_reference_ = false;
    suspicion_.reset();
    quiet_since_.reset();
    last_score_ = 0.0;
  }
  old_stamps_ = 0;
  return is_comparable(scan) ? std::nullopt : std::optional(Outcome::not_comparable);
}

bool Session::clock_was_set_back(Stamp stamp) {
  const bool goes_on = old_stamps_ > 0 && stamp > last_old_stamp_;
  old_stamps_ = goes_on ? old_stamps_ + 1 : 1;
  last_old_stamp_ = stamp;
  return old_stamps_ >= config_.resync_scans;
}

Verdict Session::judge(const Scan& scan, DissimilarityWorkspace& workspace) {
  Verdict verdict;
  Score& score = verdict.score;
  score.stamp = scan.stamp;
  score.reference = reference_.stamp;
  score.dissimilarity = dissimilarity(reference_sample_, sample_, config_.dissimilarity, workspace);
  score.threshold = threshold();
  if (score.threshold) {
    verdict.change = advance(scan, score.dissimilarity.cost, *score.threshold, workspace);
  } else {
    learn(score.dissimilarity.cost);
  }
  last_score_ = score.dissimilarity.cost;
  score.state = state();
  return verdict;
}

std::optional<EpisodeChange> Session::advance(const Scan& scan, double score, double threshold,
                                              DissimilarityWorkspace& workspace) {
  if (suspicion_ && stands_out(score, threshold, workspace)) {
    return alarm();
  }
  dismiss_suspicion();
  if (score > threshold) {
    suspicion_ =
        Suspicion{Jump{{reference_, scan}, score, threshold}, reference_sample_, last_score_};
    return std::nullopt;
  }
  learn(score);
  return rest(scan.stamp);
}

bool Session::stands_out(double score, double threshold, DissimilarityWorkspace& workspace) {
  const double around = std::max(suspicion_->score_before, score);
  return suspicion_->jump.score > kOutstanding * around &&
         dissimilarity(suspicion_->before_jump, sample_, config_.dissimilarity, workspace).cost >
             threshold;
}

EpisodeChange Session::alarm() {
  jump_ = std::exchange(suspicion_, std::nullopt)->jump;
  quiet_since_.reset();
  return std::exchange(incident_open_, true) ? EpisodeChange::updated : EpisodeChange::opened;
}

/// What was no kidnapping was natural, and is to be learned as such.
void Session::dismiss_suspicion() {
  if (const auto dismissed = std::exchange(suspicion_, std::nullopt)) {
    learn(dismissed->jump.score);
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
  config_ = config;
}

RobotState Session::state() const {
  if (incident_open_) {
    return RobotState::kidnapped;
  }
  if (suspicion_) {
    return RobotState::suspect;
  }
  return threshold() ? RobotState::normal : RobotState::unknown;
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

}  // namespace kidnapwatch::core
