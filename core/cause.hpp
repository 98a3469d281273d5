// SPDX-License-Identifier: Apache-2.0
// What a robot went through, and why it cannot be judged, in words for programs and for people.
#pragma once

#include <cstdint>
#include <string_view>

namespace kidnapwatch::core {

/// What a kidnapping looks like.
enum class Cause : std::uint8_t {
  teleport,   ///< nothing matches
  carry,      ///< every scan fits the one before, but the robot moved on unlike its wheels
  displaced,  ///< the surroundings match, somewhat away from where the wheels say
  slip,       ///< the walls are where they were, but the wheels say it moved
};

/// Why scans cannot be judged now, although they come.
enum class Trouble : std::uint8_t {
  blind,     ///< too little in sight, or nothing ever fits
  odometry,  ///< scan for scan the wheels say something else than the walls
  noise,     ///< scan for scan nothing fits anywhere
  crowd,     ///< much moves, but the rest stays where it was
};

/// As in messages and JSON: "teleport", ...
[[nodiscard]] std::string_view name(Cause cause);
[[nodiscard]] std::string_view name(Trouble trouble);

/// One sentence for an operator.
[[nodiscard]] std::string_view sentence(Cause cause);
[[nodiscard]] std::string_view sentence(Trouble trouble);

/// The inverse of name(). Throws BadInput naming `field` for any other text.
[[nodiscard]] Cause cause(std::string_view text, std::string_view field);

}  // namespace kidnapwatch::core
