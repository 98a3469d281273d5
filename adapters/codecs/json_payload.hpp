// SPDX-License-Identifier: Apache-2.0
// JSON messages of the fast path, read with simdjson; bare NaN and infinities are understood.
#pragma once

#include <string>
#include <string_view>

#include <simdjson.h>

#include "adapters/codecs/nonfinite.hpp"
#include "adapters/codecs/scan_fields.hpp"

namespace kidnapwatch::adapters::codecs {

namespace ondemand = simdjson::ondemand;

/// Memory for reading one message after the other: nothing is allocated once it is warm.
class JsonPayload {
 public:
  /// Calls `read(ondemand::object&)` with the message. Should that find the text to be no JSON, and
  /// there are bare non-finite numbers in it, it is called again with these in quotes. Throws what
  /// `read` throws, and BadScan(malformed) if the text is no JSON object.
  template <class Read>
  void read(std::string_view text, Read&& read) {
    try {
      read_once(text, read);
    } catch (const simdjson::simdjson_error& error) {
      if (!quote_nonfinite(text, quoted_)) {
        throw_malformed("payload", error.what());
      }
      read_quoted(read);
    }
  }

 private:
  template <class Read>
  void read_once(std::string_view text, Read&& read) {
    ondemand::document document = parser_.iterate(padded(text));
    ondemand::object object = object_of(document);
    read(object);
    if (document.current_location().error() != simdjson::OUT_OF_BOUNDS) {
      throw_malformed("payload", "goes on after its end");
    }
  }

  template <class Read>
  void read_quoted(Read&& read) {
    try {
      read_once(quoted_, read);
    } catch (const simdjson::simdjson_error& error) {
      throw_malformed("payload", error.what());
    }
  }

  [[nodiscard]] static ondemand::object object_of(ondemand::document& document) {
    ondemand::json_type type{};
    if (document.type().get(type) == simdjson::SUCCESS && type != ondemand::json_type::object) {
      throw_malformed("payload", "is not an object");
    }
    return document.get_object();
  }

  /// simdjson reads a little beyond the end: a copy (0.1 us for 4 kB) gives it room.
  [[nodiscard]] simdjson::padded_string_view padded(std::string_view text) {
    padded_.reserve(text.size() + simdjson::SIMDJSON_PADDING);
    padded_.assign(text);
    return simdjson::padded_string_view(padded_.data(), text.size(), padded_.capacity());
  }

  ondemand::parser parser_;
  std::string padded_;
  std::string quoted_;
};

/// The next functions read one value, and throw BadScan(wrong_type) naming `field` if it is of
/// another type, or simdjson_error if it is no JSON.

[[nodiscard]] double number(ondemand::value value, std::string_view field);

[[nodiscard]] ondemand::object object(ondemand::value value, std::string_view field);

/// {secs, nsecs} or {sec, nanosec}.
[[nodiscard]] core::Stamp stamp(ondemand::value value, std::string_view field);

/// The `stamp` in a std_msgs/Header; nothing if it has none.
[[nodiscard]] std::optional<core::Stamp> header_stamp(ondemand::value value);

}  // namespace kidnapwatch::adapters::codecs
