// SPDX-License-Identifier: Apache-2.0
// Many trials of a detector in one line: what the paper's figures show.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/evaluation/performance_index.hpp"
#include "core/evaluation/roc.hpp"
#include "core/study/algorithm2.hpp"

namespace kidnapwatch::core::study {

/// A detector over all trials of one map and noise: Algorithm 2, line 6.
struct Summary {
  std::string id;
  Polarity polarity = Polarity::hptf;
  std::vector<double> eta;              ///< by t_k from kFirstTk: mean over the trials
  std::vector<double> undetected;       ///< by t_k: share of trials with eta <= 0
  evaluation::Performance performance;  ///< over all trials and t_k
  double dips = 0.0;                    ///< share of t_k whose mean eta is <= 0: black in the paper
  evaluation::Roc roc;                  ///< of the scores at t_k against those of natural runs
};

/// Of the same detector's records, one per trial, in order of trials. There is one.
[[nodiscard]] Summary summary(std::span<const TrialRecord* const> trials,
                              evaluation::Evaluator evaluator);

}  // namespace kidnapwatch::core::study
