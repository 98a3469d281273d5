// SPDX-License-Identifier: Apache-2.0
// What is no kidnapping, but looks like one: lost scans, people, noise, bad odometry.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/evaluation/episode.hpp"

namespace kidnapwatch::core::evaluation {

enum class Confounder : std::uint8_t {
  gap_2,  ///< scans missed, with odometry going on
  gap_5,
  gap_10,
  glitch,       ///< one scan of nonsense
  popup,        ///< for one scan 40 degrees are covered from near by
  popup_stays,  ///< the same, from then on
  person_1,     ///< discs of 0.22 m radius that walk 1.2 m/s, 0.8 m to 3 m away
  people_3,
  people_5,
  beam_loss,        ///< from now on 30 % of the beams are lost
  range_noise,      ///< from now on ranges have noise of 0.1 m
  bad_odometry,     ///< from now on every motion is 10 % and 3 degrees off
  late_odometry,    ///< from now on odometry is one scan late
  odometry_glitch,  ///< one odometry pose is off, the next is right again
  fast_turn,        ///< a recorded turn of more than 16 degrees per scan
};
inline constexpr std::array kConfounders{
    Confounder::gap_2,         Confounder::gap_5,           Confounder::gap_10,
    Confounder::glitch,        Confounder::popup,           Confounder::popup_stays,
    Confounder::person_1,      Confounder::people_3,        Confounder::people_5,
    Confounder::beam_loss,     Confounder::range_noise,     Confounder::bad_odometry,
    Confounder::late_odometry, Confounder::odometry_glitch, Confounder::fast_turn};

[[nodiscard]] std::string_view name(Confounder kind);

/// `count` scans after recording.scans[episode.at - 1] with the confounder in them; `at` is the
/// first scan concerned. Nothing where the recording has no place for it.
[[nodiscard]] std::optional<Episode> confounded(const Recording& recording, Confounder kind,
                                                std::size_t at, std::size_t count, Random& random);

}  // namespace kidnapwatch::core::evaluation
