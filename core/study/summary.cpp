// SPDX-License-Identifier: Apache-2.0
// Means over trials.
#include "core/study/summary.hpp"

#include <algorithm>
#include <cassert>

namespace kidnapwatch::core::study {
namespace {

const std::vector<double>& etas(const TrialRecord& record, evaluation::Evaluator evaluator) {
  return evaluator == evaluation::Evaluator::prior ? record.eta_prior : record.eta_all;
}

void append_raised(const std::vector<double>& scores, Polarity polarity,
                   std::vector<double>& raised_scores) {
  for (const double score : scores) raised_scores.push_back(raised(score, polarity));
}

}  // namespace

Summary summary(std::span<const TrialRecord* const> trials, evaluation::Evaluator evaluator) {
  assert(!trials.empty());
  Summary result;
  result.id = trials.front()->id;
  result.polarity = trials.front()->polarity;
  const std::size_t kidnappings = etas(*trials.front(), evaluator).size();
  std::vector<double> all;
  for (std::size_t k = 0; k < kidnappings; ++k) {
    std::vector<double> at_t_k;
    for (const TrialRecord* trial : trials) at_t_k.push_back(etas(*trial, evaluator)[k]);
    const evaluation::Performance here = evaluation::performance(at_t_k);
    result.eta.push_back(here.mean);
    result.undetected.push_back(here.undetected);
    all.insert(all.end(), at_t_k.begin(), at_t_k.end());
  }
  result.performance = evaluation::performance(all);
  result.dips = evaluation::performance(result.eta).undetected;
  std::vector<double> natural;
  std::vector<double> kidnapped;
  for (const TrialRecord* trial : trials) {
    append_raised(trial->natural, result.polarity, natural);
    append_raised(trial->kidnapped, result.polarity, kidnapped);
  }
  if (!natural.empty() && !kidnapped.empty()) result.roc = evaluation::roc(natural, kidnapped);
  return result;
}

}  // namespace kidnapwatch::core::study
