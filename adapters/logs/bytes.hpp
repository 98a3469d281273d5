// SPDX-License-Identifier: Apache-2.0
// Binary records, taken apart within their bounds.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::logs {

static_assert(std::endian::native == std::endian::little, "records are copied as they are");

/// Little-endian values, one after the other. Throws BadInput naming `field` where the bytes end.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : rest_(bytes) {}

  [[nodiscard]] bool empty() const { return rest_.empty(); }

  std::string_view take(std::size_t size, std::string_view field) {
    if (size > rest_.size()) throw core::BadInput(std::string(field), "cut off");
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  template <typename Value>
  [[nodiscard]] Value value(std::string_view field) {
    Value value{};
    std::memcpy(&value, take(sizeof value, field).data(), sizeof value);
    return value;
  }

  /// What a length before it says.
  std::string_view block(std::string_view field) {
    return take(value<std::uint32_t>(field), field);
  }

 private:
  std::string_view rest_;
};

}  // namespace kidnapwatch::adapters::logs
