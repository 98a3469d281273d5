// SPDX-License-Identifier: Apache-2.0
// Numbers as bytes: LEB128 varints, zigzag for the signed, little-endian for the rest.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

static_assert(std::endian::native == std::endian::little);

class ByteWriter {
 public:
  template <typename Number>
  void put(Number value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  void put_varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) put(static_cast<std::uint8_t>(value | 0x80));
    put(static_cast<std::uint8_t>(value));
  }
  void put_signed_varint(std::int64_t value) {
    const auto bits = static_cast<std::uint64_t>(value);
    put_varint((bits << 1) ^ (value < 0 ? ~std::uint64_t{0} : 0));
  }
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// Throws StorageError at the end of the bytes.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  [[nodiscard]] bool at_end() const { return bytes_.empty(); }
  [[nodiscard]] std::span<const std::byte> take(std::size_t size) {
    if (size > bytes_.size()) throw StorageError::damage("a block ends early");
    const auto taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }
  template <typename Number>
  [[nodiscard]] Number get() {
    Number value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  [[nodiscard]] std::uint64_t get_varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
      const auto byte = get<std::uint8_t>();
      value |= std::uint64_t{byte & 0x7fU} << shift;
      if (byte < 0x80) return value;
    }
    throw StorageError::damage("a block holds an endless number");
  }
  /// In two's complement, to be added with wrap-around.
  [[nodiscard]] std::uint64_t get_signed_varint() {
    const auto bits = get_varint();
    return (bits >> 1) ^ ((bits & 1) != 0 ? ~std::uint64_t{0} : 0);
  }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace kidnapwatch::storage
