// SPDX-License-Identifier: Apache-2.0
// Does what the lidar sees agree with how the robot says it moved? Features of a pair of scans, and
// how unusual they are for this robot.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/alignment.hpp"
#include "core/contour.hpp"
#include "core/free_space.hpp"
#include "core/motion_tuning.hpp"
#include "core/pose.hpp"
#include "core/tail.hpp"

namespace kidnapwatch::core {

/// What is known of a motion before the scans are looked at, in the sensor's frame.
struct Claim {
  Pose told;      ///< by the wheels, or going on as before where there is no odometry
  Pose expected;  ///< `told`, corrected by what is known of this robot's wheels
  bool by_wheels = true;
  Pose usual;  ///< without wheels: the motion that it makes on average
};

/// Features of a pair of scans; each a logarithm, greater = less consistent.
enum class Feature : std::uint8_t {
  violating,               ///< share of points in the other's free space, at the best alignment
  violating_elsewhere,     ///< the same without the worst quarter of the sectors
  inconsistent,            ///< share of points without a counterpart, at the expected motion
  inconsistent_elsewhere,  ///< the same without the worst quarter of the sectors
  unmatched,               ///< share of points without a counterpart, at the best alignment
  unmatched_elsewhere,     ///< the same without the worst quarter of the sectors
  shift,                   ///< best alignment against expected motion: metres over their tolerance
  turn,                    ///< the same for the angle
  way,                     ///< metres the wheels tell
  turning,                 ///< radians the wheels tell
};
inline constexpr std::size_t kFeatures = 10;
using Features = std::array<float, kFeatures>;

/// Two scans compared.
struct Comparison {
  bool judged = false;  ///< enough sectors of both fields of view overlap
  Claim claim;
  Pose seen;        ///< T_before_now of the best alignment
  Pose followed;    ///< of the alignment from the expected motion, if that is about as good
  int matches = 0;  ///< points that the alignment rests on
  Agreement at_seen;
  Features features{};
  /// The same against whichever of `told` and `expected` fits better: what can at least be said
  /// where the last motion, and with it the expectation, is itself in doubt.
  Features lenient{};
};

/// Aligns the scans from up to three seeds and tells the features. Allocates nothing.
[[nodiscard]] Comparison compare(const Contour& before, const Contour& now, const Claim& claim,
                                 const MotionTuning& tuning = {});

/// How strongly a pair speaks against the robot having moved as expected; each >= 0, in units of
/// this robot's own mean excess, so that about exp(-x) of its natural pairs exceed x.
struct Clues {
  float misfit = 0.0F;     ///< the scans do not fit together however they are laid
  float unmatched = 0.0F;  ///< much of each has no counterpart in the other, however they are laid
  float elsewhere = 0.0F;  ///< the same where the wheels put them
  float shift = 0.0F;      ///< they fit, but some metres off
  float turn = 0.0F;       ///< they fit, but turned

  /// How strongly in all, with `allowance` for a robot that moved more than it uses to: then more
  /// comes into sight and goes, and odometry errs a little more (`motion_share` of that).
  [[nodiscard]] float sum(float allowance = 0.0F, float motion_share = 0.0F) const {
    return std::max(0.0F, misfit + std::max(unmatched, elsewhere) - allowance) +
           std::max(0.0F, shift + turn - motion_share * allowance);
  }
};

/// Clues of a jump between `before` and `now` that the scan after confirms: what both pairs with
/// `before` show (a glitch is gone in the second) and the pair after the jump does not (noise and
/// bad odometry stay; weighed by `after_weight`). Nor may the pair `earlier` show the same shift or
/// turn.
[[nodiscard]] Clues confirmed(const Clues& before_now, const Clues& before_next,
                              const Clues& now_next, const Clues& earlier,
                              float after_weight = MotionTuning{}.after);

/// What is normal for one robot: the upper tail of each feature over its natural pairs.
class Habits {
 public:
  explicit Habits(const MotionTuning& tuning = {});

  void learn(const Features& features);
  [[nodiscard]] float pairs() const { return tails_[0].count(); }

  [[nodiscard]] Clues clues(const Features& features) const;
  /// How much more this robot moved than it uses to, in the unit of the clues: new things come
  /// into sight then, and old ones go.
  [[nodiscard]] float allowance(const Features& features) const;
  /// Share of violating points that this robot's natural pairs reach one time in ten; 0 while next
  /// to nothing was learned.
  [[nodiscard]] float usual_violation() const;

  [[nodiscard]] const std::array<Tail, kFeatures>& tails() const { return tails_; }

  /// As Tail::visit_learned; rescale() after numbers were put back.
  template <typename Self, typename Visit>
  static void visit_learned(Self& self, Visit& visit) {
    for (auto& tail : self.tails_) Tail::visit_learned(tail, visit);
  }
  void rescale();

 private:
  struct Scale {
    float q90 = 0.0F;
    float mean_excess = 1.0F;
  };
  [[nodiscard]] float unusual(Feature feature, const Features& features) const;

  MotionTuning tuning_;
  std::array<Tail, kFeatures> tails_;
  std::array<Scale, kFeatures> scales_{};
  int unscaled_ = 0;  // learned since scales_ were computed
};

}  // namespace kidnapwatch::core
