// SPDX-License-Identifier: Apache-2.0
// From trials to a table.
#include "core/evaluation/summary.hpp"

#include <array>
#include <iterator>

namespace kidnapwatch::core::evaluation {
namespace {

constexpr std::array kRates{1e-2, 2e-3, 1e-3};
constexpr std::string_view kPooled = "pooled";

std::vector<double> scores(const std::vector<EpisodeResult>& episodes) {
  std::vector<double> all;
  all.reserve(episodes.size());
  for (const EpisodeResult& episode : episodes) all.push_back(episode.score);
  return all;
}

Row counted(const std::vector<EpisodeResult>& episodes) {
  Row row;
  for (const EpisodeResult& episode : episodes) {
    row.alarms.hits += episode.alarm ? 1 : 0;
    if (episode.alarm && episode.cause) ++row.causes[std::string(name(*episode.cause))];
  }
  row.alarms.trials = episodes.size();
  return row;
}

void add_points(const std::vector<EpisodeResult>& episodes, const std::vector<double>& natural,
                Row& row) {
  if (natural.empty() || episodes.empty()) return;
  const auto found = scores(episodes);
  row.roc = roc(natural, found);
  for (const double fpr : kRates) {
    const double threshold = threshold_at(natural, fpr);
    row.points.push_back(
        {fpr, threshold, share_above(natural, threshold), share_above(found, threshold)});
  }
}

Row natural_row(const TrialResult& result, std::string kind, std::size_t alarms) {
  Row row;
  row.family = Family::natural;
  row.kind = std::move(kind);
  row.alarms = {alarms, result.natural.size()};
  return row;
}

std::vector<Row> rows_of(DetectorKind detector, const std::string& log, const TrialResult& result) {
  std::vector<Row> all{natural_row(result, "natural", result.alarms),
                       natural_row(result, "carry_natural", result.carry_alarms)};
  for (const auto& [kind, episodes] : result.kidnaps) {
    all.push_back(counted(episodes));
    all.back().family = Family::kidnap;
    all.back().kind = kind;
    add_points(episodes, result.natural, all.back());
  }
  for (const auto& [kind, episodes] : result.confounders) {
    all.push_back(counted(episodes));
    all.back().family = Family::confounder;
    all.back().kind = kind;
  }
  for (Row& row : all) {
    if (row.roc && log != kPooled) row.roc->points.clear();
    row.detector = detector;
    row.log = log;
    row.threshold = result.threshold;
  }
  return all;
}

template <class Episodes>
void append(const Episodes& from, Episodes& to) {
  for (const auto& [kind, episodes] : from)
    to[kind].insert(to[kind].end(), episodes.begin(), episodes.end());
}

void pool(const TrialResult& one, TrialResult& all) {
  all.natural.insert(all.natural.end(), one.natural.begin(), one.natural.end());
  all.alarms += one.alarms;
  all.carry_alarms += one.carry_alarms;
  append(one.kidnaps, all.kidnaps);
  append(one.confounders, all.confounders);
}

}  // namespace

std::string_view name(Family family) {
  static constexpr std::array<std::string_view, 3> names{"natural", "kidnap", "confounder"};
  return names[static_cast<std::size_t>(family)];
}

std::vector<Row> rows(std::span<const LogTrial> trials) {
  std::vector<Row> all;
  for (const DetectorKind detector : kDetectors) {
    TrialResult pooled;
    for (const LogTrial& trial : trials) {
      const auto found = trial.results.find(detector);
      if (found == trial.results.end()) continue;
      std::ranges::move(rows_of(detector, trial.log, found->second), std::back_inserter(all));
      if (found->second.threshold) pool(found->second, pooled);
    }
    if (!pooled.natural.empty())
      std::ranges::move(rows_of(detector, std::string(kPooled), pooled), std::back_inserter(all));
  }
  return all;
}

}  // namespace kidnapwatch::core::evaluation
