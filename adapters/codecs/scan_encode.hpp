// SPDX-License-Identifier: Apache-2.0
// Scans into payloads, as robots send them.
#pragma once

#include <cstdint>
#include <string>

#include "core/scan.hpp"

namespace kidnapwatch::adapters::codecs {

/// How a range that is inf or NaN is written in JSON.
enum class NonFinite : std::uint8_t {
  null,  ///< as rosbridge does: valid JSON, but inf and NaN become the same
  bare,  ///< NaN, Infinity, -Infinity as Python does: not JSON, but nothing is lost
};

/// Appends sensor_msgs/LaserScan in JSON, with `odom` beside it if the scan has odometry. Every
/// finite number reads back as it was.
void append_json(std::string& out, const core::Scan& scan, NonFinite non_finite = NonFinite::null);

/// Appends the same fields in CBOR, the ranges as a typed array (RFC 8746, tag 85). Every number,
/// NaN and infinities included, reads back as it was.
void append_cbor(std::string& out, const core::Scan& scan);

}  // namespace kidnapwatch::adapters::codecs
