// SPDX-License-Identifier: Apache-2.0
// The members of each command.
#include "adapters/codecs/command_json.hpp"

#include <array>

#include "core/bad_input.hpp"
#include "core/names.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

using core::IncidentAction;

constexpr std::array<std::string_view, 5> kActions{"ack", "unack", "resolve", "shelve", "label"};

std::string text_of(const Json& value, const std::string& member) {
  if (!value.is_string()) throw core::BadInput(member, "must be a text");
  return value.get<std::string>();
}

void read(const std::string& member, const Json& value, core::IncidentCommand& command) {
  if (member == "comment") {
    command.comment = text_of(value, member);
  } else if (member == "seconds" && command.action == IncidentAction::shelve) {
    if (!value.is_number()) throw core::BadInput(member, "must be a number");
    command.shelve_for_s = value.get<double>();
  } else if (member == "label" && command.action == IncidentAction::label) {
    command.label = core::incident_label(text_of(value, member), member);
  } else {
    throw core::BadInput(member, "is not a member of this command");
  }
}

}  // namespace

core::IncidentCommand incident_command(std::string_view action, const Json& body) {
  core::IncidentCommand command;
  command.action = core::named<IncidentAction>(kActions, action, "command");
  if (!body.is_object()) throw core::BadInput("body", "must be an object");
  for (const auto& [member, value] : body.items()) read(member, value, command);
  core::check(command);
  return command;
}

}  // namespace kidnapwatch::adapters::codecs
