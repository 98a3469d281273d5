// SPDX-License-Identifier: Apache-2.0
// The transitions.
#include "core/incident_command.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/bad_input.hpp"

namespace kidnapwatch::core {
namespace {

using Changed = std::optional<AlertType>;  // nothing: not in this state

Changed ack(Incident& incident, const IncidentCommand& command) {
  if (incident.state == IncidentState::resolved) return std::nullopt;
  if (incident.state == IncidentState::open) incident.acknowledged_by = command.author;
  incident.state = IncidentState::acknowledged;
  return AlertType::acknowledged;
}

Changed unack(Incident& incident) {
  if (incident.state == IncidentState::resolved) return std::nullopt;
  incident.state = IncidentState::open;
  incident.acknowledged_by.clear();
  return AlertType::unacknowledged;
}

Changed resolve(Incident& incident, const IncidentCommand& command, Stamp now) {
  if (incident.state != IncidentState::resolved) {
    incident.state = IncidentState::resolved;
    incident.resolved_at = now;
    incident.resolved_by = command.author;
    incident.shelved_until.reset();
  }
  return AlertType::resolved;
}

Changed shelve(Incident& incident, const IncidentCommand& command, Stamp now) {
  if (incident.state == IncidentState::resolved) return std::nullopt;
  const bool ends = *command.shelve_for_s == 0.0;
  incident.shelved_until =
      ends ? std::nullopt : std::optional(later_by_s(now, *command.shelve_for_s));
  return ends ? AlertType::updated : AlertType::shelved;
}

Changed apply(Incident& incident, const IncidentCommand& command, Stamp now) {
  switch (command.action) {
    case IncidentAction::ack:
      return ack(incident, command);
    case IncidentAction::unack:
      return unack(incident);
    case IncidentAction::resolve:
      return resolve(incident, command, now);
    case IncidentAction::shelve:
      return shelve(incident, command, now);
    case IncidentAction::label:
      break;
  }
  incident.label = command.label;
  return AlertType::updated;
}

/// Code points of UTF-8: all bytes but those that continue one.
std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

void check(const IncidentCommand& command) {
  if (command.action == IncidentAction::shelve) {
    const double seconds = command.shelve_for_s.value_or(-1.0);
    if (!(seconds >= 0.0 && seconds <= kLongestShelving_s)) {
      throw BadInput("seconds", "must be from 0 to 604800; 0 ends the shelving");
    }
  }
  if (command.action == IncidentAction::label && !command.label) {
    throw BadInput("label", "must be one of kidnapping, false_alarm, test");
  }
  if (command.comment && characters(*command.comment) > kLongestComment) {
    throw BadInput("comment", "must have at most 2000 characters");
  }
}

std::optional<ChangedIncident> changed(const Incident& incident, const IncidentCommand& command,
                                       Stamp now) {
  ChangedIncident result{AlertType::updated, incident};
  const auto type = apply(result.incident, command, now);
  if (!type) return std::nullopt;
  result.type = *type;
  if (command.comment) result.incident.comment = *command.comment;
  if (result.incident != incident) ++result.incident.seq;
  return result;
}

}  // namespace kidnapwatch::core
