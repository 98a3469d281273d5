// SPDX-License-Identifier: Apache-2.0
// What of motion consistency is a matter of judgement, so that it can be chosen on some robots and
// judged on others.
#pragma once

namespace kidnapwatch::core {

/// Fixed for the life of a detector.
struct MotionTuning {
  float elsewhere_factor = 1.5F;  ///< times what the better three quarters of the sectors show is
                                  ///< the most that a clue counts: less forgives more people
  float after = 1.5F;             ///< weight of what the pair after a jump shows as well
  float motion_share = 0.5F;      ///< of the allowance for moving more, for shift and turn
  float scale_min = 0.2F;         ///< least mean excess of a log feature: 20 %
  double doubt = 0.75;            ///< share of told against expected motion that is tolerated
  float prior_excesses = 10.0F;   ///< that a robot's tail of scores starts with, of mean 1
  float carry_slack = 1.0F;       ///< subtracted from the CUSUM per scan, beside the natural mean

  friend bool operator==(const MotionTuning&, const MotionTuning&) = default;
};

}  // namespace kidnapwatch::core
