// SPDX-License-Identifier: Apache-2.0
// CBOR (RFC 8949), item by item, over bytes that nobody vouches for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace kidnapwatch::adapters::codecs {

/// Reads forward and never beyond the end; allocates nothing. Every function throws
/// BadScan(malformed) where the bytes are not well-formed.
class CborReader {
 public:
  enum class Major : std::uint8_t { uint, nint, bytes, text, array, map, tag, simple };

  /// The beginning of an item.
  struct Head {
    Major major = Major::simple;
    std::uint8_t info = 0;       ///< low five bits of the first byte
    std::uint64_t argument = 0;  ///< value, length, count, tag or bits of a float

    [[nodiscard]] bool indefinite() const { return info == 31; }
    /// null or undefined
    [[nodiscard]] bool is_null() const {
      return major == Major::simple && (info == 22 || info == 23);
    }
  };

  explicit CborReader(std::string_view bytes) : rest_(bytes) {}

  [[nodiscard]] Head head();
  /// The next `count` bytes.
  [[nodiscard]] std::string_view take(std::uint64_t count);
  /// Whether the next byte ends an indefinite item; then it is taken.
  [[nodiscard]] bool take_break();
  /// Passes over the item that `head` began, at most 32 deep.
  void skip(const Head& head);

  [[nodiscard]] bool at_end() const noexcept { return rest_.empty(); }
  /// An upper bound of the items that can still come.
  [[nodiscard]] std::size_t bytes_left() const noexcept { return rest_.size(); }

  /// Calls `item()` before each item of the array, or entry of the map, that `head` began.
  template <class Item>
  void for_each(const Head& head, Item&& item) {
    for (std::uint64_t i = 0; head.indefinite() ? !take_break() : i < head.argument; ++i) {
      item();
    }
  }

  /// Calls `entry(key)`, which takes the value, for each entry of the map that `head` began;
  /// entries whose key is not a text in one piece are passed over.
  template <class Entry>
  void for_each_entry(const Head& head, Entry&& entry) {
    for_each(head, [&] {
      const Head key = this->head();
      if (key.major == Major::text && !key.indefinite()) {
        entry(take(key.argument));
      } else {
        skip(key);
        skip(this->head());
      }
    });
  }

 private:
  void skip(const Head& head, int depth);
  void skip_chunks(Major major);

  std::string_view rest_;
};

/// The number that `head` is; nothing if it is of another type.
[[nodiscard]] std::optional<double> number(const CborReader::Head& head);

/// The value of an IEEE 754 binary16, given its bits.
[[nodiscard]] float float_from_half(std::uint16_t bits);

}  // namespace kidnapwatch::adapters::codecs
