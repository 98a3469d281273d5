// SPDX-License-Identifier: Apache-2.0
// What may be asked of a robot's watch over MQTT, and what becomes of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/incident_command.hpp"

namespace kidnapwatch::core {

struct RobotCommand {
  std::optional<IncidentCommand> change;   ///< of an incident; nothing: forget the last scans
  std::optional<std::string> incident_id;  ///< of the change; nothing: the robot's open one
};

/// Where a command's way ended. Every command that arrives ends in exactly one.
enum class CommandResult : std::uint8_t {
  done,
  malformed,      ///< no JSON, an unknown command, a member that is missing or wrong
  too_large,      ///< payload above the limit
  unknown_robot,  ///< no robot of that name has sent a scan
  no_incident,    ///< none is open, or none of this robot has that id
  not_allowed,    ///< the incident's state does not allow it
  retained,       ///< said before we listened: not carried out, not answered
  overload,       ///< too many are waiting: not carried out, not answered
  unavailable,    ///< the robot's lane or the store is too busy
  failed,         ///< a fault of our own; see the log
};
inline constexpr std::size_t kCommandResults = static_cast<std::size_t>(CommandResult::failed) + 1;

/// As in metrics and JSON: "done", "no_incident", ...
[[nodiscard]] std::string_view name(CommandResult result);

/// A count per result.
using CommandCounts = std::array<std::uint64_t, kCommandResults>;

}  // namespace kidnapwatch::core
