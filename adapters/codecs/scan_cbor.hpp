// SPDX-License-Identifier: Apache-2.0
// Scans in CBOR: the fields of sensor_msgs/LaserScan, ranges as an array or a typed array.
#pragma once

#include <cstddef>
#include <string_view>

#include "adapters/codecs/scan_fields.hpp"
#include "core/scan.hpp"

namespace kidnapwatch::adapters::codecs {

/// Replaces `scan` by the one in `bytes`, reusing its memory, and returns how many ranges were
/// null. Typed arrays (RFC 8746) of floats of 16, 32 and 64 bits are understood, in both byte
/// orders. Fields that a scan does not have are passed over. Throws BadScan.
std::size_t read_scan_cbor(std::string_view bytes, NullRange null_range, core::Scan& scan);

}  // namespace kidnapwatch::adapters::codecs
