// SPDX-License-Identifier: Apache-2.0
// HTTP/1.1 over TCP or TLS: connections in, requests to a function, responses out.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "api/http.hpp"

namespace kidnapwatch::api {

/// Everything is bounded: what a client may send, how long it may take, how many there may be.
struct ServerConfig {
  std::string address = "127.0.0.1";  ///< IPv4 or IPv6, numeric
  std::uint16_t port = 8080;          ///< 0: any free one
  std::string cert_file;              ///< PEM, the chain from the server's own up; empty: no TLS
  std::string key_file;               ///< PEM, of that certificate
  std::size_t threads = 1;            ///< that answer requests
  std::size_t max_connections = 256;  ///< beyond: 503
  std::size_t max_connections_per_peer = 256;
  std::size_t max_feeds = 128;                ///< responses without an end, at a time; beyond: 503
  std::chrono::milliseconds feed_every{100};  ///< that a silent one is looked after
  std::uint32_t max_header_bytes = 8'192;
  std::uint64_t max_body_bytes = 65'536;
  std::chrono::milliseconds header_timeout{5'000};  ///< from its first byte to its last
  std::chrono::milliseconds body_timeout{10'000};   ///< of a request
  std::chrono::milliseconds write_timeout{10'000};  ///< of a response
  std::chrono::milliseconds idle_timeout{60'000};   ///< between two requests
  std::chrono::milliseconds linger_timeout{2'000};  ///< for a refused client to read why
};

/// Serves from construction to destruction.
class Server {
 public:
  /// Called on any of the threads, several at a time if there are several. What it throws becomes
  /// a 500.
  using Answer = std::function<Response(const Request&)>;

  /// Throws std::runtime_error naming the address if it cannot listen there, or the file that is no
  /// certificate or no key of it.
  Server(const ServerConfig& config, Answer answer);

  /// Takes no more connections, finishes the responses that are being made, waits for clients to
  /// take them for linger_timeout at most, and stops.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// On which it listens.
  [[nodiscard]] std::uint16_t port() const;

 private:
  class Listener;
  std::unique_ptr<Listener> listener_;
};

}  // namespace kidnapwatch::api
