// SPDX-License-Identifier: Apache-2.0
// JSON as this project reads and writes it: strict in, never surprising out.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace kidnapwatch::adapters::codecs {

/// Members stay in the order in which they were set.
using Json = nlohmann::ordered_json;

/// Throws BadInput naming `field` unless `text` is one JSON document (RFC 8259) whose objects do
/// not name a member twice.
[[nodiscard]] Json parsed(std::string_view text, const std::string& field);

/// One line. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string text(const Json& json);

/// Sets the member, unless there is nothing to say: an empty optional or a number that is not
/// finite is left out, and never becomes null.
template <typename Value>
void set(Json& object, const char* key, const Value& value) {
  if constexpr (std::is_floating_point_v<Value>) {
    if (std::isfinite(value)) {
      object[key] = value;
    }
  } else {
    object[key] = value;
  }
}

template <typename Value>
void set(Json& object, const char* key, const std::optional<Value>& value) {
  if (value) {
    set(object, key, *value);
  }
}

}  // namespace kidnapwatch::adapters::codecs
