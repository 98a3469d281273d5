// SPDX-License-Identifier: Apache-2.0
// Sockets of the loopback interface.
#include "tests/support/sockets.hpp"

#include <cerrno>
#include <system_error>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace kidnapwatch::test {
namespace {

[[nodiscard]] sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

[[nodiscard]] Socket tcp_socket() {
  return Socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
}

void check(int result, const char* what) {
  if (result < 0) {
    throw std::system_error(errno, std::generic_category(), what);
  }
}

}  // namespace

Socket::~Socket() {
  if (fd_ >= 0) {
    ::close(fd_);
  }
}

Socket& Socket::operator=(Socket&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

Socket listening(std::uint16_t port) {
  Socket socket = tcp_socket();
  const int on = 1;
  ::setsockopt(socket.fd(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  const sockaddr_in address = loopback(port);
  check(::bind(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address), "bind");
  check(::listen(socket.fd(), 128), "listen");
  return socket;
}

std::uint16_t port_of(const Socket& socket) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  check(::getsockname(socket.fd(), reinterpret_cast<sockaddr*>(&address), &size), "getsockname");
  return ntohs(address.sin_port);
}

Socket connected_to(std::uint16_t port, std::uint8_t from) {
  Socket socket = tcp_socket();
  sockaddr_in own = loopback(0);
  own.sin_addr.s_addr = htonl((INADDR_LOOPBACK & ~0xffU) | from);
  check(::bind(socket.fd(), reinterpret_cast<const sockaddr*>(&own), sizeof own), "bind");
  const sockaddr_in address = loopback(port);
  const int result =
      ::connect(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  return result == 0 ? std::move(socket) : Socket();
}

Socket connecting_to(std::uint16_t port) {
  Socket socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const sockaddr_in address = loopback(port);
  const int result =
      ::connect(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  check(result < 0 && errno == EINPROGRESS ? 0 : result, "connect");
  return socket;
}

}  // namespace kidnapwatch::test
