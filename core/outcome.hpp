// SPDX-License-Identifier: Apache-2.0
// What became of a scan that was sent: one named reason for each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/bad_input.hpp"

namespace kidnapwatch::core {

/// Where a scan's way through the service ended. Every scan that arrives ends in exactly one.
enum class Outcome : std::uint8_t {
  scored,           ///< compared with the last good scan
  first,            ///< nothing to compare with yet: it became the reference
  not_comparable,   ///< too few valid beams
  repeated,         ///< the stamp of the last scan again
  out_of_order,     ///< older than the last scan
  malformed,        ///< not in any known encoding
  missing_field,    ///< a required field is absent
  wrong_type,       ///< a field of the wrong type
  no_beams,         ///< no ranges
  too_many_beams,   ///< more than kMaxBeams ranges
  bad_geometry,     ///< angles or range limits that describe no lidar
  too_large,        ///< payload above the limit
  unknown_topic,    ///< no scan is expected on this topic
  bad_robot_id,     ///< the topic's robot id is not one
  too_many_robots,  ///< the service's limit of robots is reached
  overload,         ///< pushed out of its robot's full queue by a newer one
  failed,           ///< a fault of our own while it was scored; see the log
};
inline constexpr std::size_t kOutcomes = static_cast<std::size_t>(Outcome::failed) + 1;

/// As in metrics and JSON: "scored", "out_of_order", ...
[[nodiscard]] std::string_view name(Outcome outcome);

/// A count per outcome.
using OutcomeCounts = std::array<std::uint64_t, kOutcomes>;

/// A scan payload that cannot be used, with the outcome to count it under.
class BadScan : public BadInput {
 public:
  BadScan(Outcome outcome, std::string field, const std::string& reason)
      : BadInput(std::move(field), reason), outcome_(outcome) {}

  [[nodiscard]] Outcome outcome() const noexcept { return outcome_; }

 private:
  Outcome outcome_;
};

}  // namespace kidnapwatch::core
