// SPDX-License-Identifier: Apache-2.0
// Scans into JSON, with the shortest digits that read back as the same number, and into CBOR.
#include "adapters/codecs/scan_encode.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <chrono>
#include <cmath>
#include <span>
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

constexpr unsigned kFloat64 = 0xFB;
constexpr unsigned kFloat32LittleEndian = 85;  // RFC 8746

enum Major : unsigned { kUint = 0, kNint = 1, kBytes = 2, kText = 3, kMap = 5, kTag = 6 };

void append_big_endian(std::string& out, std::uint64_t value, int bytes) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) {
    out.push_back(static_cast<char>(value >> static_cast<unsigned>(shift) & 0xFFU));
  }
}

/// RFC 8949, section 3: a type and its argument, as short as can be, up to 32 bits.
void append_head(std::string& out, Major major, std::uint64_t argument) {
  const auto append = [&](unsigned info, int bytes) {
    out.push_back(static_cast<char>(major << 5U | info));
    append_big_endian(out, argument, bytes);
  };
  if (argument < 24) {
    append(static_cast<unsigned>(argument), 0);
  } else if (argument <= 0xFF) {
    append(24, 1);
  } else if (argument <= 0xFFFF) {
    append(25, 2);
  } else {
    append(26, 4);
  }
}

void append_key(std::string& out, std::string_view key) {
  append_head(out, kText, key.size());
  out.append(key);
}

void append_cbor_field(std::string& out, std::string_view key, std::int64_t value) {
  append_key(out, key);
  append_head(out, value < 0 ? kNint : kUint,
              static_cast<std::uint64_t>(value < 0 ? -1 - value : value));
}

void append_cbor_field(std::string& out, std::string_view key, double value) {
  append_key(out, key);
  out.push_back(static_cast<char>(kFloat64));
  append_big_endian(out, std::bit_cast<std::uint64_t>(value), 8);
}

void append_cbor_header(std::string& out, core::Stamp stamp) {
  append_key(out, "header");
  append_head(out, kMap, 1);
  append_key(out, "stamp");
  append_head(out, kMap, 2);
  const auto sec = std::chrono::floor<std::chrono::seconds>(stamp);
  append_cbor_field(out, "sec", std::int64_t{sec.time_since_epoch().count()});
  append_cbor_field(out, "nanosec", std::int64_t{(stamp - sec).count()});
}

void append_cbor_ranges(std::string& out, const std::vector<float>& ranges_m) {
  static_assert(std::endian::native == std::endian::little);
  append_key(out, "ranges");
  append_head(out, kTag, kFloat32LittleEndian);
  append_head(out, kBytes, ranges_m.size() * sizeof(float));
  const auto bytes = std::as_bytes(std::span(ranges_m));
  out.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

void append_cbor_odometry(std::string& out, const core::Pose& pose) {
  append_key(out, "odom");
  append_head(out, kMap, 3);
  append_cbor_field(out, "x", pose.x_m);
  append_cbor_field(out, "y", pose.y_m);
  append_cbor_field(out, "theta", pose.theta_rad);
}

}  // namespace

void append_cbor(std::string& out, const core::Scan& scan) {
  append_head(out, kMap, scan.odometry ? 7 : 6);
  append_cbor_header(out, scan.stamp);
  append_cbor_field(out, "angle_min", scan.geometry.angle_min_rad);
  append_cbor_field(out, "angle_increment", scan.geometry.angle_increment_rad);
  append_cbor_field(out, "range_min", scan.geometry.range_min_m);
  append_cbor_field(out, "range_max", scan.geometry.range_max_m);
  append_cbor_ranges(out, scan.ranges_m);
  if (scan.odometry) {
    append_cbor_odometry(out, *scan.odometry);
  }
}

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
