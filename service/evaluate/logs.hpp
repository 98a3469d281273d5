// SPDX-License-Identifier: Apache-2.0
// `evaluate logs`: would the detectors fit these robots?
#pragma once

#include "service/commands/commands.hpp"

namespace kidnapwatch::service {

void add_evaluate_logs(CLI::App& evaluate, Command& chosen);

}  // namespace kidnapwatch::service
