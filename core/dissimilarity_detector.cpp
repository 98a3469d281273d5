// SPDX-License-Identifier: Apache-2.0
// A detector around Algorithm 3.
#include "core/dissimilarity_detector.hpp"

#include <utility>

namespace kidnapwatch::core {
namespace {

class DissimilarityDetector : public Detector {
 public:
  explicit DissimilarityDetector(const DissimilarityConfig& config) : config_(config) {}

  [[nodiscard]] std::string_view name() const override { return detector_name(config_); }
  [[nodiscard]] Polarity polarity() const override { return Polarity::hptf; }

  [[nodiscard]] std::optional<double> observe(const Scan& scan) override {
    if (!is_comparable(scan)) return std::nullopt;
    prepare(scan, config_, bearings_, now_);
    std::optional<double> score;
    if (before_.size() > 0) score = dissimilarity(before_, now_, config_, workspace_).cost;
    std::swap(before_, now_);
    return score;
  }

 private:
  DissimilarityConfig config_;
  Bearings bearings_;
  Sample before_;
  Sample now_;
  DissimilarityWorkspace workspace_;
};

}  // namespace

std::array<DissimilarityConfig, 6> dtw_variants(const DissimilarityConfig& reading) {
  std::array<DissimilarityConfig, 6> variants;
  auto* variant = variants.data();
  for (const auto dimension : {Dimension::ranges, Dimension::points}) {
    for (const auto gate : {Gate::never, Gate::always, reading.gate}) {
      *variant = reading;
      variant->dimension = dimension;
      variant->gate = gate;
      ++variant;
    }
  }
  return variants;
}

std::unique_ptr<Detector> dissimilarity_detector(const DissimilarityConfig& config) {
  return std::make_unique<DissimilarityDetector>(config);
}

}  // namespace kidnapwatch::core
