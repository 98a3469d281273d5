// SPDX-License-Identifier: Apache-2.0
// Forgetting histogram and the threshold its tail predicts.
#include "core/tail.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kidnapwatch::core {
namespace {

constexpr float kWeightMax = 1e6F;
constexpr float kTailShare = 0.05F;

}  // namespace

Tail::Tail(float low, float high, float half_life)
    : low_(low), high_(high), forget_(std::exp2(-1.0F / half_life)) {}

void Tail::learn(float value) {
  const float at = value > low_  // false for NaN
                       ? std::min((value - low_) / width(), static_cast<float>(kBins - 1))
                       : 0.0F;
  bins_[static_cast<std::size_t>(at)] += weight_;
  count_ = count_ * forget_ + 1.0F;
  weight_ /= forget_;
  if (weight_ < kWeightMax) return;
  for (float& bin : bins_) bin /= weight_;
  weight_ = 1.0F;
}

float Tail::quantile(float p) const {
  float left = p * std::accumulate(bins_.begin(), bins_.end(), 0.0F);
  if (left <= 0.0F) return low_;
  for (std::size_t i = 0; i < kBins; ++i) {
    if (bins_[i] >= left && bins_[i] > 0.0F)
      return low_ + width() * (static_cast<float>(i) + left / bins_[i]);
    left -= bins_[i];
  }
  return high_;
}

Tail::Excess Tail::excess(float from) const {
  Excess result;
  for (std::size_t i = 0; i < kBins; ++i) {
    const float end = low_ + width() * static_cast<float>(i + 1);
    if (end <= from) continue;
    const float begin = std::max(end - width(), from);  // values lie evenly in their bin
    const float above = bins_[i] * (end - begin) / width();
    result.sum += above * (0.5F * (begin + end) - from);
    result.count += above;
  }
  const float scale = 1.0F / (weight_ * forget_);  // the newest value weighs weight_ * forget_
  return {result.sum * scale, result.count * scale};
}

float predicted_threshold(const Tail& tail, float rate, float prior_count, float prior_mean) {
  const float from = tail.quantile(1.0F - kTailShare);
  const Tail::Excess excess = tail.excess(from);
  // Ties at the quantile are excesses of 0: their number is the share, not what lies strictly
  // above.
  const float count = std::max(kTailShare * tail.count() + prior_count, 1.0F);
  const float sum = excess.sum + prior_count * prior_mean;
  return from + sum * (std::pow(kTailShare / rate, 1.0F / count) - 1.0F);
}

}  // namespace kidnapwatch::core
