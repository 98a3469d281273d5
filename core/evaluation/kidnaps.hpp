// SPDX-License-Identifier: Apache-2.0
// Every way to kidnap a robot that a detector is asked to notice, cut from real scans.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/evaluation/episode.hpp"

namespace kidnapwatch::core::evaluation {

enum class Kidnap : std::uint8_t {
  far,         ///< to a place at least 4 m away
  look_alike,  ///< the most similar of 40 places at least 2 m away
  move_025m,   ///< to a place that far from here, +- 20 %, within 10 degrees of this heading
  move_05m,
  move_1m,
  move_2m,
  turn_15deg,  ///< turned on the spot: whole-turn scans exactly, others to a recorded scan like
               ///< that
  turn_30deg,
  turn_90deg,
  turn_180deg,
  wake,       ///< far, after 10 s covered and without odometry meanwhile
  slip_way,   ///< the wheels tell half a metre too much or too little
  slip_turn,  ///< the wheels tell 30 degrees too much or too little
  carry,      ///< the robot moves on as recorded, the wheels tell nothing
};
inline constexpr std::array kKidnaps{Kidnap::far,         Kidnap::look_alike, Kidnap::move_025m,
                                     Kidnap::move_05m,    Kidnap::move_1m,    Kidnap::move_2m,
                                     Kidnap::turn_15deg,  Kidnap::turn_30deg, Kidnap::turn_90deg,
                                     Kidnap::turn_180deg, Kidnap::wake,       Kidnap::slip_way,
                                     Kidnap::slip_turn,   Kidnap::carry};

[[nodiscard]] std::string_view name(Kidnap kind);

/// `count` scans after recording.scans[at - 1], in which the robot is kidnapped before the first.
/// Nothing where the recording has no place for it. 1 <= at.
[[nodiscard]] std::optional<Episode> kidnapped(const Recording& recording, Kidnap kind,
                                               std::size_t at, std::size_t count, Random& random);

}  // namespace kidnapwatch::core::evaluation
