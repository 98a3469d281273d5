// SPDX-License-Identifier: Apache-2.0
// Runs the paper's experiments on all cores: trials, recorded runs, labelled scores.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/evaluation/roc.hpp"
#include "core/study/recorded.hpp"
#include "core/study/results.hpp"

namespace kidnapwatch::service {

struct PaperOptions {
  std::filesystem::path out;
  std::filesystem::path data = "../shared/data";  ///< recorded runs, where there are any
  std::size_t trials = 20;
  std::size_t steps = 100;
  std::size_t particles = 2000;
  std::size_t kidnappings = 100;  ///< cut into each recorded run
  std::uint64_t seed = 1;
  std::size_t threads = 0;   ///< 0: one per core
  std::vector<int> figures;  ///< none: all
  bool json = false;
  core::study::Reading reading;

  /// Whether any of `wanted` is asked for.
  [[nodiscard]] bool wants(std::initializer_list<int> wanted) const;
};

/// One ROC curve, and what it is of.
struct NamedRoc {
  std::string id;
  core::evaluation::Roc roc;
  double median_auc = 0.0;  ///< over the runs, each with its own curve
};

/// Section 5: curves of the single scores, and of their logistic regression on runs left out.
struct RocStudy {
  std::string of;  ///< which runs
  std::size_t runs = 0;
  std::vector<NamedRoc> single;
  std::optional<NamedRoc> regression;
  std::vector<std::pair<std::string, std::size_t>> selected;  ///< in how many of the models
};

struct PaperResults {
  std::vector<core::study::Condition> conditions;
  std::optional<RocStudy> roc;     ///< figures 13 and 15
  std::optional<RocStudy> milvus;  ///< of the labelled real runs
  double seconds = 0.0;
};

/// All that the options ask for. The numbers do not depend on the number of threads.
[[nodiscard]] PaperResults run_paper(const PaperOptions& options);

}  // namespace kidnapwatch::service
