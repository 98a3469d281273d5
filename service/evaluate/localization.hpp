// SPDX-License-Identifier: Apache-2.0
// `evaluate localization`: how well Monte Carlo localization follows a recorded run.
#pragma once

#include "service/commands/commands.hpp"

namespace kidnapwatch::service {

/// Adds the subcommand to `evaluate`.
void add_evaluate_localization(CLI::App& evaluate, Command& chosen);

}  // namespace kidnapwatch::service
