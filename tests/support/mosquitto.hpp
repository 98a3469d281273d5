// SPDX-License-Identifier: Apache-2.0
// A real mosquitto of a test's own, to be stopped, killed and started again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <sys/types.h>

namespace kidnapwatch::test {

/// A folder that goes with the object.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

/// A port of 127.0.0.1 on which nobody listens now.
[[nodiscard]] std::uint16_t free_port();

/// Listens on a free port of 127.0.0.1, with the queue limits that INTERFACES asks for; it dies
/// with the test program. Throws std::runtime_error if it cannot be started.
class Mosquitto {
 public:
  /// `options`: lines to append to its configuration. Not running yet.
  explicit Mosquitto(const std::string& options = "allow_anonymous true");
  ~Mosquitto();
  Mosquitto(const Mosquitto&) = delete;
  Mosquitto& operator=(const Mosquitto&) = delete;

  /// Returns when it accepts connections. Always on the same port, with what it had persisted.
  void start();
  /// kill -9.
  void kill();
  /// SIGTERM, and waits for its end.
  void stop();

  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }
  [[nodiscard]] std::string url() const { return "mqtt://127.0.0.1:" + std::to_string(port_); }
  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_.path(); }

 private:
  void end(int signal);
  [[nodiscard]] bool accepts() const;

  TemporaryFolder folder_;
  std::uint16_t port_;
  pid_t pid_ = 0;
};

}  // namespace kidnapwatch::test
