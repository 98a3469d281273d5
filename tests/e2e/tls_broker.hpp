// SPDX-License-Identifier: Apache-2.0
// The broker as deploy/mosquitto-tls.conf sets it up, with authorities and certificates of its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/mosquitto.hpp"
#include "tests/support/process.hpp"

namespace kidnapwatch::test {

class TlsBroker {
 public:
  /// Starts it. There are the authorities robots, operators and strangers, and certificates for the
  /// users kidnapwatch, dashboard and controller and for these `robots`.
  explicit TlsBroker(const std::vector<std::string>& robots);

  /// A path in its folder: NAME.crt, NAME.key, NAME-ca.crt, trusted.crt (of robots and operators).
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  /// "-h 127.0.0.1 -p ... --cert ..." behind one of mosquitto's programs, as this user.
  [[nodiscard]] std::vector<std::string> words(const std::string& program, const std::string& user,
                                               std::uint16_t port) const;
  /// What a service needs to come in.
  [[nodiscard]] std::vector<std::string> service_flags(const std::string& ca = "operators") const;
  [[nodiscard]] std::string service_url() const {
    return "mqtts://127.0.0.1:" + std::to_string(operators_port);
  }
  /// A listener in the clear, which the shipped file does not have, for simulated robots.
  [[nodiscard]] std::string plain_url() const {
    return "mqtt://127.0.0.1:" + std::to_string(plain_port_);
  }

  const std::uint16_t robots_port = free_port();
  const std::uint16_t operators_port = free_port();

 private:
  void sh(const std::string& script) const;
  /// `name`.key and `name`.crt, signed by this authority.
  void certify(const std::string& name, const std::string& ca, const std::string& cn) const;
  void start();

  TemporaryFolder folder_;
  const std::uint16_t plain_port_ = free_port();
  std::unique_ptr<Process> broker_;
};

}  // namespace kidnapwatch::test
