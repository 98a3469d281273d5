// SPDX-License-Identifier: Apache-2.0
// `evaluate`: what is measured of detectors and baselines, one subcommand each.
#include <CLI/CLI.hpp>

#include "service/commands/commands.hpp"
#include "service/evaluate/localization.hpp"
#include "service/evaluate/logs.hpp"
#include "service/evaluate/paper.hpp"

namespace kidnapwatch::service {

void add_evaluate(CLI::App& app, Command& chosen) {
  auto* command = app.add_subcommand("evaluate", "Measure detectors and the baselines");
  command->require_subcommand(1);
  add_evaluate_localization(*command, chosen);
  add_evaluate_logs(*command, chosen);
  add_evaluate_paper(*command, chosen);
}

}  // namespace kidnapwatch::service
