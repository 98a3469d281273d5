// SPDX-License-Identifier: Apache-2.0
// Points in time as values: core never reads a clock.
#pragma once

#include <chrono>
#include <cstdint>

namespace kidnapwatch::core {

/// A point in UTC, to the nanosecond, as builtin_interfaces/Time counts it.
using Stamp = std::chrono::sys_time<std::chrono::nanoseconds>;

[[nodiscard]] constexpr Stamp stamp_from_ns(std::int64_t since_epoch_ns) {
  return Stamp{std::chrono::nanoseconds{since_epoch_ns}};
}

[[nodiscard]] constexpr std::int64_t ns_since_epoch(Stamp stamp) {
  return stamp.time_since_epoch().count();
}

/// Seconds from `from` to `to`; negative if `to` is earlier.
[[nodiscard]] constexpr double elapsed_s(Stamp from, Stamp to) {
  return std::chrono::duration<double>(to - from).count();
}

/// `stamp` moved by `seconds`, rounded towards zero to the nanosecond.
[[nodiscard]] constexpr Stamp later_by_s(Stamp stamp, double seconds) {
  return stamp + std::chrono::duration_cast<std::chrono::nanoseconds>(
                     std::chrono::duration<double>(seconds));
}

}  // namespace kidnapwatch::core
