// SPDX-License-Identifier: Apache-2.0
// Scans to send through the codecs: pictured ones, arbitrary ones, and ways to be wrong.
#pragma once

#include <bit>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "adapters/codecs/scan_payload.hpp"
#include "core/scan.hpp"

namespace kidnapwatch::adapters::codecs {

inline constexpr float kInf = std::numeric_limits<float>::infinity();
inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

inline core::Scan some_scan(std::vector<float> ranges_m) {
  core::Scan scan;
  scan.stamp = core::stamp_from_ns(1'700'000'000'123'456'789);
  scan.geometry = {
      .angle_min_rad = -1.5, .angle_increment_rad = 0.01, .range_min_m = 0.05, .range_max_m = 12.0};
  scan.ranges_m = std::move(ranges_m);
  return scan;
}

/// Any scan that passes core::check: all bit patterns of ranges, with and without odometry.
inline core::Scan arbitrary_scan() {
  const auto within = [](double low, double high) {
    return low + (high - low) * *rc::gen::inRange(0, 1'000'001) * 1e-6;
  };
  core::Scan scan;
  const auto patterns = *rc::gen::nonEmpty<std::vector<std::uint32_t>>();
  for (const std::uint32_t pattern : patterns) {
    scan.ranges_m.push_back(std::bit_cast<float>(pattern));
  }
  const auto sec = *rc::gen::inRange<std::int64_t>(-2'147'483'648, 4'294'967'296);
  const auto nanosec = *rc::gen::inRange<std::int64_t>(0, 1'000'000'000);
  scan.stamp = core::Stamp{std::chrono::seconds{sec} + std::chrono::nanoseconds{nanosec}};
  const double turn_rad = 2.0 * std::numbers::pi / static_cast<double>(scan.ranges_m.size());
  scan.geometry.angle_min_rad = within(-10.0, 10.0);
  scan.geometry.angle_increment_rad = turn_rad * within(0.001, 1.0) * *rc::gen::element(1.0, -1.0);
  scan.geometry.range_min_m = within(0.0, 1.0);
  scan.geometry.range_max_m = scan.geometry.range_min_m + within(0.001, 100.0);
  if (*rc::gen::arbitrary<bool>()) {
    scan.odometry = core::Pose{within(-1e6, 1e6), within(-1.0, 1.0), within(-3.0, 3.0)};
  }
  return scan;
}

/// Equal to the bit, except that one NaN is as good as another.
inline bool same_ranges(const std::vector<float>& a, const std::vector<float>& b) {
  return std::ranges::equal(a, b, [](float x, float y) {
    return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y) || (x != x && y != y);
  });
}

inline bool same(const core::Scan& a, const core::Scan& b) {
  return a.stamp == b.stamp && a.geometry == b.geometry && a.odometry == b.odometry &&
         same_ranges(a.ranges_m, b.ranges_m);
}

inline core::Scan decoded(std::string_view payload, std::string_view content_type = "",
                          const ScanPayloadConfig& config = {}) {
  ScanDecoder decoder(config);
  core::Scan scan;
  decoder.decode(payload, content_type, scan);
  return scan;
}

/// "outcome field: reason" of the BadScan that decoding throws; "decoded" if it throws none.
inline std::string refusal(std::string_view payload, std::string_view content_type = "",
                           const ScanPayloadConfig& config = {}) {
  try {
    (void)decoded(payload, content_type, config);
    return "decoded";
  } catch (const core::BadScan& bad) {
    return std::string(core::name(bad.outcome())) + " " + bad.what();
  }
}

/// `text` with the first `from` replaced.
inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// Some bytes changed, cut, doubled or moved: what a faulty sender makes of a good payload.
inline std::string mutated(std::string payload) {
  for (int n = *rc::gen::inRange(1, 8); n > 0 && !payload.empty(); --n) {
    const auto at = *rc::gen::inRange<std::size_t>(0, payload.size());
    switch (*rc::gen::inRange(0, 4)) {
      case 0:
        payload[at] = static_cast<char>(*rc::gen::arbitrary<std::uint8_t>());
        break;
      case 1:
        payload.resize(at);
        break;
      case 2:
        payload.insert(at, payload.substr(at / 2, 16));
        break;
      default:
        payload.erase(at, *rc::gen::inRange<std::size_t>(1, 16));
        break;
    }
  }
  return payload;
}

}  // namespace kidnapwatch::adapters::codecs
