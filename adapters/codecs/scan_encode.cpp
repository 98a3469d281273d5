// SPDX-License-Identifier: Apache-2.0
// Scans into JSON: the shortest digits that read back as the same number.
#include "adapters/codecs/scan_encode.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <string_view>

namespace kidnapwatch::adapters::codecs {
namespace {

template <class Number>
void append_number(std::string& out, Number number) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  out.append(digits.data(), end);
}

template <class Number>
void append_field(std::string& out, std::string_view start, Number number) {
  out.append(start);
  append_number(out, number);
}

[[nodiscard]] std::string_view bare_name(float range_m) {
  if (std::isnan(range_m)) {
    return "NaN";
  }
  return range_m > 0.0F ? "Infinity" : "-Infinity";
}

void append_range(std::string& out, float range_m, NonFinite non_finite) {
  if (std::isfinite(range_m)) {
    append_number(out, range_m);
  } else {
    out.append(non_finite == NonFinite::null ? "null" : bare_name(range_m));
  }
}

void append_header(std::string& out, core::Stamp stamp) {
  const auto sec = std::chrono::floor<std::chrono::seconds>(stamp);
  append_field(out, R"({"header":{"stamp":{"sec":)", sec.time_since_epoch().count());
  append_field(out, R"(,"nanosec":)", (stamp - sec).count());
  out.append(R"(},"frame_id":"laser"})");
}

void append_geometry(std::string& out, const core::Scan& scan) {
  const core::ScanGeometry& geometry = scan.geometry;
  const auto last_beam = static_cast<double>(scan.ranges_m.size()) - 1.0;
  append_field(out, R"(,"angle_min":)", geometry.angle_min_rad);
  append_field(out, R"(,"angle_max":)",
               geometry.angle_min_rad + last_beam * geometry.angle_increment_rad);
  append_field(out, R"(,"angle_increment":)", geometry.angle_increment_rad);
  append_field(out, R"(,"range_min":)", geometry.range_min_m);
  append_field(out, R"(,"range_max":)", geometry.range_max_m);
}

void append_ranges(std::string& out, const std::vector<float>& ranges_m, NonFinite non_finite) {
  out.append(R"(,"ranges":[)");
  std::string_view separator;
  for (const float range_m : ranges_m) {
    out.append(separator);
    append_range(out, range_m, non_finite);
    separator = ",";
  }
  out.push_back(']');
}

void append_odometry(std::string& out, const core::Pose& pose) {
  append_field(out, R"(,"odom":{"x":)", pose.x_m);
  append_field(out, R"(,"y":)", pose.y_m);
  append_field(out, R"(,"theta":)", pose.theta_rad);
  out.push_back('}');
}

}  // namespace

void append_json(std::string& out, const core::Scan& scan, NonFinite non_finite) {
  append_header(out, scan.stamp);
  append_geometry(out, scan);
  append_ranges(out, scan.ranges_m, non_finite);
  if (scan.odometry) {
    append_odometry(out, *scan.odometry);
  }
  out.push_back('}');
}

}  // namespace kidnapwatch::adapters::codecs
