// SPDX-License-Identifier: Apache-2.0
// Candidates, and what they are worth.
#include "core/evaluation/tunings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "core/evaluation/rates.hpp"
#include "core/motion_detector.hpp"

namespace kidnapwatch::core::evaluation {
namespace {

constexpr MotionTuning kBase{.after = 1.25F};

template <class T>
constexpr MotionTuning but(T MotionTuning::*constant, T value) {
  MotionTuning tuning = kBase;
  tuning.*constant = value;
  return tuning;
}

constexpr double kFloorStep = 0.5;
constexpr double kFloorMost = 8.0;

using Episodes = std::map<std::string, std::vector<EpisodeResult>>;

/// The results of one candidate on the runs that may be looked at.
std::vector<const TrialResult*> others(std::span<const Rehearsal> rehearsals,
                                       std::string_view folder, std::size_t candidate) {
  std::vector<const TrialResult*> all;
  for (const Rehearsal& rehearsal : rehearsals) {
    if (rehearsal.folder == folder || candidate >= rehearsal.results.size()) continue;
    if (rehearsal.results[candidate].own_threshold) all.push_back(&rehearsal.results[candidate]);
  }
  return all;
}

/// Floors to try: none lets more than a share `rate` of the natural pairs pass.
std::vector<double> floors(std::span<const TrialResult* const> runs, double rate) {
  std::vector<double> scores;
  for (const TrialResult* run : runs)
    scores.insert(scores.end(), run->natural.begin(), run->natural.end());
  if (static_cast<double>(scores.size()) < 2.0 / rate) return {MotionConfig{}.threshold_min};
  const double least = threshold_at(scores, rate);
  std::vector<double> all{least};
  for (double floor = kFloorStep * std::ceil(least / kFloorStep); floor <= kFloorMost;
       floor += kFloorStep)
    all.push_back(floor);
  return all;
}

/// Mean over the kinds of the share that alarms, if no robot's threshold is below `floor`.
double mean_share(std::span<const TrialResult* const> runs, Episodes TrialResult::*of,
                  double floor) {
  std::map<std::string, Rate> kinds;
  for (const TrialResult* run : runs) {
    const double limit = std::max(*run->own_threshold, floor);
    for (const auto& [kind, episodes] : run->*of) {
      Rate& rate = kinds[kind];
      rate.trials += episodes.size();
      rate.hits += static_cast<std::size_t>(std::ranges::count_if(
          episodes, [=](const auto& one) { return one.carried || one.highest > limit; }));
    }
  }
  double sum = 0.0;
  for (const auto& [kind, rate] : kinds) sum += rate.value();
  return kinds.empty() ? 0.0 : sum / static_cast<double>(kinds.size());
}

bool carries_falsely(std::span<const TrialResult* const> runs) {
  Rate rate;
  for (const TrialResult* run : runs) {
    rate.hits += run->carry_alarms;
    rate.trials += run->natural.size();
  }
  return rate.value() > kCarryRate;
}

double worth(std::span<const TrialResult* const> runs, double floor) {
  return mean_share(runs, &TrialResult::kidnaps, floor) -
         kAlarmCost * mean_share(runs, &TrialResult::confounders, floor);
}

}  // namespace

std::span<const Candidate> candidates() {
  using T = MotionTuning;
  static constexpr std::array kAll{
      Candidate{"base", kBase},
      Candidate{"elsewhere_factor 1", but(&T::elsewhere_factor, 1.0F)},
      Candidate{"elsewhere_factor 2.5", but(&T::elsewhere_factor, 2.5F)},
      Candidate{"after 1", but(&T::after, 1.0F)},
      Candidate{"after 1.5", but(&T::after, 1.5F)},
      Candidate{"motion_share .25", but(&T::motion_share, 0.25F)},
      Candidate{"motion_share 1", but(&T::motion_share, 1.0F)},
      Candidate{"scale_min .1", but(&T::scale_min, 0.1F)},
      Candidate{"scale_min .3", but(&T::scale_min, 0.3F)},
      Candidate{"doubt .5", but(&T::doubt, 0.5)},
      Candidate{"doubt 1", but(&T::doubt, 1.0)},
      Candidate{"prior_excesses 5", but(&T::prior_excesses, 5.0F)},
      Candidate{"prior_excesses 20", but(&T::prior_excesses, 20.0F)},
      Candidate{"carry_slack .7", but(&T::carry_slack, 0.7F)},
      Candidate{"carry_slack 1.5", but(&T::carry_slack, 1.5F)},
  };
  return kAll;
}

Choice chosen(std::span<const Rehearsal> rehearsals, std::string_view folder, double rate) {
  Choice best{0, MotionConfig{}.threshold_min, -std::numeric_limits<double>::infinity()};
  for (std::size_t candidate = 0; candidate < candidates().size(); ++candidate) {
    const auto runs = others(rehearsals, folder, candidate);
    if (runs.empty() || carries_falsely(runs)) continue;
    for (const double floor : floors(runs, rate)) {
      const Choice choice{candidate, floor, worth(runs, floor)};
      if (choice.worth > best.worth) best = choice;
    }
  }
  return best;
}

}  // namespace kidnapwatch::core::evaluation
