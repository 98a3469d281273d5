// SPDX-License-Identifier: Apache-2.0
// Trials become summaries.
#include "core/study/results.hpp"

#include "core/study/systems.hpp"

namespace kidnapwatch::core::study {

Condition condition(const Stage& stage, std::span<const std::vector<TrialRecord>> trials) {
  Condition result{
      stage.map(), stage.setting().range_max_m, stage.setting().noise_variance_m2, {}, {}};
  for (std::size_t d = 0; d < trials.front().size(); ++d) {
    std::vector<const TrialRecord*> records;
    for (const auto& trial : trials) records.push_back(&trial[d]);
    const std::string& id = records.front()->id;
    result.prior[id] = summary(records, evaluation::Evaluator::prior);
    result.all[id] = summary(records, evaluation::Evaluator::all);
  }
  return result;
}

std::string Reading::id(Dimension dimension, Gate gate) const {
  DissimilarityConfig config = dissimilarity;
  config.dimension = dimension;
  config.gate = gate;
  return id_of(config);
}

const std::map<std::string, Summary>& summaries(const Condition& condition,
                                                evaluation::Evaluator evaluator) {
  return evaluator == evaluation::Evaluator::prior ? condition.prior : condition.all;
}

bool is_main(const Condition& condition) {
  return condition.range_max_m == 3.5 && condition.noise_variance_m2 == 0.1;
}

}  // namespace kidnapwatch::core::study
