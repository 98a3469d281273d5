// SPDX-License-Identifier: Apache-2.0
// The results of the paper's experiments as files: figures, a report, CSV, JSON.
#pragma once

#include <string>

#include "service/evaluate/paper_study.hpp"

namespace kidnapwatch::service {

/// Writes report.html, paper.json, summary.csv, eta.csv, roc.csv and figure-K.svg into options.out,
/// which is made if it is not there. `command` is how it was called, `date` when. Throws
/// BadInput naming --out if it cannot be written.
void write_report(const PaperResults& results, const PaperOptions& options,
                  const std::string& command, const std::string& date);

/// The claims and their verdicts as one line of JSON.
[[nodiscard]] std::string claims_json(const PaperResults& results, const PaperOptions& options);

}  // namespace kidnapwatch::service
