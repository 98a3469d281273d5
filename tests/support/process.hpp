// SPDX-License-Identifier: Apache-2.0
// A program run by a test, stopped with it, and what it printed.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace kidnapwatch::test {

class Process {
 public:
  /// Starts argv[0], found in PATH; standard output and error go to the two files. Throws
  /// std::system_error if it cannot be started.
  Process(const std::vector<std::string>& argv, const std::filesystem::path& out,
          const std::filesystem::path& err);
  /// Kills it if it still runs.
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  [[nodiscard]] pid_t pid() const noexcept { return pid_; }
  [[nodiscard]] bool running();
  void signal(int number) const;
  /// Waits for its end; the exit code, or 128 + the signal that ended it.
  int wait();

 private:
  pid_t pid_ = -1;
  int exit_code_ = -1;
};

/// Runs a program to its end; standard output. Fails the test if the exit code is not 0.
[[nodiscard]] std::string output_of(const std::vector<std::string>& argv);

[[nodiscard]] std::string content_of(const std::filesystem::path& file);

/// Looks every 20 ms until `holds`; false if that took longer than `patience`.
[[nodiscard]] bool eventually(const std::function<bool()>& holds,
                              std::chrono::seconds patience = std::chrono::seconds(30));

}  // namespace kidnapwatch::test
