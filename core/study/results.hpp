// SPDX-License-Identifier: Apache-2.0
// The outcome of all trials, condition by condition, and the reading that it is looked at with.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/dissimilarity.hpp"
#include "core/study/stage.hpp"
#include "core/study/summary.hpp"

namespace kidnapwatch::core::study {

/// All trials on one stage.
struct Condition {
  std::string map;
  double range_max_m = 0.0;
  double noise_variance_m2 = 0.0;
  std::map<std::string, Summary> prior;  ///< by id
  std::map<std::string, Summary> all;
};

/// `trials` in order of their seeds, each as Stage::trial returned it. There is one.
[[nodiscard]] Condition condition(const Stage& stage,
                                  std::span<const std::vector<TrialRecord>> trials);

/// How the paper is read where it can be read in more than one way.
struct Reading {
  DissimilarityConfig dissimilarity;
  Polarity me_polarity = Polarity::lptf;
  evaluation::Evaluator evaluator = evaluation::Evaluator::prior;

  /// The id of the variant with this dimension and gate, all else as in `dissimilarity`.
  [[nodiscard]] std::string id(Dimension dimension, Gate gate) const;
};

/// The summaries by the evaluator that is asked for.
[[nodiscard]] const std::map<std::string, Summary>& summaries(const Condition& condition,
                                                              evaluation::Evaluator evaluator);

/// Whether it is the paper's own: reach 3.5 m, noise of variance 0.1.
[[nodiscard]] bool is_main(const Condition& condition);

}  // namespace kidnapwatch::core::study
