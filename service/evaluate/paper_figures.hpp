// SPDX-License-Identifier: Apache-2.0
// The paper's figures, drawn from results.
#pragma once

#include <string>
#include <vector>

#include "service/evaluate/paper_study.hpp"

namespace kidnapwatch::service {

struct Figure {
  int number = 0;
  std::string svg;
  std::string caption;
};

/// Those of the figures 2, 3, 6-9, 13 and 15 that were asked for and whose systems were run.
[[nodiscard]] std::vector<Figure> paper_figures(const PaperResults& results,
                                                const PaperOptions& options);

}  // namespace kidnapwatch::service
