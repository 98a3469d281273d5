// SPDX-License-Identifier: Apache-2.0
// The names of outcomes.
#include "core/outcome.hpp"

namespace kidnapwatch::core {
namespace {

constexpr std::array<std::string_view, kOutcomes> kNames{
    "scored",       "first",         "not_comparable", "repeated",     "out_of_order",
    "malformed",    "missing_field", "wrong_type",     "no_beams",     "too_many_beams",
    "bad_geometry", "too_large",     "unknown_topic",  "bad_robot_id", "too_many_robots",
    "overload",     "failed"};

}  // namespace

std::string_view name(Outcome outcome) { return kNames.at(static_cast<std::size_t>(outcome)); }

}  // namespace kidnapwatch::core
