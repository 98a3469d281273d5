// SPDX-License-Identifier: Apache-2.0
// Scan payloads of any dialect in, scans out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "adapters/codecs/scan_fields.hpp"
#include "core/scan.hpp"

namespace kidnapwatch::adapters::codecs {

/// How a scan is encoded on the wire.
enum class Dialect : std::uint8_t {
  automatic,  ///< told by the first bytes
  json,       ///< sensor_msgs/LaserScan as rosbridge writes it
  cbor,       ///< the same fields in CBOR
};

inline constexpr std::string_view kJsonContentType = "application/json";
inline constexpr std::string_view kCborContentType = "application/cbor";

/// The dialect that an MQTT 5 content type names; automatic if it names none of them.
[[nodiscard]] Dialect dialect_of_content_type(std::string_view content_type);

/// The dialect that the first bytes look like. Throws BadScan(malformed) if they look like none.
[[nodiscard]] Dialect dialect_of_payload(std::string_view payload);

struct ScanPayloadConfig {
  Dialect dialect = Dialect::automatic;  ///< where the content type does not say
  NullRange null_range = NullRange::no_return;
  std::size_t max_payload_bytes = std::size_t{1} << 20;
};

/// Turns payloads into scans. For one thread; allocates nothing once it has seen the largest
/// message.
class ScanDecoder {
 public:
  explicit ScanDecoder(const ScanPayloadConfig& config = {});
  ~ScanDecoder();
  ScanDecoder(ScanDecoder&&) noexcept;
  ScanDecoder& operator=(ScanDecoder&&) noexcept;

  /// Replaces `scan`, reusing its memory, by the one in `payload`; it passes core::check. The
  /// dialect is that of the content type, else the configured one, else told by the first bytes.
  /// Throws BadScan, and only that, for whatever cannot be used; `scan` is then any scan.
  void decode(std::string_view payload, std::string_view content_type, core::Scan& scan);

  /// Ranges that were null in all scans so far.
  [[nodiscard]] std::uint64_t nulls() const noexcept { return nulls_; }

 private:
  struct Json;  // keeps simdjson out of this header

  ScanPayloadConfig config_;
  std::unique_ptr<Json> json_;
  std::uint64_t nulls_ = 0;
};

}  // namespace kidnapwatch::adapters::codecs
