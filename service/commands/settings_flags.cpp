// SPDX-License-Identifier: Apache-2.0
// Settings on the command line.
#include "service/commands/settings_flags.hpp"

#include <algorithm>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "service/commands/commands.hpp"

namespace kidnapwatch::service {
namespace {

constexpr const char* kUsualFile = "/etc/kidnapwatch/kidnapwatch.toml";

std::string flag_name(const Setting& setting) {
  std::string name = "--" + setting.key;
  std::ranges::replace(name, '.', '-');
  std::ranges::replace(name, '_', '-');
  return name;
}

}  // namespace

void SettingsFlags::add_to(CLI::App& command, const std::string& only) {
  command.add_option("--config", file, std::string("TOML file (default ") + kUsualFile + ")");
  for (const auto& setting : all_settings()) {
    if (!setting.secret &&
        (only.empty() ||
         setting.key == only)) {  // a command line is seen by everybody on the machine
      const std::string key = setting.key;
      command
          .add_option_function<std::string>(
              flag_name(setting), [this, key](const std::string& text) { given_[key] = text; },
              setting.help)
          ->group("Settings");
    }
  }
}

LoadedSettings SettingsFlags::load() const {
  Sources sources{.environment = process_environment, .flags = given_};
  if (!file.empty()) {
    sources.file = file;
  } else if (std::filesystem::exists(kUsualFile)) {
    sources.file = kUsualFile;
  }
  try {
    return load_settings(sources);
  } catch (const core::BadInput& bad) {
    throw BadConfig(bad);
  }
}

}  // namespace kidnapwatch::service
