// SPDX-License-Identifier: Apache-2.0
// The names of an incident's states and alerts.
#include "core/incident.hpp"

#include <array>

#include "core/names.hpp"

namespace kidnapwatch::core {
namespace {

constexpr std::array<std::string_view, 3> kStates{"open", "acknowledged", "resolved"};
constexpr std::array<std::string_view, 6> kTypes{"opened",         "updated",  "acknowledged",
                                                 "unacknowledged", "resolved", "shelved"};

}  // namespace

std::string_view name(IncidentState state) { return kStates.at(static_cast<std::size_t>(state)); }
std::string_view name(AlertType type) { return kTypes.at(static_cast<std::size_t>(type)); }

IncidentKind incident_kind(std::string_view text, std::string_view field) {
  return cause(text, field);
}

IncidentState incident_state(std::string_view text, std::string_view field) {
  return named<IncidentState>(kStates, text, field);
}

}  // namespace kidnapwatch::core
