// SPDX-License-Identifier: Apache-2.0
// Every kidnapping of a trial, scored by every detector.
#include "core/study/algorithm2.hpp"

#include <cmath>
#include <span>

#include "core/evaluation/performance_index.hpp"

namespace kidnapwatch::core::study {
namespace {

using evaluation::Evaluator;
using evaluation::performance_index;

/// Scores of the scans by detector and step.
std::vector<Scores> scored(const Detectors& detectors, std::span<const RecordedScan> scans) {
  std::vector<Scores> scores(detectors.size());
  for (const RecordedScan& recorded : scans) {
    for (std::size_t d = 0; d < detectors.size(); ++d) {
      scores[d].push_back(detectors[d].detector->observe(recorded.scan));
    }
  }
  return scores;
}

std::vector<TrialRecord> blank_records(const Detectors& detectors) {
  std::vector<TrialRecord> records;
  for (const auto& [id, detector] : detectors) {
    records.push_back({id, detector->polarity(), {}, {}, {}, {}});
  }
  return records;
}

/// The last scan before the kidnapping and the first one after it.
std::vector<RecordedScan> pair_at(const Trial& trial, std::size_t t_k) {
  std::vector<RecordedScan> pair{trial.run[t_k - 2], trial.after.front()};
  pair[1].scan.stamp = trial.run[t_k - 1].scan.stamp;
  pair[1].scan.odometry = trial.run[t_k - 1].scan.odometry;
  return pair;
}

}  // namespace

void enter(const Scores& scores, std::size_t t_k, TrialRecord& record) {
  const auto& score = scores[t_k - 1];
  if (score && std::isfinite(*score)) record.kidnapped.push_back(*score);
  const auto eta = [&](Evaluator evaluator) {
    return performance_index(scores, t_k, record.polarity, evaluator).value_or(-1.0);
  };
  record.eta_prior.push_back(eta(Evaluator::prior));
  record.eta_all.push_back(eta(Evaluator::all));
}

void enter_natural(const Scores& scores, TrialRecord& record) {
  for (const auto& score : scores) {
    if (score && std::isfinite(*score)) record.natural.push_back(*score);
  }
}

std::vector<TrialRecord> pairwise_records(const Trial& trial,
                                          const std::function<Detectors()>& make) {
  const Detectors first = make();
  auto records = blank_records(first);
  const auto run = scored(first, trial.run);
  const auto after = scored(make(), trial.after);
  for (std::size_t d = 0; d < records.size(); ++d) enter_natural(run[d], records[d]);
  const auto steps = static_cast<std::ptrdiff_t>(trial.run.size());
  for (std::size_t t_k = kFirstTk; t_k <= trial.run.size(); ++t_k) {
    const auto jump = scored(make(), pair_at(trial, t_k));
    const auto at = static_cast<std::ptrdiff_t>(t_k);
    for (std::size_t d = 0; d < records.size(); ++d) {
      Scores scores(run[d].begin(), run[d].begin() + at - 1);
      scores.push_back(jump[d].back());
      scores.insert(scores.end(), after[d].begin() + 1, after[d].begin() + 1 + steps - at);
      enter(scores, t_k, records[d]);
    }
  }
  return records;
}

std::vector<TrialRecord> records(const Trial& trial, const std::function<Detectors()>& make) {
  const Detectors first = make();
  auto records = blank_records(first);
  const auto run = scored(first, trial.run);
  for (std::size_t d = 0; d < records.size(); ++d) enter_natural(run[d], records[d]);
  for (std::size_t t_k = kFirstTk; t_k <= trial.run.size(); ++t_k) {
    const auto spliced = scored(make(), kidnapped_at(trial, t_k).scans);
    for (std::size_t d = 0; d < records.size(); ++d) enter(spliced[d], t_k, records[d]);
  }
  return records;
}

}  // namespace kidnapwatch::core::study
