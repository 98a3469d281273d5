// SPDX-License-Identifier: Apache-2.0
// One robot: its scans in, verdicts out. The online half of Algorithm 3 and motion consistency,
// with confirmation.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/calibration.hpp"
#include "core/cause.hpp"
#include "core/detector_scores.hpp"
#include "core/dissimilarity.hpp"
#include "core/motion_detector.hpp"
#include "core/outcome.hpp"
#include "core/robot.hpp"
#include "core/scan.hpp"

namespace kidnapwatch::core {

/// Which detectors raise the alarm. The paper's score is always computed, motion consistency (most
/// of the time that a scan takes) where it has a say.
enum class AlarmBy : std::uint8_t {
  motion_consistency,  ///< the lidar against the wheels; carries too
  qs2ddtw,             ///< the paper's score alone
  either,              ///< any of them
  both,                ///< both, by the same scan
};

/// How kidnappings are detected. All of it can be changed while a robot drives.
struct DetectionConfig {
  AlarmBy alarm = AlarmBy::motion_consistency;
  DissimilarityConfig dissimilarity;
  MotionConfig motion;  ///< rate and warm-up are those of `calibration`
  CalibrationConfig calibration;
  std::optional<double> threshold;     ///< of QS-2DDTW, overrides the calibrated one; its unit
  std::vector<std::string> detectors;  ///< to be recorded beside these two, by name
  double stale_after_s = 5.0;          ///< without a scan, by time of arrival
  double resolve_after_s = 30.0;       ///< without a jump, by stamp; then an incident ends
  std::size_t resync_scans = 20;  ///< old stamps in a row that mean the robot's clock was set back

  friend bool operator==(const DetectionConfig&, const DetectionConfig&) = default;
};

/// Throws BadInput naming the field and its range unless every value is usable.
void check(const DetectionConfig& config);

/// What a scan says of the robot's motion, in units of its own natural variation.
struct MotionScore {
  double score = 0.0;               ///< of the scan and the last, alone
  std::optional<double> confirmed;  ///< of the pair before, as this scan confirms it
  std::optional<double> threshold;  ///< of `confirmed`; nothing while warming up
  double carry = 0.0;               ///< Carry::kAlarm is an alarm

  friend bool operator==(const MotionScore&, const MotionScore&) = default;
};

/// How unlike a robot's scan was to the one before, and what was concluded.
struct Score {
  Stamp stamp;      ///< of the scan
  Stamp reference;  ///< of the last good scan before it, with which it was compared
  Dissimilarity dissimilarity;
  std::optional<double> threshold;  ///< of its cost; nothing while warming up
  std::optional<MotionScore> motion;
  RobotState state = RobotState::unknown;  ///< after this scan
  std::vector<DetectorScore> others;       ///< of DetectionConfig::detectors that had an opinion

  friend bool operator==(const Score&, const Score&) = default;
};

enum class EpisodeChange {
  opened,    ///< a kidnapping was confirmed
  updated,   ///< moved again while the incident is open
  resolved,  ///< by rule: there was no jump for resolve_after_s
};

/// The last good scan before a jump, and the first one after it.
struct ScanPair {
  Scan before;
  Scan after;
};

/// Two scans that did not fit, and how far above the threshold they were.
struct Jump {
  ScanPair scans;
  double score = 0.0;  ///< of the detector that raised the alarm
  double threshold = 0.0;
  std::string detector;  ///< "motion_consistency", or that of the paper: detector_name()
  Cause cause = Cause::teleport;
};

struct Verdict {
  Score score;
  std::optional<EpisodeChange> change;
};

struct Observation {
  Outcome outcome = Outcome::first;
  std::optional<Verdict> verdict;  ///< exactly if the outcome is `scored`
};

/// A scan above the threshold makes the robot suspect, and the next good scan decides: see
/// MotionDetector, and for QS-2DDTW with the scans O, P | Q, R about the jump and their scores S
///
///     S(P,Q) > threshold  and  S(P,R) > threshold  and  S(P,Q) > 2 max(S(O,P), S(Q,R))
///
/// so that neither a glitch of one scan (S(P,R) is small) nor a fast turn (S(O,P) or S(Q,R) is
/// about as large) is a kidnapping. Which of the two raises the alarm is DetectionConfig::alarm.
class Session {
 public:
  /// `config` passed check().
  explicit Session(const DetectionConfig& config);

  /// Takes up at `now` where an earlier run stopped: its natural scores, oldest first, and whether
  /// an incident was open.
  void resume(std::span<const double> natural_scores, bool incident_open, Stamp now);

