// SPDX-License-Identifier: Apache-2.0
// Names of robots and of their states.
#include "core/robot.hpp"

#include <algorithm>
#include <array>

#include "core/names.hpp"

namespace kidnapwatch::core {
namespace {

constexpr std::array<std::string_view, 6> kStates{"unknown",   "normal",   "suspect",
                                                  "kidnapped", "degraded", "stale"};

constexpr bool may_name_a_robot(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '.' || c == ':' || c == '-';
}

}  // namespace

std::string_view name(RobotState state) { return kStates.at(static_cast<std::size_t>(state)); }

RobotState robot_state(std::string_view text, std::string_view field) {
  return named<RobotState>(kStates, text, field);
}

bool is_robot_id(std::string_view text) {
  return !text.empty() && text.size() <= 64 && std::ranges::all_of(text, may_name_a_robot);
}

}  // namespace kidnapwatch::core
