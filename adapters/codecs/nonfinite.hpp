// SPDX-License-Identifier: Apache-2.0
// NaN and infinities in text that calls itself JSON, as Python, C++ and protobuf write them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace kidnapwatch::adapters::codecs {

/// The value of "nan", "inf" or "infinity" in any case, with or without a sign; nothing for any
/// other text.
[[nodiscard]] std::optional<double> nonfinite(std::string_view text);

/// Replaces `out` by `text` with every bare non-finite number put in quotes, as proto3 JSON spells
/// it. False if there was none. Never fails, whatever the text.
bool quote_nonfinite(std::string_view text, std::string& out);

}  // namespace kidnapwatch::adapters::codecs
