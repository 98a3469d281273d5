// SPDX-License-Identifier: Apache-2.0
// The detectors, each behind the same two questions.
#include "core/evaluation/subject.hpp"

#include <algorithm>
#include <utility>

namespace kidnapwatch::core::evaluation {
namespace {

/// Whether `scan` comes after the last one of a run and shows enough.
bool is_next(const Scan& scan, std::optional<Stamp>& last) {
  if (!is_comparable(scan) || (last && scan.stamp <= *last)) return false;
  last = scan.stamp;
  return true;
}

/// Algorithm 3 on every pair; with confirmation, the score of a pair is the least of what the scan
/// after it leaves of it, and 0 where the jump does not stand out (Session).
class PaperSubject : public Subject {
 public:
  PaperSubject(const SubjectConfig& config, bool confirms)
      : config_(config), confirms_(confirms), calibration_(config.calibration) {}

  [[nodiscard]] std::unique_ptr<Subject> copy() const override {
    return std::make_unique<PaperSubject>(*this);
  }

  std::optional<Reading> observe(const Scan& scan, bool learn) override {
    if (!is_next(scan, last_)) return std::nullopt;
    std::swap(samples_[0], samples_[1]);
    std::swap(samples_[1], samples_[2]);
    prepare(scan, config_.dissimilarity, bearings_, samples_[2]);
    seen_ = std::min(seen_ + 1, 3);
    if (seen_ < 2) return std::nullopt;
    const double before = std::exchange(score_, cost(samples_[1], samples_[2]));
    const double score = confirms_ ? confirmed(before) : score_;
    const auto limit = threshold();
    if (learn) calibration_.learn(score_);
    return Reading{score, limit && score > *limit, false, {}, {}};
  }

  [[nodiscard]] std::optional<double> threshold() const override {
    return calibration_.threshold();
  }

 private:
  double cost(const Sample& before, const Sample& now) {
    return dissimilarity(before, now, config_.dissimilarity, workspace()).cost;
  }

  /// What the newest scan leaves of the pair before it, whose score was `before`.
  double confirmed(double before) {
    const double around = std::max(std::exchange(score_before_, before), score_);
    if (seen_ < 3 || before <= 2.0 * around) return 0.0;
    return std::min(before, cost(samples_[0], samples_[2]));
  }

  static DissimilarityWorkspace& workspace() {
    static thread_local DissimilarityWorkspace workspace;
    return workspace;
  }

  SubjectConfig config_;
  bool confirms_;
  Calibration calibration_;
  Bearings bearings_;
  std::array<Sample, 3> samples_;  // oldest first
  int seen_ = 0;
  double score_ = 0.0;         // of the newest pair
  double score_before_ = 0.0;  // of the pair before the one that is to be confirmed
  std::optional<Stamp> last_;
};

class MotionSubject : public Subject {
 public:
  MotionSubject(const SubjectConfig& config, bool uses_odometry)
      : detector_(config.motion), uses_odometry_(uses_odometry) {}

  [[nodiscard]] std::unique_ptr<Subject> copy() const override {
    return std::make_unique<MotionSubject>(*this);
  }

  std::optional<Reading> observe(const Scan& scan, bool learn) override {
    if (!is_next(scan, last_)) return std::nullopt;
    const MotionVerdict verdict = detector_.observe(uses_odometry_ ? scan : blinded(scan), learn);
    Reading reading{.carried = verdict.carried, .trouble = verdict.trouble};
    if (verdict.jump) {
      reading.score = static_cast<double>(verdict.jump->score);
      reading.alarm = verdict.jump->alarm;
      reading.cause = verdict.jump->cause;
    }
    return reading;
  }

  [[nodiscard]] std::optional<double> threshold() const override { return detector_.threshold(); }
  [[nodiscard]] std::optional<double> own_threshold() const override {
    return detector_.own_threshold();
  }

 private:
  const Scan& blinded(const Scan& scan) {
    blinded_ = scan;
    blinded_.odometry.reset();
    return blinded_;
  }

  MotionDetector detector_;
  bool uses_odometry_;
  Scan blinded_;
  std::optional<Stamp> last_;
};

}  // namespace

std::string_view name(DetectorKind kind) {
  static constexpr std::array<std::string_view, kDetectors.size()> names{
      "qs2ddtw", "qs2ddtw_confirmed", "motion_consistency", "motion_consistency_without_odometry"};
  return names[static_cast<std::size_t>(kind)];
}

std::unique_ptr<Subject> subject(DetectorKind kind, const SubjectConfig& config) {
  switch (kind) {
    case DetectorKind::qs2ddtw:
      return std::make_unique<PaperSubject>(config, false);
    case DetectorKind::qs2ddtw_confirmed:
      return std::make_unique<PaperSubject>(config, true);
    case DetectorKind::motion_consistency:
      return std::make_unique<MotionSubject>(config, true);
    case DetectorKind::motion_consistency_without_odometry:
      return std::make_unique<MotionSubject>(config, false);
  }
  return nullptr;
}

}  // namespace kidnapwatch::core::evaluation
