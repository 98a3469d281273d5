// SPDX-License-Identifier: Apache-2.0
// Buckets that fill while nobody asks.
#include "api/rate_limit.hpp"

#include <algorithm>

namespace kidnapwatch::api {

double RateLimit::wait_s(const std::string& client, double now_s) {
  if (config_.per_s <= 0.0) {
    return 0.0;
  }
  const std::scoped_lock lock(mutex_);
  if (buckets_.size() >= config_.max_clients && !buckets_.contains(client)) {
    forget_full(now_s);
  }
  Bucket& bucket = buckets_.try_emplace(client, Bucket{config_.burst, now_s}).first->second;
  bucket = {level(bucket, now_s), now_s};
  if (bucket.level < 1.0) {
    return (1.0 - bucket.level) / config_.per_s;
  }
  bucket.level -= 1.0;
  return 0.0;
}

double RateLimit::level(const Bucket& bucket, double now_s) const {
  return std::min(config_.burst, bucket.level + (now_s - bucket.at_s) * config_.per_s);
}

/// A full bucket is as good as none. If none is full, all are forgotten: memory stays bounded, and
/// who fills it so gains one burst.
void RateLimit::forget_full(double now_s) {
  std::erase_if(buckets_,
                [&](const auto& entry) { return level(entry.second, now_s) >= config_.burst; });
  if (buckets_.size() >= config_.max_clients) {
    buckets_.clear();
  }
}

}  // namespace kidnapwatch::api
