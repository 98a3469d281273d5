// SPDX-License-Identifier: Apache-2.0
// Algorithm 2 for one trial: how far every detector's score stands out at every t_k.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/detector.hpp"
#include "core/study/trial.hpp"

namespace kidnapwatch::core::study {

/// First t_k that there is a performance index for: t = 2 has the first score.
inline constexpr std::size_t kFirstTk = 3;

/// What one detector said in one trial.
struct TrialRecord {
  std::string id;
  Polarity polarity = Polarity::hptf;
  std::vector<double> eta_prior;  ///< by t_k from kFirstTk to T; against what was before
  std::vector<double> eta_all;    ///< against all other steps
  std::vector<double> natural;    ///< scores of the run without a kidnapping, t = 2..T
  std::vector<double> kidnapped;  ///< scores at t_k, where there is one
};

using Scores = std::vector<std::optional<double>>;  ///< by step, from t = 1

/// Enters the run with a kidnapping at `t_k` into `record`, whose polarity is set.
void enter(const Scores& scores, std::size_t t_k, TrialRecord& record);

/// Enters the scores of the run without one.
void enter_natural(const Scores& scores, TrialRecord& record);

struct NamedDetector {
  std::string id;  ///< its name, and the reading of the paper that it stands for
  std::unique_ptr<Detector> detector;
};
using Detectors = std::vector<NamedDetector>;

/// Of detectors whose score depends on the last two scans alone, all of which are comparable: the
/// steps before and after a kidnapping have the same scores whenever it happens, so that each is
/// scored once. `make` makes fresh ones.
[[nodiscard]] std::vector<TrialRecord> pairwise_records(const Trial& trial,
                                                        const std::function<Detectors()>& make);

/// The same for any detectors: each spliced run is shown to fresh ones from its beginning. T / 3
/// times as slow.
[[nodiscard]] std::vector<TrialRecord> records(const Trial& trial,
                                               const std::function<Detectors()>& make);

}  // namespace kidnapwatch::core::study
