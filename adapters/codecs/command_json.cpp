// SPDX-License-Identifier: Apache-2.0
// The members of each command.
#include "adapters/codecs/command_json.hpp"

#include <algorithm>
#include <array>

#include "adapters/codecs/history_json.hpp"
#include "core/bad_input.hpp"
#include "core/names.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

using core::IncidentAction;

constexpr std::array<std::string_view, 5> kActions{"ack", "unack", "resolve", "shelve", "label"};

/// The actions, in their order, and what only robots are asked.
enum class RobotAction : std::uint8_t { ack, unack, resolve, shelve, label, relocalized, reset };
constexpr std::array<std::string_view, 7> kRobotActions{"ack",   "unack",       "resolve", "shelve",
                                                        "label", "relocalized", "reset"};
constexpr std::size_t kLongestAuthor = 64;  // bytes

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

/// The text member of that name, which is taken off `body`; nothing where there is none.
std::optional<std::string> taken(Json& body, const std::string& member) {
  const auto found = body.find(member);
  if (found == body.end()) return std::nullopt;
  auto text = text_of(*found, member);
  body.erase(member);
  return text;
}

std::string author(Json& body, RobotAction action, const std::string& robot) {
  if (action == RobotAction::relocalized) return "robot:" + robot;
  const auto name = taken(body, "author");
  if (name && (name->empty() || name->size() > kLongestAuthor)) {
    throw core::BadInput("author", "must have from 1 to 64 bytes");
  }
  return name ? "mqtt:" + *name : "mqtt";
}

struct Status {
  int code;
  const char* title;
};

/// By CommandResult; the codes of HTTP that REST would have answered with.
constexpr std::array<Status, core::kCommandResults> kStatuses{{{200, "OK"},
                                                               {400, "Bad Request"},
                                                               {413, "Content Too Large"},
                                                               {404, "Not Found"},
                                                               {404, "Not Found"},
                                                               {409, "Conflict"},
                                                               {400, "Bad Request"},
                                                               {429, "Too Many Requests"},
                                                               {503, "Service Unavailable"},
                                                               {500, "Internal Server Error"}}};

}  // namespace

core::IncidentCommand incident_command(std::string_view action, const Json& body) {
  core::IncidentCommand command;
  command.action = core::named<IncidentAction>(kActions, action, "command");
  if (!body.is_object()) throw core::BadInput("body", "must be an object");
  for (const auto& [member, value] : body.items()) read(member, value, command);
  core::check(command);
  return command;
}

core::RobotCommand robot_command(std::string_view payload, const std::string& robot) {
  Json body = parsed(payload, "payload");
  if (!body.is_object()) throw core::BadInput("payload", "must be an object");
  const auto action =
      core::named<RobotAction>(kRobotActions, taken(body, "command").value_or(""), "command");
  const std::string who = author(body, action, robot);
  core::RobotCommand command;
  if (action == RobotAction::reset) {
    for (const auto& [member, value] : body.items()) {
      throw core::BadInput(member, "is not a member of this command");
    }
    return command;
  }
  command.incident_id = taken(body, "incidentId");
  const bool is_relocalized = action == RobotAction::relocalized;
  const auto name = kRobotActions.at(static_cast<std::size_t>(action));
  command.change = incident_command(is_relocalized ? "resolve" : name, body);
  command.change->author = who;
  return command;
}

std::string answer_message(const std::string& robot, const CommandAnswer& answer) {
  const auto [code, title] = kStatuses.at(static_cast<std::size_t>(answer.result));
  Json message{{"schema", kAnswerSchema},
               {"robotId", robot},
               {"result", core::name(answer.result)},
               {"status", code}};
  if (answer.result != core::CommandResult::done) {
    message.update({{"type", "about:blank"}, {"title", title}, {"detail", answer.detail}});
  }
  if (!answer.field.empty()) message["field"] = answer.field;
  if (answer.incident) message["incident"] = json(*answer.incident);
  return text(message);
}

}  // namespace kidnapwatch::adapters::codecs
