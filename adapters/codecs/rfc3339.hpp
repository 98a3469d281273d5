// SPDX-License-Identifier: Apache-2.0
// Points in time as text: RFC 3339, in UTC, to the nanosecond.
#pragma once

#include <string>
#include <string_view>

#include "core/stamp.hpp"

namespace kidnapwatch::adapters::codecs {

/// "2026-01-31T12:00:00.000000001Z": always nine digits, so that no stamp loses its identity and
/// the order of texts is the order of times.
[[nodiscard]] std::string rfc3339(core::Stamp stamp);

/// The inverse, for any RFC 3339 date-time of the years 1678 to 2261: none to nine digits of a
/// second, any offset from UTC, no leap second. Throws BadInput naming `field`.
[[nodiscard]] core::Stamp stamp_from_rfc3339(std::string_view text, const std::string& field);

}  // namespace kidnapwatch::adapters::codecs
