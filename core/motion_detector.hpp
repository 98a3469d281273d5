// SPDX-License-Identifier: Apache-2.0
// One robot's scans and odometry in, what they say about its motion out: jumps confirmed by the
// next scan, slow carries, and trouble that is no kidnapping.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/carry.hpp"
#include "core/cause.hpp"
#include "core/contour.hpp"
#include "core/motion_consistency.hpp"
#include "core/motion_tuning.hpp"
#include "core/scan.hpp"
#include "core/tail.hpp"
#include "core/wheel_model.hpp"

namespace kidnapwatch::core {

struct MotionConfig {
  double false_alarm_rate = 1e-3;  ///< targeted share of natural pairs above the threshold
  double threshold_min = 6.0;      ///< no robot's threshold is below
  double warmup_pairs = 60;        ///< natural pairs before anything is concluded
  Pose sensor;                     ///< T_base_sensor; what is not told is learned from turns
  MotionTuning tuning;

  friend bool operator==(const MotionConfig&, const MotionConfig&) = default;
};

/// What is concluded of the pair (reference, suspect), once the scan after them is there.
struct MotionJump {
  Clues clues;                    ///< that all three scans together give
  float allowance = 0.0F;         ///< subtracted from its sum: this robot moved more than usual
  float score = 0.0F;             ///< clues.sum() - allowance
  bool alarm = false;             ///< score above the threshold
  Cause cause = Cause::teleport;  ///< what it would be
};

struct MotionVerdict {
  bool judged = false;             ///< this scan could be compared with the last
  float suspicion = 0.0F;          ///< score of this scan and the last alone
  std::optional<float> threshold;  ///< nothing while warming up
  std::optional<MotionJump> jump;  ///< of the scan before, that this one confirms or not
  float carry = 0.0F;              ///< CUSUM; Carry::kAlarm is an alarm
  bool carried = false;            ///< crossed it with this scan
  std::optional<Trouble> trouble;
};

class MotionDetector {
 public:
  explicit MotionDetector(const MotionConfig& config)
      : config_(config), habits_(config.tuning), carry_(config.tuning.carry_slack) {}

  /// Takes the robot's next scan, which is comparable and newer than the last. `learn`: false while
  /// an incident is open. Allocates only when the number of beams grows.
  MotionVerdict observe(const Scan& scan, bool learn = true);

  /// From now on; what was learned is kept.
  void configure(const MotionConfig& config) { config_ = config; }

  /// What the fleet's other robots found: no threshold is below that from now on.
  void set_fleet_threshold(double threshold) { fleet_threshold_ = static_cast<float>(threshold); }

  /// Forgets the last scans (a restart, a clock set back), not what was learned.
  void forget_scans();

  /// All that was learned, to be kept over a restart.
  [[nodiscard]] std::vector<float> learned() const;
  /// Goes on with `learned`. False, and nothing is changed, if these are not the numbers of a
  /// detector of this kind.
  bool restore(std::span<const float> learned);

  /// The highest of its own, the fleet's and threshold_min; nothing while warming up.
  [[nodiscard]] std::optional<float> threshold() const;
  /// What this robot's natural pairs alone let expect.
  [[nodiscard]] std::optional<float> own_threshold() const;
  [[nodiscard]] float pairs() const { return habits_.pairs(); }
  [[nodiscard]] const Habits& habits() const { return habits_; }
  [[nodiscard]] const WheelModel& wheels() const { return model_; }
  [[nodiscard]] const Tail& scores() const { return scores_; }

 private:
  struct Pair {  // the last comparison, waiting to be confirmed
    Comparison comparison;
    Wheels wheels;
    Clues clues;
    float allowance = 0.0F;
    float suspicion = 0.0F;
  };

  template <typename Self, typename Visit>
  static void visit_learned(Self& self, Visit& visit);
  [[nodiscard]] Wheels told(const Scan& scan) const;
  [[nodiscard]] Claim claim(const Wheels& wheels) const;
  /// `gap`: scans between two of the scans seen, at most.
  [[nodiscard]] Pair paired(const Contour& before, const Contour& now, const Wheels& wheels,
                            double gap) const;
  [[nodiscard]] bool suspicious(const Pair& pair, float limit) const;
  [[nodiscard]] std::optional<Pair> bridged(const Pair& latest) const;
  [[nodiscard]] MotionJump confirm(const Pair& latest, const std::optional<Pair>& around) const;
  [[nodiscard]] bool may_learn();
  void learn(const Pair& pair, const MotionJump& jump);
  void follow(const Pair& pair, float limit);
  void keep_time(const Scan& scan);
  [[nodiscard]] std::optional<Trouble> trouble(const Pair& latest, float threshold);
  [[nodiscard]] const Contour& view(std::size_t scans_ago) const {
    return views_[(newest_ + 3 - scans_ago) % 3];
  }

  MotionConfig config_;
  float fleet_threshold_ = 0.0F;
  std::array<Contour, 3> views_;
  std::size_t newest_ = 0;
  std::size_t seen_ = 0;  // scans in views_
  std::optional<Pair> pending_;
  Clues earlier_;  // of the pair before the pending one
  Habits habits_;
  WheelModel model_;
  Tail scores_{-5.0F, 30.0F, 2000.0F};
  Carry carry_;
  Stamp stamp_{};
  std::optional<Pose> odometry_;
  double period_s_ = 0.0;  // median time between scans
  Pose velocity_;          // the last trusted motion, per scan: the claim without odometry
  Pose usual_;             // the average of the motions, without their turns
  Wheels last_;            // the last claim that was believed
  bool skipped_ = false;   // the last scan was a glitch
  int troubled_pairs_ = 0;
  float unrest_ = 0.0F;  // share of recent pairs that looked suspicious
};

}  // namespace kidnapwatch::core