  /// What motion consistency has learned, to be kept over a restart: see MotionDetector.
  [[nodiscard]] std::vector<float> learned() const { return motion_.learned(); }
  bool restore(std::span<const float> learned) { return motion_.restore(learned); }

  /// Takes the robot's next scan, which passed check(), arriving at `arrival`; what is left in
  /// `scan` is memory to be filled again. `workspace` is that of the thread. Repeated, older and
  /// not comparable scans change nothing but the time of arrival. After resync_scans older scans in
  /// a row the robot's clock is believed to have been set back, and the last of them becomes the
  /// first.
  Observation observe(Scan& scan, Stamp arrival, DissimilarityWorkspace& workspace);

  /// The next scan is the first again. What was learned is kept, and so is an open incident.
  void forget_scans();

  /// Ends an open incident from outside: the robot knows where it is again. False if none is open.
  bool resolve();

  /// From now on; what was learned is kept unless the score itself changes.
  void configure(const DetectionConfig& config);

  /// The state at time of arrival `now`: stale if no scan arrived for stale_after_s.
  [[nodiscard]] RobotState state(Stamp now) const;

  /// Of QS-2DDTW: the configured threshold, else the calibrated one, else nothing.
  [[nodiscard]] std::optional<double> threshold() const;

  /// Of motion consistency; nothing while warming up, or where it has no say. Its own is what this
  /// robot's natural pairs alone let expect; the one in force is no lower than the fleet's, nor
  /// than threshold_min.
  [[nodiscard]] std::optional<double> motion_threshold() const;
  [[nodiscard]] std::optional<double> own_motion_threshold() const;
  void set_fleet_threshold(double threshold) { motion_.set_fleet_threshold(threshold); }

  /// Natural pairs that the calibrated thresholds rest on, of warmup_pairs needed.
  [[nodiscard]] std::size_t calibration_pairs() const;

  /// Why the robot is degraded, if it is.
  [[nodiscard]] std::optional<Trouble> trouble() const { return trouble_; }

  /// The last good scan; meaningless before the first.
  [[nodiscard]] const Scan& reference() const { return reference_; }

  /// The latest jump that opened or updated an incident; nothing before the first one.
  [[nodiscard]] const std::optional<Jump>& jump() const { return jump_; }

 private:
  /// A jump that the next good scan decides on.
  struct Suspicion {
    ScanPair scans;
    double score;         // Dissimilarity::cost of the pair
    Sample before_jump;   // of scans.before
    double score_before;  // of the pair before the jump
  };

  [[nodiscard]] std::optional<Outcome> refusal(const Scan& scan);
  [[nodiscard]] bool clock_was_set_back(Stamp stamp);
  Verdict judge(const Scan& scan, const MotionVerdict& motion, DissimilarityWorkspace& workspace);
  std::optional<EpisodeChange> advance(const Scan& scan, const Score& score,
                                       const MotionVerdict& motion,
                                       DissimilarityWorkspace& workspace);
  [[nodiscard]] std::optional<Jump> found(const Scan& scan, const Score& score,
                                          const MotionVerdict& motion,
                                          DissimilarityWorkspace& workspace);
  [[nodiscard]] bool is_suspect(const Score& score, const MotionVerdict& motion) const;
  [[nodiscard]] bool stands_out(const Score& score, DissimilarityWorkspace& workspace);
  EpisodeChange alarm(Jump jump);
  void note_trouble(const MotionVerdict& motion);
  void dismiss_suspicion();
  std::optional<EpisodeChange> rest(Stamp stamp);
  void learn(double score);
  [[nodiscard]] bool is_ready() const;
  [[nodiscard]] RobotState state() const;

  DetectionConfig config_;
  Calibration calibration_;
  MotionDetector motion_;
  Bearings bearings_;
  Scan reference_;  // the last good scan, if has_reference_
  Sample reference_sample_;
  Sample sample_;  // of the scan that is being judged
  bool has_reference_ = false;
  std::optional<Suspicion> suspicion_;
  std::optional<Jump> jump_;      // that was confirmed last
  std::optional<Stamp> arrival_;  // of any scan
  bool incident_open_ = false;
  std::optional<Stamp> quiet_since_;  // in an open incident: since when there was no jump
  double last_score_ = 0.0;           // of the pair before; 0 where there was none
  std::size_t old_stamps_ = 0;        // out of order in a row
  Stamp last_old_stamp_{};
  std::optional<Trouble> trouble_;
  double blindness_ = 0.0;  // share of the recent scans that could not be compared
};

}  // namespace kidnapwatch::core
