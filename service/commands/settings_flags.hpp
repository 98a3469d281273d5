// SPDX-License-Identifier: Apache-2.0
// Settings on the command line: --config, and a flag for every setting.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "service/settings.hpp"

namespace CLI {
class App;
}

namespace kidnapwatch::service {

class SettingsFlags {
 public:
  /// Adds --config and one flag per setting to `command`; --mqtt-url for "mqtt.url". Or only for
  /// the setting `only`.
  void add_to(CLI::App& command, const std::string& only = "");

  /// With the process's environment; without --config the file at its usual place, if it is there.
  /// Throws BadConfig.
  [[nodiscard]] LoadedSettings load() const;

  std::string file;

 private:
  std::map<std::string, std::string> given_;
};

}  // namespace kidnapwatch::service
