// SPDX-License-Identifier: Apache-2.0
// The commands of the command line. Each adds its subcommand, and what to run if it is chosen.
#pragma once

#include <functional>

#include "core/bad_input.hpp"

namespace CLI {
class App;
}

namespace kidnapwatch::service {

/// Runs to the end of the work; the result is the exit code.
using Command = std::function<int()>;

inline constexpr int kOk = 0;
inline constexpr int kFailed = 1;
inline constexpr int kUsage = 2;
inline constexpr int kConfig = 78;  // EX_CONFIG of sysexits.h

/// The configuration cannot be used; the exit code is kConfig.
class BadConfig : public core::BadInput {
 public:
  explicit BadConfig(const core::BadInput& why) : BadInput(why.field(), why.reason()) {}
};

void add_serve(CLI::App& app, Command& chosen);
void add_replay(CLI::App& app, Command& chosen);
void add_simulate(CLI::App& app, Command& chosen);
void add_token(CLI::App& app, Command& chosen);
void add_check_config(CLI::App& app, Command& chosen);
void add_evaluate(CLI::App& app, Command& chosen);
void add_evaluate_localization(CLI::App& evaluate_command, Command& chosen);
void add_evaluate_logs(CLI::App& evaluate_command, Command& chosen);

}  // namespace kidnapwatch::service
