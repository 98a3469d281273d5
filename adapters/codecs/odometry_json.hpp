// SPDX-License-Identifier: Apache-2.0
// Where a robot believes to be, sent beside its scans.
#pragma once

#include <memory>
#include <string_view>

#include "core/pose.hpp"
#include "core/stamp.hpp"

namespace kidnapwatch::adapters::codecs {

struct StampedPose {
  core::Stamp stamp;
  core::Pose pose;  ///< T_odom_base

  friend bool operator==(const StampedPose&, const StampedPose&) = default;
};

/// Reads odometry in JSON: nav_msgs/Odometry, of which only the pose in the plane counts, or
/// {stamp, x, y, theta}, where `stamp` is {sec, nanosec} or the seconds since 1970 as a number. For
/// one thread; allocates nothing once it is warm.
class OdometryDecoder {
 public:
  OdometryDecoder();
  ~OdometryDecoder();
  OdometryDecoder(OdometryDecoder&&) noexcept;
  OdometryDecoder& operator=(OdometryDecoder&&) noexcept;

  /// Throws BadScan, as scans do, for whatever cannot be used.
  [[nodiscard]] StampedPose decode(std::string_view payload);

 private:
  struct Json;  // keeps simdjson out of this header
  std::unique_ptr<Json> json_;
};

}  // namespace kidnapwatch::adapters::codecs
