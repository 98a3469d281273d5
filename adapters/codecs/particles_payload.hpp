// SPDX-License-Identifier: Apache-2.0
// The particles of a robot's own localization, of which only the weights count.
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

namespace kidnapwatch::adapters::codecs {

inline constexpr std::size_t kMaxParticles = 100'000;

/// Reads weights in JSON or CBOR, told apart by the first bytes: nav2_msgs/ParticleCloud, which is
/// {particles: [{pose, weight}, ...]}; {weights: [...]}; or a plain array of numbers. For one
/// thread.
class ParticlesDecoder {
 public:
  explicit ParticlesDecoder(std::size_t max_payload_bytes);
  ~ParticlesDecoder();
  ParticlesDecoder(ParticlesDecoder&&) noexcept;
  ParticlesDecoder& operator=(ParticlesDecoder&&) noexcept;

  /// At least one, each finite and at least 0. Throws BadScan, as scans do, for whatever cannot be
  /// used.
  [[nodiscard]] std::vector<double> decode(std::string_view payload);

 private:
  struct Json;  // keeps simdjson out of this header

  std::size_t max_payload_bytes_;
  std::unique_ptr<Json> json_;
};

}  // namespace kidnapwatch::adapters::codecs
