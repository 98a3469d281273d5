// SPDX-License-Identifier: Apache-2.0
// The names of an incident's kinds and states.
#include "core/incident.hpp"

#include <array>

#include "core/names.hpp"

namespace kidnapwatch::core {
namespace {

constexpr std::array<std::string_view, 2> kKinds{"teleport", "carry"};
constexpr std::array<std::string_view, 3> kStates{"open", "acknowledged", "resolved"};
constexpr std::array<std::string_view, 3> kLabels{"kidnapping", "false_alarm", "test"};
constexpr std::array<std::string_view, 6> kTypes{"opened",         "updated",  "acknowledged",
                                                 "unacknowledged", "resolved", "shelved"};

}  // namespace

std::string_view name(IncidentKind kind) { return kKinds.at(static_cast<std::size_t>(kind)); }
std::string_view name(IncidentState state) { return kStates.at(static_cast<std::size_t>(state)); }
std::string_view name(IncidentLabel label) { return kLabels.at(static_cast<std::size_t>(label)); }
std::string_view name(AlertType type) { return kTypes.at(static_cast<std::size_t>(type)); }

IncidentKind incident_kind(std::string_view text, std::string_view field) {
  return named<IncidentKind>(kKinds, text, field);
}

IncidentState incident_state(std::string_view text, std::string_view field) {
  return named<IncidentState>(kStates, text, field);
}

IncidentLabel incident_label(std::string_view text, std::string_view field) {
  return named<IncidentLabel>(kLabels, text, field);
}

}  // namespace kidnapwatch::core
