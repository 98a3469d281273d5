// SPDX-License-Identifier: Apache-2.0
// What people and robots may do to an incident: its life as a state machine.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/incident.hpp"

namespace kidnapwatch::core {

/// As Alertmanager and ISA-18.2 know them.
enum class IncidentAction : std::uint8_t {
  ack,      ///< somebody looks after it: open -> acknowledged
  unack,    ///< nobody does any more: acknowledged -> open
  resolve,  ///< the robot knows where it is: open or acknowledged -> resolved, for good
  shelve,   ///< nobody is to be called for a while; open and acknowledged ones
  label,    ///< what it was in truth; in any state
};

struct IncidentCommand {
  IncidentAction action = IncidentAction::ack;
  std::string author;                  ///< who says so
  std::optional<double> shelve_for_s;  ///< with shelve; 0: not any longer
  std::optional<IncidentLabel> label;  ///< with label
  std::optional<std::string> comment;  ///< with any; replaces the one before
};

inline constexpr double kLongestShelving_s = 7 * 24 * 3600.0;
inline constexpr std::size_t kLongestComment = 2000;  ///< code points

/// Throws BadInput naming `seconds`, `label` or `comment` unless the command is complete.
void check(const IncidentCommand& command);

/// An incident after a change, and what the alert says of it.
struct ChangedIncident {
  AlertType type = AlertType::updated;
  Incident incident;  ///< with its seq counted up
};

/// Of a command that passed check(), at `now`. Nothing where the incident's state does not allow
/// it. A command that changes nothing, such as the second of two, leaves `seq` as it is.
[[nodiscard]] std::optional<ChangedIncident> changed(const Incident& incident,
                                                     const IncidentCommand& command, Stamp now);

}  // namespace kidnapwatch::core
