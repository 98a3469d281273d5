// SPDX-License-Identifier: Apache-2.0
// The fields of a scan message, whatever its encoding: their one spelling, and what must be there.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/outcome.hpp"
#include "core/scan.hpp"

namespace kidnapwatch::adapters::codecs {

/// What a null among the ranges stands for: rosbridge writes both inf and NaN as null.
enum class NullRange : std::uint8_t {
  no_return,  ///< +inf, nothing in range (REP-117)
  invalid,    ///< NaN
};

/// In metres, as REP-117 has it.
[[nodiscard]] float null_range_m(NullRange meaning);

/// `value` as a float; beyond a float's reach it is infinite.
[[nodiscard]] float to_float(double value);

/// A stamp as ROS 1 (secs, nsecs) or ROS 2 (sec, nanosec) spells it.
class StampFields {
 public:
  /// False if `key` is none of the four. Throws BadScan for a value that is no such number.
  bool set(std::string_view key, std::int64_t value);
  /// Whether `key` is one of the four.
  [[nodiscard]] static bool knows(std::string_view key);
  /// Throws BadScan if a part is missing.
  [[nodiscard]] core::Stamp stamp() const;

 private:
  std::optional<std::int64_t> sec_;
  std::optional<std::int64_t> nanosec_;
};

/// A pose in the plane as {x, y, theta}.
class PoseFields {
 public:
  /// Where the number called `key` belongs; null for any other key.
  [[nodiscard]] double* number(std::string_view key);
  [[nodiscard]] bool empty() const noexcept { return seen_ == 0; }
  /// Throws BadScan, naming `field`, if a number is missing or not finite.
  [[nodiscard]] core::Pose pose(std::string_view field) const;

 private:
  core::Pose pose_;
  unsigned seen_ = 0;
};

/// Fills one scan, in any order of fields; of a repeated field the last one counts.
class ScanFields {
 public:
  /// Empties `scan`, keeping its memory.
  explicit ScanFields(core::Scan& scan);

  /// Where the number called `key` belongs; null for any other key.
  [[nodiscard]] double* number(std::string_view key);
  void set_stamp(core::Stamp stamp);
  void set_odometry(std::optional<core::Pose> pose) { scan_.odometry = pose; }
  /// The ranges, empty, to be filled.
  [[nodiscard]] std::vector<float>& begin_ranges();
  /// Throws BadScan for a required field that is missing, or a scan that fails core::check.
  void finish() const;

 private:
  core::Scan& scan_;
  unsigned seen_ = 0;
};

[[noreturn]] void throw_malformed(std::string_view field, std::string_view reason);
[[noreturn]] void throw_wrong_type(std::string_view field, std::string_view expected);
[[noreturn]] void throw_missing(std::string_view field);
[[noreturn]] void throw_too_many_beams();

}  // namespace kidnapwatch::adapters::codecs
