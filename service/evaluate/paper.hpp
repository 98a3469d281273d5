// SPDX-License-Identifier: Apache-2.0
// `evaluate paper`: the paper's experiments, and a report of what holds.
#pragma once

#include "service/commands/commands.hpp"

namespace kidnapwatch::service {

void add_evaluate_paper(CLI::App& evaluate, Command& chosen);

}  // namespace kidnapwatch::service
