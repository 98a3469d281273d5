// SPDX-License-Identifier: Apache-2.0
// Two scores of a filter's weights: of one that runs here, or of a robot's own.
#include "core/baselines/particle_detectors.hpp"

#include <cmath>
#include <utility>

#include "core/baselines/particle_scores.hpp"

namespace kidnapwatch::core::baselines {
namespace {

/// The two scores of a scan.
struct WeightScores {
  double mcw = 0.0;
  double me = 0.0;
};

/// Localizes one robot; a scan with the stamp of the last one is that one.
class Localizer {
 public:
  Localizer(const MeasuredMap& map, const MclConfig& config, std::uint64_t seed,
            const std::optional<Pose>& start)
      : filter_(map, config, seed), started_(start.has_value()) {
    if (start) filter_.start_at(*start);
  }

  std::optional<WeightScores> observe(const Scan& scan) {
    if (stamp_ == scan.stamp) return scores_;
    stamp_ = scan.stamp;
    scores_.reset();
    if (!scan.odometry || valid_beams(scan) == 0) return scores_;
    if (!started_) filter_.start_anywhere(scan);
    started_ = true;
    const Pose moved = odometry_ ? inverse(*odometry_) * *scan.odometry : Pose{};
    odometry_ = scan.odometry;
    if (const auto update = filter_.update(scan, moved)) {
      scores_ = WeightScores{update->max_current_weight, update->measurement_entropy};
    }
    return scores_;
  }

 private:
  Mcl filter_;
  bool started_;
  std::optional<Stamp> stamp_;
  std::optional<Pose> odometry_;
  std::optional<WeightScores> scores_;
};

/// What both kinds of detectors are: a name, a polarity, one of the two scores.
class WeightDetector : public Detector {
 public:
  WeightDetector(std::string_view name, Polarity polarity, double WeightScores::*score)
      : name_(name), polarity_(polarity), score_(score) {}

  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] Polarity polarity() const override { return polarity_; }
  [[nodiscard]] std::optional<double> observe(const Scan& scan) override {
    const auto scores = scores_of(scan);
    if (!scores || !std::isfinite((*scores).*score_)) return std::nullopt;
    return (*scores).*score_;
  }

 private:
  virtual std::optional<WeightScores> scores_of(const Scan& scan) = 0;

  std::string_view name_;
  Polarity polarity_;
  double WeightScores::*score_;
};

class MclDetector : public WeightDetector {
 public:
  MclDetector(std::string_view name, Polarity polarity, double WeightScores::*score,
              std::shared_ptr<Localizer> localizer)
      : WeightDetector(name, polarity, score), localizer_(std::move(localizer)) {}

 private:
  std::optional<WeightScores> scores_of(const Scan& scan) override {
    return localizer_->observe(scan);
  }

  std::shared_ptr<Localizer> localizer_;
};

class StreamDetector : public WeightDetector {
 public:
  StreamDetector(std::string_view name, Polarity polarity, double WeightScores::*score,
                 std::shared_ptr<const StreamedWeights> stream)
      : WeightDetector(name, polarity, score), stream_(std::move(stream)) {}

 private:
  std::optional<WeightScores> scores_of(const Scan& /*scan*/) override {
    if (std::exchange(seen_, stream_->taken()) == stream_->taken()) return std::nullopt;
    const double me = measurement_entropy(stream_->weights());  // NaN for weights that are none
    return std::isfinite(me)
               ? std::optional(WeightScores{max_current_weight(stream_->weights()), me})
               : std::nullopt;
  }

  std::shared_ptr<const StreamedWeights> stream_;
  std::uint64_t seen_ = 0;
};

template <typename OneDetector, typename Source>
std::vector<std::unique_ptr<Detector>> both(const Source& source, Polarity me_polarity) {
  std::vector<std::unique_ptr<Detector>> detectors;
  detectors.push_back(
      std::make_unique<OneDetector>("mcw", Polarity::lptf, &WeightScores::mcw, source));
  detectors.push_back(std::make_unique<OneDetector>("me", me_polarity, &WeightScores::me, source));
  return detectors;
}

}  // namespace

std::vector<std::unique_ptr<Detector>> mcl_detectors(const MeasuredMap& map,
                                                     const MclConfig& config, std::uint64_t seed,
                                                     const std::optional<Pose>& start,
                                                     Polarity me_polarity) {
  return both<MclDetector>(std::make_shared<Localizer>(map, config, seed, start), me_polarity);
}

std::vector<std::unique_ptr<Detector>> particle_detectors(
    const std::shared_ptr<const StreamedWeights>& stream, Polarity me_polarity) {
  return both<StreamDetector>(stream, me_polarity);
}

}  // namespace kidnapwatch::core::baselines
