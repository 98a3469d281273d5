// SPDX-License-Identifier: Apache-2.0
// The systems, made and named; Monte Carlo localization through every kidnapping.
#include "core/study/systems.hpp"

#include <array>
#include <cmath>

#include "core/baselines/ndt_scores.hpp"
#include "core/dissimilarity_detector.hpp"

namespace kidnapwatch::core::study {
namespace {

using baselines::Mcl;
using baselines::MclUpdate;
using baselines::Relocalization;

constexpr std::array<std::string_view, 2> kGates{"paper", "homogeneous"};
constexpr std::array<std::string_view, 3> kTests{"bartlett", "levene", "brown_forsythe"};
constexpr std::array<std::string_view, 2> kInvalid{"drop", "clamp"};
constexpr std::array<std::string_view, 3> kRelocalizations{"none", "global", "perfect"};

template <typename Names, typename Enum>
std::string_view name(const Names& names, Enum value) {
  return names.at(static_cast<std::size_t>(value));
}

/// `config` with every gate, and every variance test where the gate has one.
void add_gates(DissimilarityConfig config, std::vector<DissimilarityConfig>& all) {
  for (const auto gate : {Gate::never, Gate::always}) {
    config.gate = gate;
    all.push_back(config);
  }
  for (const auto gate : {Gate::paper, Gate::homogeneous}) {
    for (const auto test :
         {VarianceTest::bartlett, VarianceTest::levene, VarianceTest::brown_forsythe}) {
      config.gate = gate;
      config.variance_test = test;
      all.push_back(config);
    }
  }
}

/// The scores of a run, by step.
struct WeightScores {
  Scores mcw;
  Scores me;

  void add(const std::optional<MclUpdate>& update) {
    mcw.push_back(update ? std::optional(update->max_current_weight) : std::nullopt);
    me.push_back(update ? std::optional(update->measurement_entropy) : std::nullopt);
  }
};

Pose motion(const Scan* before, const Scan& now) {
  return before == nullptr ? Pose{} : inverse(*before->odometry) * *now.odometry;
}

/// Scores of the run with a kidnapping at `t_k`, by a filter that got as far as t_k - 1.
WeightScores followed(Mcl filter, WeightScores scores, const Trial& trial, std::size_t t_k) {
  const Recording spliced = kidnapped_at(trial, t_k);
  for (std::size_t t = t_k; t <= spliced.scans.size(); ++t) {
    const RecordedScan& before = spliced.scans[t - 2];
    const RecordedScan& now = spliced.scans[t - 1];
    scores.add(filter.update(now.scan, motion(&before.scan, now.scan), now.true_pose));
  }
  return scores;
}

}  // namespace

std::string id_of(const DissimilarityConfig& config) {
  std::string id(detector_name(config));
  if (config.gate == Gate::paper || config.gate == Gate::homogeneous) {
    id += " " + std::string(name(kGates, config.gate));
    id += " " + std::string(name(kTests, config.variance_test));
  }
  return id + " " + std::string(name(kInvalid, config.invalid));
}

std::vector<DissimilarityConfig> readings() {
  std::vector<DissimilarityConfig> all;
  for (const auto dimension : {Dimension::ranges, Dimension::points}) {
    for (const auto invalid : {InvalidPolicy::drop, InvalidPolicy::clamp}) {
      add_gates({.dimension = dimension, .invalid = invalid}, all);
    }
  }
  return all;
}

Detectors dtw_systems() {
  Detectors systems;
  for (const auto& config : readings()) {
    systems.push_back({id_of(config), dissimilarity_detector(config)});
  }
  return systems;
}

Detectors ndt_systems() {
  Detectors systems;
  for (auto& detector : baselines::ndt_detectors()) {
    std::string id(detector->name());
    systems.push_back({std::move(id), std::move(detector)});
  }
  return systems;
}

std::string mcw_id(Relocalization relocalization) {
  return "mcw " + std::string(name(kRelocalizations, relocalization));
}

std::string me_id(Polarity polarity, Relocalization relocalization) {
  return std::string(polarity == Polarity::hptf ? "me hptf " : "me lptf ") +
         std::string(name(kRelocalizations, relocalization));
}

std::vector<TrialRecord> mcl_records(const Trial& trial, const baselines::MeasuredMap& map,
                                     const baselines::MclConfig& config, std::uint64_t seed) {
  const Relocalization how = config.relocalization;
  std::vector<TrialRecord> records{{mcw_id(how), Polarity::lptf, {}, {}, {}, {}},
                                   {me_id(Polarity::lptf, how), Polarity::lptf, {}, {}, {}, {}},
                                   {me_id(Polarity::hptf, how), Polarity::hptf, {}, {}, {}, {}}};
  Mcl filter(map, config, seed);
  filter.start_at(*trial.run.front().true_pose);
  WeightScores natural;
  for (std::size_t t = 1; t <= trial.run.size(); ++t) {
    if (t >= kFirstTk) {
      const WeightScores scores = followed(filter, natural, trial, t);
      enter(scores.mcw, t, records[0]);
      enter(scores.me, t, records[1]);
      enter(scores.me, t, records[2]);
    }
    const RecordedScan& now = trial.run[t - 1];
    natural.add(filter.update(now.scan, motion(t > 1 ? &trial.run[t - 2].scan : nullptr, now.scan),
                              now.true_pose));
  }
  enter_natural(natural.mcw, records[0]);
  enter_natural(natural.me, records[1]);
  enter_natural(natural.me, records[2]);
  return records;
}

}  // namespace kidnapwatch::core::study
