// SPDX-License-Identifier: Apache-2.0
// A client that sends exactly the bytes it is told to, polite or not.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace kidnapwatch::api {

struct Reply {
  int status = 0;  ///< 0: the connection ended instead
  std::string head;
  std::string body;
};

/// A TCP connection to 127.0.0.1. Gives up on a server that is silent for 30 s.
class Client {
 public:
  explicit Client(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const timeval patience{.tv_sec = 30, .tv_usec = 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      ::close(socket_);
      throw std::runtime_error("cannot connect");
    }
  }

  ~Client() {
    if (socket_ >= 0) {
      ::close(socket_);
    }
  }

  Client(Client&& other) noexcept
      : socket_(std::exchange(other.socket_, -1)), unread_(std::move(other.unread_)) {}
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// False if the server does not take it any more.
  bool send(std::string_view bytes) {
    while (!bytes.empty()) {
      const auto sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) {
        return false;
      }
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }

  bool get(const std::string& target) {
    return send("GET " + target + " HTTP/1.1\r\nHost: here\r\n\r\n");
  }

  void half_close() { ::shutdown(socket_, SHUT_WR); }

  /// Closes with a reset instead of a goodbye.
  void reset() {
    const linger at_once{.l_onoff = 1, .l_linger = 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    ::close(std::exchange(socket_, -1));
  }

  /// Whether there is something to read, or the end, within the time.
  bool readable(int within_ms) {
    pollfd one{.fd = socket_, .events = POLLIN, .revents = 0};
    return ::poll(&one, 1, within_ms) > 0;
  }

  /// The next response; `to_head` is for one without a body.
  Reply read(bool to_head = false) {
    Reply reply;
    std::size_t end = 0;
    while ((end = unread_.find("\r\n\r\n")) == std::string::npos) {
      if (!receive()) {
        return {};
      }
    }
    reply.head = take(end + 4);
    reply.status = std::stoi(reply.head.substr(reply.head.find(' ') + 1));
    const auto length = to_head ? 0 : content_length(reply.head);
    while (unread_.size() < length) {
      if (!receive()) {
        return {};
      }
    }
    reply.body = take(length);
    return reply;
  }

  /// So many bytes, fewer if the connection ended before.
  std::string read_some(std::size_t length) {
    while (unread_.size() < length && receive()) {
    }
    return take(length);
  }

  /// Everything up to the end of the connection.
  std::string read_to_end() {
    while (receive()) {
    }
    return take(unread_.size());
  }

 private:
  static std::size_t content_length(const std::string& head) {
    const auto at = head.find("Content-Length: ");
    return at == std::string::npos ? 0 : std::stoul(head.substr(at + 16));
  }

  bool receive() {
    char bytes[16384];
    const auto received = ::recv(socket_, bytes, sizeof bytes, 0);
    if (received > 0) {
      unread_.append(bytes, static_cast<std::size_t>(received));
    }
    return received > 0;
  }

  std::string take(std::size_t length) {
    auto taken = unread_.substr(0, length);
    unread_.erase(0, length);
    return taken;
  }

  int socket_;
  std::string unread_;
};

}  // namespace kidnapwatch::api
