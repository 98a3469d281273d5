// SPDX-License-Identifier: Apache-2.0
// Names and sentences.
#include "core/cause.hpp"

#include <array>

#include "core/names.hpp"

namespace kidnapwatch::core {
namespace {

constexpr std::array<std::string_view, 4> kCauses{"teleport", "carry", "displaced", "slip"};
constexpr std::array<std::string_view, 4> kTroubles{"blind", "odometry", "noise", "crowd"};

}  // namespace

std::string_view name(Cause cause) { return kCauses.at(static_cast<std::size_t>(cause)); }
std::string_view name(Trouble trouble) { return kTroubles.at(static_cast<std::size_t>(trouble)); }

std::string_view sentence(Cause cause) {
  static constexpr std::array<std::string_view, kCauses.size()> sentences{
      "Nothing the lidar sees matches what it saw before.",
      "Scan by scan the surroundings move on, but not as the wheels turn.",
      "The surroundings are the same, but not where the robot drove.",
      "The walls are where they were, but the wheels say it moved."};
  return sentences.at(static_cast<std::size_t>(cause));
}

std::string_view sentence(Trouble trouble) {
  static constexpr std::array<std::string_view, kTroubles.size()> sentences{
      "The lidar sees too little to tell where the robot moves.",
      "The wheels keep telling other motions than the walls.",
      "One scan hardly fits the next, wherever it is laid.",
      "So much moves around the robot that little else is seen."};
  return sentences.at(static_cast<std::size_t>(trouble));
}

Cause cause(std::string_view text, std::string_view field) {
  return named<Cause>(kCauses, text, field);
}

}  // namespace kidnapwatch::core
