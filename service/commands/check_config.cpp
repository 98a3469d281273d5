// SPDX-License-Identifier: Apache-2.0
// `check-config`: would `serve` start with this, and what does each setting come to?
#include <iomanip>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "service/commands/commands.hpp"
#include "service/commands/settings_flags.hpp"

namespace kidnapwatch::service {
namespace {

void show(const LoadedSettings& loaded) {
  for (const auto& setting : all_settings()) {
    std::cout << std::left << std::setw(28) << setting.key << ' ' << std::setw(32)
              << setting.show(loaded.settings) << "  # " << loaded.origins.at(setting.key) << '\n';
  }
}

}  // namespace

void add_check_config(CLI::App& app, Command& chosen) {
  auto* command = app.add_subcommand("check-config", "Check a configuration without starting");
  command->footer("Example: kidnapwatch check-config /etc/kidnapwatch/kidnapwatch.toml --show");
  const auto flags = std::make_shared<SettingsFlags>();
  const auto shows = std::make_shared<bool>(false);
  flags->add_to(*command);
  command->add_option("FILE", flags->file, "The TOML file, as with --config");
  command->add_flag("--show", *shows, "Print every setting and where it came from");
  command->callback([=, &chosen] {
    chosen = [=] {
      const LoadedSettings loaded = flags->load();
      if (*shows) {
        show(loaded);
      }
      std::cout << "The configuration is good.\n";
      return kOk;
    };
  });
}

}  // namespace kidnapwatch::service
