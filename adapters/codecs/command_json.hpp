// SPDX-License-Identifier: Apache-2.0
// What is to be done to an incident or a robot, in; what became of it, out.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "adapters/codecs/json.hpp"
#include "core/robot_command.hpp"

namespace kidnapwatch::adapters::codecs {

/// The command "ack", "unack", "resolve", "shelve" or "label" with its members in `body`: a
/// `comment`; with shelve the `seconds`, with label the `label`. It passes core::check; its author
/// is left to the caller. Throws BadInput naming the member.
[[nodiscard]] core::IncidentCommand incident_command(std::string_view action, const Json& body);

/// What came on the topic `command` of `robot`: {"command": ...} with the members of that command,
/// or "relocalized" (the robot resolves its incident) or "reset"; the `incidentId`, and who says so
/// as `author`, which MQTT does not tell. The author becomes "mqtt:..." or "robot:...", so that
/// nobody passes for a caller of REST. Throws BadInput naming the member.
[[nodiscard]] core::RobotCommand robot_command(std::string_view payload, const std::string& robot);

/// What a command's sender is told.
struct CommandAnswer {
  core::CommandResult result = core::CommandResult::done;
  std::string detail;                      ///< why it was not done
  std::string field;                       ///< the member that is wrong, if one is
  std::optional<core::Incident> incident;  ///< after it
};

inline constexpr std::string_view kAnswerSchema = "kidnapwatch/answer/1";

/// With the members of RFC 9457 where it was not done; `status` is what REST would have said.
[[nodiscard]] std::string answer_message(const std::string& robot, const CommandAnswer& answer);

}  // namespace kidnapwatch::adapters::codecs
