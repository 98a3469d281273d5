// SPDX-License-Identifier: Apache-2.0
// The names of a command's results.
#include "core/robot_command.hpp"

namespace kidnapwatch::core {
namespace {

constexpr std::array<std::string_view, kCommandResults> kNames{
    "done",        "malformed", "too_large", "unknown_robot", "no_incident",
    "not_allowed", "retained",  "overload",  "unavailable",   "failed"};

}  // namespace

std::string_view name(CommandResult result) { return kNames.at(static_cast<std::size_t>(result)); }

}  // namespace kidnapwatch::core
