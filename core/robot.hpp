// SPDX-License-Identifier: Apache-2.0
// What is known of one robot: its name and its state.
#pragma once

#include <cstdint>
#include <string_view>

namespace kidnapwatch::core {

enum class RobotState : std::uint8_t {
  unknown,    ///< no threshold yet: warming up
  normal,     ///< the last scans fit together
  suspect,    ///< the last scan did not fit; the next one decides
  kidnapped,  ///< an incident is open
  degraded,   ///< scans come, but cannot be judged
  stale,      ///< no scan for a while
};

/// As in messages and JSON: "normal", ...
[[nodiscard]] std::string_view name(RobotState state);

/// The inverse of name(). Throws BadInput naming `field` for any other text.
[[nodiscard]] RobotState robot_state(std::string_view text, std::string_view field);

/// Whether `text` is a robot id: 1 to 64 of A-Z a-z 0-9 _ . : -
[[nodiscard]] bool is_robot_id(std::string_view text);

}  // namespace kidnapwatch::core
