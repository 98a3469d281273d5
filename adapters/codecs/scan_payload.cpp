// SPDX-License-Identifier: Apache-2.0
// Tells the dialects of scans apart and hands each payload to its reader.
#include "adapters/codecs/scan_payload.hpp"

#include <algorithm>
#include <string>

#include "adapters/codecs/scan_cbor.hpp"
#include "adapters/codecs/scan_json.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

constexpr std::string_view kWhitespace = " \t\r\n";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kSelfDescribedCbor = "\xD9\xD9\xF7";  // RFC 8949, section 3.4.6

/// "Application/JSON; charset=utf-8" is "application/json".
[[nodiscard]] bool is_media_type(std::string_view content_type, std::string_view media_type) {
  const std::string_view bare = content_type.substr(0, content_type.find_first_of("; "));
  const auto lower = [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  };
  return std::ranges::equal(bare, media_type, {}, lower);
}

[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text) {
  return text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text;
}

[[nodiscard]] bool starts_object(std::string_view text) {
  const std::string_view bare = without_byte_order_mark(text);
  const std::size_t start = bare.find_first_not_of(kWhitespace);
  return start != std::string_view::npos && bare[start] == '{';
}

/// A map, major type 5, perhaps behind the tag that says "this is CBOR".
[[nodiscard]] bool starts_cbor_map(std::string_view bytes) {
  return bytes.starts_with(kSelfDescribedCbor) ||
         (!bytes.empty() && (static_cast<unsigned char>(bytes[0]) >> 5U) == 5U);
}

}  // namespace

struct ScanDecoder::Json {
  JsonPayload payload;
};

Dialect dialect_of_content_type(std::string_view content_type) {
  if (is_media_type(content_type, kJsonContentType)) {
    return Dialect::json;
  }
  if (is_media_type(content_type, kCborContentType)) {
    return Dialect::cbor;
  }
  return Dialect::automatic;
}

Dialect dialect_of_payload(std::string_view payload) {
  if (starts_object(payload)) {
    return Dialect::json;
  }
  if (starts_cbor_map(payload)) {
    return Dialect::cbor;
  }
  throw_malformed("payload", "starts like no known encoding of a scan");
}

ScanDecoder::ScanDecoder(const ScanPayloadConfig& config)
    : config_(config), json_(std::make_unique<Json>()) {}
ScanDecoder::~ScanDecoder() = default;
ScanDecoder::ScanDecoder(ScanDecoder&&) noexcept = default;
ScanDecoder& ScanDecoder::operator=(ScanDecoder&&) noexcept = default;

void ScanDecoder::decode(std::string_view payload, std::string_view content_type,
                         core::Scan& scan) {
  if (payload.size() > config_.max_payload_bytes) {
    throw core::BadScan(core::Outcome::too_large, "payload",
                        "has more than " + std::to_string(config_.max_payload_bytes) + " bytes");
  }
  Dialect dialect = dialect_of_content_type(content_type);
  if (dialect == Dialect::automatic) {
    dialect = config_.dialect;
  }
  if (dialect == Dialect::automatic) {
    dialect = dialect_of_payload(payload);
  }
  nulls_ += dialect == Dialect::cbor
                ? read_scan_cbor(payload, config_.null_range, scan)
                : read_scan_json(json_->payload, without_byte_order_mark(payload),
                                 config_.null_range, scan);
}

}  // namespace kidnapwatch::adapters::codecs
