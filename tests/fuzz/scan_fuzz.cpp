// SPDX-License-Identifier: Apache-2.0
// Any bytes as a scan, as odometry or as particles: they are one, or BadScan.
#include "adapters/codecs/odometry_json.hpp"
#include "adapters/codecs/particles_payload.hpp"
#include "adapters/codecs/scan_payload.hpp"
#include "tests/fuzz/input.hpp"

using namespace kidnapwatch;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static adapters::codecs::ScanDecoder scans({.max_payload_bytes = 65'536});
  static adapters::codecs::OdometryDecoder odometry;
  static adapters::codecs::ParticlesDecoder particles(65'536);
  const auto payload = test::text_of(data, size);
  for (const auto type : {"", "application/json", "application/cbor"}) {
    try {
      core::Scan scan;
      scans.decode(payload, type, scan);
      core::check(scan);
    } catch (const core::BadScan&) {
    }
  }
  try {
    (void)odometry.decode(payload);
  } catch (const core::BadScan&) {
  }
  try {
    (void)particles.decode(payload);
  } catch (const core::BadScan&) {
  }
  return 0;
}
