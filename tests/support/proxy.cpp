// SPDX-License-Identifier: Apache-2.0
// The proxy's one thread: polls all sockets and passes bytes on, or does not.
#include "tests/support/proxy.hpp"

#include <array>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace kidnapwatch::test {
namespace {

/// With this, close() sends a reset at once instead of saying goodbye.
void reset_on_close(const Socket& socket) {
  const linger now{.l_onoff = 1, .l_linger = 0};
  ::setsockopt(socket.fd(), SOL_SOCKET, SO_LINGER, &now, sizeof now);
}

[[nodiscard]] bool send_all(int fd, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t sent = ::send(fd, bytes, count, MSG_NOSIGNAL);
    if (sent <= 0) {
      return false;
    }
    bytes += sent;
    count -= static_cast<std::size_t>(sent);
  }
  return true;
}

}  // namespace

Proxy::Proxy(std::uint16_t target_port)
    : target_port_(target_port),
      listener_(listening(0)),
      port_(port_of(listener_)),
      thread_([this] { run(); }) {}

Proxy::~Proxy() {
  stopping_ = true;
  thread_.join();
}

void Proxy::cut() {
  cutting_ = true;
  cutting_.wait(true);
}

void Proxy::run() {
  while (!stopping_) {
    if (cutting_) {
      for (const Pair& pair : pairs_) {
        reset_on_close(pair.client);
        reset_on_close(pair.target);
      }
      pairs_.clear();
      cutting_ = false;
      cutting_.notify_all();
    }
    pass_all();
  }
  cutting_ = false;
  cutting_.notify_all();
}

void Proxy::pass_all() {
  std::vector<pollfd> polled{{listener_.fd(), POLLIN, 0}};
  for (const Pair& pair : pairs_) {
    polled.push_back({pair.client.fd(), POLLIN, 0});
    polled.push_back({pair.target.fd(), POLLIN, 0});
  }
  ::poll(polled.data(), polled.size(), 5);
  std::vector<Pair> alive;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    Pair& pair = pairs_[i];
    const bool up = polled[1 + 2 * i].revents == 0 || pass(pair.client, pair.target);
    const bool down = polled[2 + 2 * i].revents == 0 || pass(pair.target, pair.client);
    if (up && down) {
      alive.push_back(std::move(pair));
    }
  }
  pairs_ = std::move(alive);
  if (polled[0].revents != 0) {
    accept_one();
  }
}

void Proxy::accept_one() {
  Socket client(::accept4(listener_.fd(), nullptr, nullptr, SOCK_CLOEXEC));
  Socket target = connected_to(target_port_);
  if (client && target) {
    pairs_.push_back({std::move(client), std::move(target)});
  }
}

bool Proxy::pass(const Socket& from, const Socket& to) const {
  std::array<char, 65536> bytes{};
  const ssize_t count = ::recv(from.fd(), bytes.data(), bytes.size(), 0);
  if (count <= 0) {
    return false;
  }
  return swallowing_ || send_all(to.fd(), bytes.data(), static_cast<std::size_t>(count));
}

}  // namespace kidnapwatch::test
