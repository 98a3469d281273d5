// SPDX-License-Identifier: Apache-2.0
// Sockets of the loopback interface, as tests need them.
#pragma once

#include <cstdint>
#include <utility>

namespace kidnapwatch::test {

/// A file descriptor that is closed with the object.
class Socket {
 public:
  Socket() = default;
  explicit Socket(int fd) : fd_(fd) {}
  ~Socket();
  Socket(Socket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Socket& operator=(Socket&& other) noexcept;

  [[nodiscard]] int fd() const noexcept { return fd_; }
  explicit operator bool() const noexcept { return fd_ >= 0; }

 private:
  int fd_ = -1;
};

/// Listens on 127.0.0.1; port 0: any free one. Throws std::system_error.
[[nodiscard]] Socket listening(std::uint16_t port);
/// Where a socket is bound.
[[nodiscard]] std::uint16_t port_of(const Socket& socket);
/// Connected to 127.0.0.1:port, from 127.0.0.`from`; empty if nobody listens there.
[[nodiscard]] Socket connected_to(std::uint16_t port, std::uint8_t from = 1);
/// On its way to 127.0.0.1:port, and never blocking: writable when it is there.
[[nodiscard]] Socket connecting_to(std::uint16_t port);

}  // namespace kidnapwatch::test
