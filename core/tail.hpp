// SPDX-License-Identifier: Apache-2.0
// The upper tail of a stream of values, in bounded memory: quantiles, and what lies above them.
#pragma once

#include <array>
#include <cstddef>

namespace kidnapwatch::core {

/// A histogram that forgets slowly. Values outside [low, high] count at its ends.
class Tail {
 public:
  static constexpr std::size_t kBins = 256;

  /// Half of what is remembered is of the last `half_life` values.
  Tail(float low, float high, float half_life);

  void learn(float value);

  /// The value below which a share `p` lies; low while nothing was learned. O(kBins).
  [[nodiscard]] float quantile(float p) const;

  /// Sum and number of what lies above `from`: of the excesses over it.
  struct Excess {
    float sum = 0.0F;
    float count = 0.0F;
  };
  [[nodiscard]] Excess excess(float from) const;

  [[nodiscard]] float count() const { return count_; }  ///< what is remembered, in values

  /// Shows `visit` all numbers that were learned, one by one, to be kept or put back.
  template <typename Self, typename Visit>
  static void visit_learned(Self& self, Visit& visit) {
    for (auto& bin : self.bins_) visit(bin);
    visit(self.count_);
    visit(self.weight_);
  }

 private:
  [[nodiscard]] float width() const { return (high_ - low_) / static_cast<float>(kBins); }

  float low_;
  float high_;
  float forget_;  // factor per value
  float count_ = 0.0F;
  float weight_ = 1.0F;  // of the next value: grows, so that forgetting costs nothing per bin
  std::array<float, kBins> bins_{};
};

/// The value that a share `rate` of values will exceed, predicted by an exponential tail above the
/// 95th percentile whose mean is itself only known from so many excesses (the predictive
/// distribution is Lomax): with few excesses farther out than a plain exponential. `prior_count`
/// excesses of mean `prior_mean` are added. 0 < rate < 0.05.
[[nodiscard]] float predicted_threshold(const Tail& tail, float rate, float prior_count,
                                        float prior_mean);

}  // namespace kidnapwatch::core
