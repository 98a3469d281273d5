// SPDX-License-Identifier: Apache-2.0
// From names to detectors.
#include "service/other_detectors.hpp"

#include <algorithm>
#include <cmath>

#include "core/baselines/ndt_scores.hpp"
#include "core/dissimilarity_detector.hpp"

namespace kidnapwatch::service {
namespace {

using Detectors = std::vector<std::unique_ptr<core::Detector>>;

/// The session's own reading of Algorithm 3, and where that never or always standardizes, the gate
/// as it is printed.
core::DissimilarityConfig reading(core::DissimilarityConfig config) {
  const bool has_gate = config.gate == core::Gate::paper || config.gate == core::Gate::homogeneous;
  config.gate = has_gate ? config.gate : core::Gate::paper;
  return config;
}

void add(Detectors& all, Detectors some) { std::ranges::move(some, std::back_inserter(all)); }

Detectors all_detectors(const core::DissimilarityConfig& config,
                        const std::shared_ptr<core::baselines::StreamedWeights>& particles) {
  Detectors all;
  for (const auto& variant : core::dtw_variants(reading(config))) {
    all.push_back(core::dissimilarity_detector(variant));
  }
  add(all, core::baselines::ndt_detectors());
  add(all, core::baselines::particle_detectors(particles));
  return all;
}

}  // namespace

OtherDetectors::OtherDetectors(const core::DetectionConfig& config)
    : particles_(std::make_shared<core::baselines::StreamedWeights>()) {
  if (config.detectors.empty()) return;
  const auto own = core::detector_name(config.dissimilarity);
  for (auto& detector : all_detectors(config.dissimilarity, particles_)) {
    const auto name = detector->name();
    if (name == own || !std::ranges::count(config.detectors, name)) continue;
    need_particles_ = need_particles_ || name == "mcw" || name == "me";
    detectors_.emplace_back(core::detector_id(name, "detectors"), std::move(detector));
  }
}

std::vector<core::DetectorScore> OtherDetectors::observe(const core::Scan& scan) {
  std::vector<core::DetectorScore> scores;
  for (const auto& [id, detector] : detectors_) {
    const auto score = detector->observe(scan);
    if (score && !std::isnan(*score)) scores.push_back({id, static_cast<float>(*score)});
  }
  return scores;
}

}  // namespace kidnapwatch::service
