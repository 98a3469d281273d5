// SPDX-License-Identifier: Apache-2.0
// Which of Debian's packages are there, for tests of examples that need them.
#pragma once

#include <cstdlib>
#include <string>

namespace kidnapwatch::test {

/// Whether the shell finds the program, or a path to it.
inline bool has_program(const std::string& name) {
  const std::string command = "command -v " + name + " > /dev/null";
  return std::system(command.c_str()) == 0;  // NOLINT(concurrency-mt-unsafe): one thread
}

/// python3-paho-mqtt, for Debian's own Python.
inline bool has_paho() {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): one thread
  return std::system("/usr/bin/python3 -c 'import paho.mqtt' 2> /dev/null") == 0;
}

}  // namespace kidnapwatch::test
