// SPDX-License-Identifier: Apache-2.0
// What goes into the store and comes out of it, where core has no type for it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/incident.hpp"
#include "core/session.hpp"

namespace kidnapwatch::storage {

/// A new or changed incident.
struct IncidentChange {
  core::Incident incident;
  std::optional<core::ScanPair> evidence =
      std::nullopt;  ///< kept from the first change that has it
};

/// A configuration as somebody set it; the text is the caller's.
struct ConfigText {
  std::int64_t version = 0;
  core::Stamp since;
  std::string author;
  std::string text;

  friend bool operator==(const ConfigText&, const ConfigText&) = default;
};

/// Which incidents; nothing set means all.
struct IncidentFilter {
  std::optional<std::string> robot = std::nullopt;
  std::optional<core::IncidentState> state = std::nullopt;
  std::optional<core::IncidentKind> kind = std::nullopt;
  core::Stamp opened_from = core::Stamp::min();
  core::Stamp opened_to = core::Stamp::max();           ///< exclusive
  std::optional<std::string> before_id = std::nullopt;  ///< only older ones than this
  std::size_t limit = 100;
};

/// Where a robot stood when the service stopped.
struct RobotHistory {
  std::string robot;
  core::Stamp last_arrival;  ///< of the latest score, by the service's clock
  core::Score latest;
  std::vector<double> natural_scores;  ///< costs while normal or unknown, oldest first
};

}  // namespace kidnapwatch::storage
