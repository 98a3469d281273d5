// SPDX-License-Identifier: Apache-2.0
// How often each client may ask: a token bucket (RFC 2697's) for each.
#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <unordered_map>

namespace kidnapwatch::api {

struct RateLimitConfig {
  double per_s = 50.0;               ///< requests in the long run; 0: no limit
  double burst = 100.0;              ///< at once, after a pause
  std::size_t max_clients = 10'000;  ///< remembered
};

/// Any thread.
class RateLimit {
 public:
  explicit RateLimit(const RateLimitConfig& config) : config_(config) {}

  /// Takes one request of `client` at `now_s` (of a clock that never goes back). Returns the
  /// seconds to wait first: 0 if it may go on.
  [[nodiscard]] double wait_s(const std::string& client, double now_s);

 private:
  struct Bucket {
    double level;
    double at_s;
  };

  [[nodiscard]] double level(const Bucket& bucket, double now_s) const;
  void forget_full(double now_s);

  const RateLimitConfig config_;
  std::mutex mutex_;
  std::unordered_map<std::string, Bucket> buckets_;
};

}  // namespace kidnapwatch::api
