// SPDX-License-Identifier: Apache-2.0
// nav_msgs/Odometry and its short form.
#include "adapters/codecs/odometry_json.hpp"

#include <cmath>

#include "adapters/codecs/json_payload.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

/// geometry_msgs/Quaternion
struct Quaternion {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double w = 0.0;
};

[[nodiscard]] Quaternion quaternion(ondemand::value value) {
  Quaternion q;
  for (auto entry : object(value, "pose.pose.orientation")) {
    const std::string_view key = entry.unescaped_key();
    if (key.size() == 1 && key[0] >= 'w' && key[0] <= 'z') {
      double& part = key == "x" ? q.x : key == "y" ? q.y : key == "z" ? q.z : q.w;
      part = number(entry.value(), "pose.pose.orientation");
    }
  }
  return q;
}

/// The turn about the vertical, whatever the length of `q`. Throws BadScan if it has none: nobody
/// set it.
[[nodiscard]] double yaw_rad(const Quaternion& q) {
  const double norm = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (!std::isfinite(norm) || norm < 1e-6) {
    throw_wrong_type("pose.pose.orientation", "a rotation");
  }
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z);
}

/// One message; the fields of both forms, in any order.
class OdometryReader {
 public:
  void read(ondemand::object& message) {
    for (auto entry : message) {
      const std::string_view key = entry.unescaped_key();
      read_field(key, entry.value());
    }
  }

  [[nodiscard]] StampedPose odometry() const {
    if (!stamp_) {
      throw_missing("stamp");
    }
    return {*stamp_, pose_.pose("")};
  }

 private:
  void read_field(std::string_view key, ondemand::value value) {
    if (key == "header") {
      stamp_ = header_stamp(value);
    } else if (key == "stamp") {
      stamp_ = any_stamp(value);
    } else if (key == "pose") {
      read_pose_with_covariance(value);
    } else if (double* place = pose_.number(key)) {
      *place = number(value, key);
    }
  }

  [[nodiscard]] static core::Stamp any_stamp(ondemand::value value) {
    if (value.type() == ondemand::json_type::object) {
      return stamp(value, "stamp");
    }
    const double seconds = number(value, "stamp");
    if (!(std::abs(seconds) < 4e9)) {
      throw_wrong_type("stamp", "a time in seconds since 1970");
    }
    const double whole = std::floor(seconds);  // apart: a double has no room for 1.7e18 ns
    return core::later_by_s(core::Stamp{std::chrono::seconds{static_cast<std::int64_t>(whole)}},
                            seconds - whole);
  }

  void read_pose_with_covariance(ondemand::value value) {
    for (auto entry : object(value, "pose")) {
      const std::string_view key = entry.unescaped_key();
      if (key == "pose") {
        read_pose(entry.value());
      }
    }
  }

  void read_pose(ondemand::value value) {
    for (auto entry : object(value, "pose.pose")) {
      const std::string_view key = entry.unescaped_key();
      if (key == "position") {
        read_position(entry.value());
      } else if (key == "orientation") {
        *pose_.number("theta") = yaw_rad(quaternion(entry.value()));
      }
    }
  }

  void read_position(ondemand::value value) {
    for (auto entry : object(value, "pose.pose.position")) {
      const std::string_view key = entry.unescaped_key();
      if (key == "x" || key == "y") {
        *pose_.number(key) = number(entry.value(), "pose.pose.position");
      }
    }
  }

  std::optional<core::Stamp> stamp_;
  PoseFields pose_;
};

}  // namespace

struct OdometryDecoder::Json {
  JsonPayload payload;
};

OdometryDecoder::OdometryDecoder() : json_(std::make_unique<Json>()) {}
OdometryDecoder::~OdometryDecoder() = default;
OdometryDecoder::OdometryDecoder(OdometryDecoder&&) noexcept = default;
OdometryDecoder& OdometryDecoder::operator=(OdometryDecoder&&) noexcept = default;

StampedPose OdometryDecoder::decode(std::string_view payload) {
  StampedPose odometry;
  json_->payload.read(payload, [&](ondemand::object& message) {
    OdometryReader reader;
    reader.read(message);
    odometry = reader.odometry();
  });
  return odometry;
}

}  // namespace kidnapwatch::adapters::codecs
