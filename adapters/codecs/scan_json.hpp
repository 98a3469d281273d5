// SPDX-License-Identifier: Apache-2.0
// Scans as rosbridge writes them: sensor_msgs/LaserScan in JSON.
#pragma once

#include <cstdint>
#include <string_view>

#include "adapters/codecs/json_payload.hpp"
#include "core/scan.hpp"

namespace kidnapwatch::adapters::codecs {

/// Replaces `scan` by the one in `text`, reusing its memory, and returns how many ranges were null.
/// Fields that a scan does not have are passed over. Throws BadScan.
std::size_t read_scan_json(JsonPayload& payload, std::string_view text, NullRange null_range,
                           core::Scan& scan);

}  // namespace kidnapwatch::adapters::codecs
