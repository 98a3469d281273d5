// SPDX-License-Identifier: Apache-2.0
// A real broker, a real service and the tools that people use with them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adapters/codecs/json.hpp"
#include "tests/support/mosquitto.hpp"
#include "tests/support/process.hpp"

namespace kidnapwatch::test {

using adapters::codecs::Json;

/// A message as mosquitto_sub received it.
struct Received {
  double at_s = 0.0;  ///< since the epoch
  std::string topic;
  std::string payload;
};

class Stack {
 public:
  /// Starts the broker.
  Stack() { broker.start(); }
  ~Stack();
  Stack(const Stack&) = delete;
  Stack& operator=(const Stack&) = delete;

  void start_service(const std::vector<std::string>& more_flags = {});
  void await_ready() const;
  void subscribe(const std::string& topic);

  /// Runs `kidnapwatch` with these words against the broker, to its end; its one line of JSON.
  Json robots(std::vector<std::string> words) const;
  /// The same, without waiting for its end.
  [[nodiscard]] std::unique_ptr<Process> robots_in_background(std::vector<std::string> words) const;
  void publish(const std::string& topic, const std::string& payload) const;

  /// Where the service serves REST, on 127.0.0.1.
  [[nodiscard]] std::uint16_t http_port() const;
  /// By curl; the body, whatever the status.
  [[nodiscard]] std::string get_text(const std::string& path) const;
  [[nodiscard]] Json get(const std::string& path) const;
  /// The answer, whatever the status.
  [[nodiscard]] Json post(const std::string& path, const std::string& body) const;
  /// By any method.
  [[nodiscard]] Json ask(const std::string& method, const std::string& path,
                         const std::string& body) const;
  /// With a bearer token, unless that is empty.
  [[nodiscard]] int status_of(const std::string& path, const std::string& token = "") const;
  /// Scans counted by the service under this outcome, or under all.
  [[nodiscard]] std::uint64_t counted(const std::string& outcome) const;
  [[nodiscard]] std::uint64_t counted() const;

  [[nodiscard]] std::vector<Received> received() const;
  [[nodiscard]] std::string service_log() const { return content_of(folder_.path() / "serve.log"); }
  [[nodiscard]] std::filesystem::path database() const {
    return store_file.empty() ? folder_.path() / "store.db" : store_file;
  }

  Mosquitto broker;
  std::string broker_url = broker.url();  ///< where the service looks for it
  std::filesystem::path store_file;       ///< empty: in a folder of its own
  std::vector<std::string> under;         ///< what the service is run by: faketime, fiu-run, ...
  std::unique_ptr<Process> service;

 private:
  [[nodiscard]] std::string url() const;
  void expect_no_finding() const;

  TemporaryFolder folder_;
  std::unique_ptr<Process> subscriber_;
};

}  // namespace kidnapwatch::test
