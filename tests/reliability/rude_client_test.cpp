// SPDX-License-Identifier: Apache-2.0
// HTTP clients that say nothing, dribble or do not listen: they are cut, and nobody else notices.
#include <algorithm>
#include <array>
#include <chrono>
#include <deque>

#include <poll.h>
#include <sys/socket.h>

#include "tests/reliability/promise.hpp"
#include "tests/reliability/scale.hpp"
#include "tests/support/sockets.hpp"

namespace kidnapwatch::test {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;
using Seconds = std::chrono::duration<double>;

constexpr std::size_t kRounds = 25;  // until every client had its turn

enum class Manner : std::uint8_t { silent, slow_header, slow_body, deaf };

class RudeClient {
 public:
  RudeClient(std::uint16_t port, Manner manner) : socket_(connected_to(port)), manner_(manner) {
    const int small = 4096;
    ::setsockopt(socket_.fd(), SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    if (manner_ == Manner::slow_header) say("GET / HTTP/1.1\r\nHost: a\r\nX: ");
    if (manner_ == Manner::slow_body) {
      say("PUT /api/v1/config HTTP/1.1\r\nHost: a\r\nContent-Length: 60000\r\n\r\n");
    }
    for (int i = 0; manner_ == Manner::deaf && i < 50; ++i) {
      say("GET /api/v1/openapi.json HTTP/1.1\r\nHost: a\r\n\r\n");
    }
  }

  /// A little more of the same; notices the end.
  void go_on() {
    if (!socket_) return;
    if (manner_ != Manner::silent) say("x");
    if (manner_ != Manner::deaf) listen();
    pollfd one{.fd = socket_.fd(), .events = 0, .revents = 0};
    if (::poll(&one, 1, 0) > 0 && (one.revents & (POLLERR | POLLHUP)) != 0) end();
  }
  [[nodiscard]] bool is_cut() const { return !socket_; }
  [[nodiscard]] double lived_s() const { return lived_.count(); }

 private:
  void say(std::string_view bytes) const {
    (void)::send(socket_.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  }
  void listen() {
    std::array<char, 4096> bytes{};
    const auto got = ::recv(socket_.fd(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (got == 0 || (got < 0 && errno != EAGAIN)) end();
  }
  void end() {
    lived_ = Clock::now() - born_;
    socket_ = Socket();
  }

  Socket socket_;
  Manner manner_;
  Clock::time_point born_ = Clock::now();
  Seconds lived_{};
};

/// A request of somebody else, at another address; its status and how long it took.
struct Visit {
  int status = 0;
  double ms = 0.0;
};

Visit visit(std::uint16_t port) {
  const auto begin = Clock::now();
  const Socket socket = connected_to(port, 2);
  constexpr std::string_view kRequest =
      "GET /api/v1/robots HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n";
  (void)::send(socket.fd(), kRequest.data(), kRequest.size(), MSG_NOSIGNAL);
  std::string answer;
  std::array<char, 4096> bytes{};
  for (ssize_t got = 0; (got = ::recv(socket.fd(), bytes.data(), bytes.size(), 0)) > 0;) {
    answer.append(bytes.data(), static_cast<std::size_t>(got));
  }
  return {.status = answer.size() > 12 ? std::stoi(answer.substr(9, 3)) : 0,
          .ms = Milliseconds(Clock::now() - begin).count()};
}

double p99(std::vector<double> values) {
  std::ranges::sort(values);
  return values.at(values.size() * 99 / 100);
}

class Rude : public Promise {
 protected:
  void visit_all(int times, std::vector<double>& took_ms) {
    for (int i = 0; i < times; ++i) {
      const Visit one = visit(port_);
      EXPECT_EQ(one.status, 200);
      took_ms.push_back(one.ms);
    }
  }

  std::uint16_t port_ = 0;
};

TEST_F(Rude, ManySlowClientsAreCutAndOthersAreServed) {
  const int count = at_scale(300, 1000);
  const int manners = at_scale(2, 4);  // the others may take 10 s
  start_service({"--http-rate-limit-per-s", "0"});
  port_ = stack_.http_port();
  std::vector<double> before_ms;
  EXPECT_TRUE(eventually([&] {  // in the same rhythm
    visit_all(10, before_ms);
    return before_ms.size() >= 500;
  }));
  std::deque<RudeClient> clients;
  for (int i = 0; i < count; ++i) clients.emplace_back(port_, static_cast<Manner>(i % manners));
  std::vector<double> meanwhile_ms;
  std::size_t round = 0;
  const auto all_cut = [&] {  // each goes on about twice a second
    for (std::size_t i = round++ % kRounds; i < clients.size(); i += kRounds) clients[i].go_on();
    visit_all(10, meanwhile_ms);
    return std::ranges::all_of(clients, &RudeClient::is_cut);
  };
  EXPECT_TRUE(eventually(all_cut));
  const double longest_s = std::ranges::max_element(clients, {}, &RudeClient::lived_s)->lived_s();
  EXPECT_LT(longest_s, 15.0);  // 10 s, and a slow machine
  report(std::to_string(count) + " rude clients, the last one cut after " +
         std::to_string(longest_s) + " s; others' p99 " + std::to_string(p99(before_ms)) +
         " ms before, " + std::to_string(p99(meanwhile_ms)) + " ms meanwhile");
}

}  // namespace
}  // namespace kidnapwatch::test
