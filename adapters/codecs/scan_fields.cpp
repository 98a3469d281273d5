// SPDX-License-Identifier: Apache-2.0
// The fields of a scan message: sensor_msgs/LaserScan, with the robot's odometry beside it.
#include "adapters/codecs/scan_fields.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>

namespace kidnapwatch::adapters::codecs {
namespace {

using core::BadScan;
using core::Outcome;

// The required fields, in the order in which a missing one is reported; bit i of `seen_` each.
constexpr std::array<std::string_view, 6> kScanFields = {
    "header.stamp", "ranges", "angle_min", "angle_increment", "range_min", "range_max"};
constexpr unsigned kStamp = 0;
constexpr unsigned kRanges = 1;
constexpr std::array<std::string_view, 3> kPoseFields = {"x", "y", "theta"};

constexpr std::int64_t kMinSec = std::numeric_limits<std::int32_t>::min();   // ROS 2: int32
constexpr std::int64_t kMaxSec = std::numeric_limits<std::uint32_t>::max();  // ROS 1: uint32
constexpr std::int64_t kNanosPerSec = 1'000'000'000;

template <std::size_t n>
[[nodiscard]] std::size_t index_of(const std::array<std::string_view, n>& fields,
                                   std::string_view key) {
  std::size_t i = 0;
  while (i < n && fields[i] != key) {
    ++i;
  }
  return i;
}

template <std::size_t n>
void require_all(const std::array<std::string_view, n>& fields, unsigned seen,
                 std::string_view parent) {
  for (std::size_t i = 0; i < n; ++i) {
    if ((seen >> i & 1U) == 0) {
      throw_missing(std::string(parent).append(fields[i]));
    }
  }
}

[[nodiscard]] bool is_sec(std::string_view key) { return key == "secs" || key == "sec"; }
[[nodiscard]] bool is_nanosec(std::string_view key) { return key == "nsecs" || key == "nanosec"; }

}  // namespace

float null_range_m(NullRange meaning) {
  return meaning == NullRange::invalid ? std::numeric_limits<float>::quiet_NaN()
                                       : std::numeric_limits<float>::infinity();
}

float to_float(double value) {
  constexpr double kMax = std::numeric_limits<float>::max();
  if (std::abs(value) > kMax) {  // the cast alone would be undefined
    return std::copysign(std::numeric_limits<float>::infinity(), value < 0.0 ? -1.0F : 1.0F);
  }
  return static_cast<float>(value);
}

bool StampFields::knows(std::string_view key) { return is_sec(key) || is_nanosec(key); }

bool StampFields::set(std::string_view key, std::int64_t value) {
  if (is_sec(key)) {
    if (value < kMinSec || value > kMaxSec) {
      throw_wrong_type("header.stamp.sec", "a number of 32 bits");
    }
    sec_ = value;
    return true;
  }
  if (is_nanosec(key)) {
    if (value < 0 || value >= kNanosPerSec) {
      throw_wrong_type("header.stamp.nanosec", "a number from 0 to 999999999");
    }
    nanosec_ = value;
    return true;
  }
  return false;
}

core::Stamp StampFields::stamp() const {
  if (!sec_) {
    throw_missing("header.stamp.sec");
  }
  if (!nanosec_) {
    throw_missing("header.stamp.nanosec");
  }
  return core::Stamp{std::chrono::seconds{*sec_} + std::chrono::nanoseconds{*nanosec_}};
}

double* PoseFields::number(std::string_view key) {
  const std::array<double*, 3> places = {&pose_.x_m, &pose_.y_m, &pose_.theta_rad};
  const std::size_t i = index_of(kPoseFields, key);
  if (i == places.size()) {
    return nullptr;
  }
  seen_ |= 1U << i;
  return places[i];
}

core::Pose PoseFields::pose(std::string_view field) const {
  require_all(kPoseFields, seen_, field.empty() ? "" : std::string(field) + ".");
  if (!std::isfinite(pose_.x_m) || !std::isfinite(pose_.y_m) || !std::isfinite(pose_.theta_rad)) {
    throw_wrong_type(field, "finite numbers");
  }
  return pose_;
}

ScanFields::ScanFields(core::Scan& scan) : scan_(scan) {
  scan_.stamp = {};
  scan_.geometry = {};
  scan_.ranges_m.clear();
  scan_.odometry.reset();
}

double* ScanFields::number(std::string_view key) {
  core::ScanGeometry& geometry = scan_.geometry;
  const std::array<double*, kScanFields.size()> places = {nullptr,
                                                          nullptr,
                                                          &geometry.angle_min_rad,
                                                          &geometry.angle_increment_rad,
                                                          &geometry.range_min_m,
                                                          &geometry.range_max_m};
  const std::size_t i = index_of(kScanFields, key);
  if (i == places.size() || places[i] == nullptr) {
    return nullptr;
  }
  seen_ |= 1U << i;
  return places[i];
}

void ScanFields::set_stamp(core::Stamp stamp) {
  scan_.stamp = stamp;
  seen_ |= 1U << kStamp;
}

std::vector<float>& ScanFields::begin_ranges() {
  seen_ |= 1U << kRanges;
  scan_.ranges_m.clear();
  return scan_.ranges_m;
}

void ScanFields::finish() const {
  require_all(kScanFields, seen_, "");
  core::check(scan_);
}

void throw_malformed(std::string_view field, std::string_view reason) {
  throw BadScan(Outcome::malformed, std::string(field), std::string(reason));
}

void throw_wrong_type(std::string_view field, std::string_view expected) {
  throw BadScan(Outcome::wrong_type, std::string(field), "is not " + std::string(expected));
}

void throw_missing(std::string_view field) {
  throw BadScan(Outcome::missing_field, std::string(field), "is missing");
}

void throw_too_many_beams() {
  throw BadScan(Outcome::too_many_beams, "ranges",
                "has more than " + std::to_string(core::kMaxBeams) + " beams");
}

}  // namespace kidnapwatch::adapters::codecs
