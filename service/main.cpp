// SPDX-License-Identifier: Apache-2.0
// The command line: which command, and how it ended.
#include <exception>
#include <iostream>

#include <CLI/CLI.hpp>

#include "core/bad_input.hpp"
#include "service/commands/commands.hpp"

namespace {

using namespace kidnapwatch;

int run(CLI::App& app, service::Command& chosen, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return chosen();
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? service::kOk : service::kUsage;
  } catch (const service::BadConfig& e) {
    std::cerr << "kidnapwatch: " << e.what() << '\n';
    return service::kConfig;
  } catch (const core::BadInput& e) {
    std::cerr << "kidnapwatch: " << e.what() << '\n';
    return service::kUsage;
  } catch (const std::exception& e) {
    std::cerr << "kidnapwatch: " << e.what() << '\n';
    return service::kFailed;
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"kidnapwatch: tells when a robot is somewhere other than it believes"};
  app.set_version_flag("--version", KW_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  service::Command chosen;
  service::add_serve(app, chosen);
  service::add_replay(app, chosen);
  service::add_simulate(app, chosen);
  service::add_token(app, chosen);
  service::add_evaluate(app, chosen);
  service::add_check_config(app, chosen);
  return run(app, chosen, argc, argv);
}
