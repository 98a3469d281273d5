// SPDX-License-Identifier: Apache-2.0
// Scores that are recorded beside the alarm's own: which there are, and what they said of a scan.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/names.hpp"

namespace kidnapwatch::core {

/// The number of a detector, as it is stored.
enum class DetectorId : std::uint8_t {};

/// By number, and numbers are stored: new ones go to the end.
inline constexpr std::array<std::string_view, 12> kDetectorNames{
    "1ddtw",  "s1ddtw", "qs1ddtw", "2ddtw",  "s2ddtw", "qs2ddtw",  //
    "ndt_qe", "ndt_qs", "ndt_qh",  "ndt_qo", "mcw",    "me"};

[[nodiscard]] constexpr std::string_view name(DetectorId detector) {
  return kDetectorNames.at(static_cast<std::size_t>(detector));
}

/// The inverse of name(). Throws BadInput naming `field` for any other text.
[[nodiscard]] inline DetectorId detector_id(std::string_view text, std::string_view field) {
  return named<DetectorId>(kDetectorNames, text, field);
}

/// What one detector said of a scan.
struct DetectorScore {
  DetectorId detector{};
  float score = 0.0F;

  friend bool operator==(const DetectorScore&, const DetectorScore&) = default;
};

}  // namespace kidnapwatch::core
