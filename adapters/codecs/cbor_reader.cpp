// SPDX-License-Identifier: Apache-2.0
// The encoding of CBOR's items: RFC 8949, section 3.
#include "adapters/codecs/cbor_reader.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include "adapters/codecs/scan_fields.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

constexpr int kMaxDepth = 32;
constexpr unsigned char kBreak = 0xFF;

[[nodiscard]] std::uint64_t big_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char byte : bytes) {
    value = value << 8U | static_cast<unsigned char>(byte);
  }
  return value;
}

/// Strings, arrays and maps may be of indefinite length.
[[nodiscard]] bool can_be_indefinite(CborReader::Major major) {
  return major >= CborReader::Major::bytes && major <= CborReader::Major::map;
}

}  // namespace

CborReader::Head CborReader::head() {
  const auto first = static_cast<unsigned char>(take(1)[0]);
  Head head{.major = static_cast<Major>(first >> 5U),
            .info = static_cast<std::uint8_t>(first & 31U),
            .argument = first & 31U};
  if (head.info >= 24 && head.info <= 27) {
    head.argument = big_endian(take(std::uint64_t{1} << (head.info - 24U)));
  } else if (head.info >= 28 && !(head.indefinite() && can_be_indefinite(head.major))) {
    throw_malformed("payload", "is not well-formed CBOR");
  }
  return head;
}

std::string_view CborReader::take(std::uint64_t count) {
  if (count > rest_.size()) {
    throw_malformed("payload", "ends within a CBOR item");
  }
  const std::string_view taken = rest_.substr(0, count);
  rest_.remove_prefix(count);
  return taken;
}

bool CborReader::take_break() {
  if (rest_.empty() || static_cast<unsigned char>(rest_[0]) != kBreak) {
    return false;
  }
  rest_.remove_prefix(1);
  return true;
}

void CborReader::skip(const Head& head) { skip(head, 0); }

void CborReader::skip(const Head& head, int depth) {
  if (depth > kMaxDepth) {
    throw_malformed("payload", "is nested too deep");
  }
  const auto skip_next = [&] { skip(this->head(), depth + 1); };
  switch (head.major) {
    case Major::bytes:
    case Major::text:
      head.indefinite() ? skip_chunks(head.major) : static_cast<void>(take(head.argument));
      break;
    case Major::array:
      for_each(head, skip_next);
      break;
    case Major::map:
      for_each(head, [&] {
        skip_next();
        skip_next();
      });
      break;
    case Major::tag:
      skip_next();
      break;
    case Major::uint:
    case Major::nint:
    case Major::simple:
      break;  // all of it is in the head
  }
}

void CborReader::skip_chunks(Major major) {
  while (!take_break()) {
    const Head chunk = head();
    if (chunk.major != major || chunk.indefinite()) {
      throw_malformed("payload", "is not well-formed CBOR");
    }
    (void)take(chunk.argument);
  }
}

std::optional<double> number(const CborReader::Head& head) {
  using Major = CborReader::Major;
  if (head.major == Major::uint) {
    return static_cast<double>(head.argument);
  }
  if (head.major == Major::nint) {
    return -1.0 - static_cast<double>(head.argument);
  }
  if (head.major == Major::simple && head.info == 25) {
    return float_from_half(static_cast<std::uint16_t>(head.argument));
  }
  if (head.major == Major::simple && head.info == 26) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(head.argument));
  }
  if (head.major == Major::simple && head.info == 27) {
    return std::bit_cast<double>(head.argument);
  }
  return std::nullopt;
}

float float_from_half(std::uint16_t bits) {  // RFC 8949, appendix D
  const auto exponent = static_cast<int>(bits >> 10U & 31U);
  const auto mantissa = static_cast<float>(bits & 1023U);
  const float sign = (bits & 0x8000U) != 0U ? -1.0F : 1.0F;
  if (exponent == 31) {
    return mantissa != 0.0F ? std::numeric_limits<float>::quiet_NaN()
                            : sign * std::numeric_limits<float>::infinity();
  }
  const bool subnormal = exponent == 0;
  return sign *
         (subnormal ? std::ldexp(mantissa, -24) : std::ldexp(mantissa + 1024.0F, exponent - 25));
}

}  // namespace kidnapwatch::adapters::codecs
