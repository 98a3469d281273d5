// SPDX-License-Identifier: Apache-2.0
// The server over real sockets: what polite clients get.
#include "api/server.hpp"

#include <latch>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "client.hpp"

namespace kidnapwatch::api {
namespace {

/// Says what it was asked.
Response echo(const Request& request) {
  return {200, "text/plain", request.method + " " + request.target + " " + request.body};
}

ServerConfig any_port() {
  ServerConfig config;
  config.port = 0;
  return config;
}

bool says(const Reply& reply, std::string_view header) {
  return reply.head.find(std::string(header) + "\r\n") != std::string::npos;
}

TEST(Server, AnswersAgainAndAgainOverOneConnection) {
  const Server server(any_port(), echo);
  Client client(server.port());
  for (int i = 0; i < 3; ++i) {
    client.get("/" + std::to_string(i));
    const auto reply = client.read();
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(reply.body, "GET /" + std::to_string(i) + " ");
    EXPECT_TRUE(says(reply, "Content-Type: text/plain"));
    EXPECT_TRUE(says(reply, "X-Content-Type-Options: nosniff"));
    EXPECT_NE(reply.head.find("Date: "), std::string::npos);
  }
}

TEST(Server, AnswersPipelinedRequestsInOrder) {
  const Server server(any_port(), echo);
  Client client(server.port());
  std::string requests;
  for (int i = 0; i < 100; ++i) {
    requests += "PUT /" + std::to_string(i) + " HTTP/1.1\r\nHost: a\r\nContent-Length: 2\r\n\r\nxy";
  }
  client.send(requests);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(client.read().body, "PUT /" + std::to_string(i) + " xy");
  }
}

TEST(Server, HandsOverHeadersBodyAndPeer) {
  Request seen;
  {
    const Server server(any_port(), [&](const Request& request) {
      seen = request;
      return echo(request);
    });
    Client client(server.port());
    client.send(
        "PUT /a?b=%20 HTTP/1.1\r\nHost: here\r\nX-Odd:  spaced \r\nContent-Length: 4\r\n\r\nbody");
    EXPECT_EQ(client.read().status, 200);
  }
  EXPECT_EQ(seen.method, "PUT");
  EXPECT_EQ(seen.target, "/a?b=%20");
  EXPECT_EQ(header(seen, "x-odd"), "spaced");
  EXPECT_EQ(seen.body, "body");
  EXPECT_EQ(seen.peer, "127.0.0.1");
}

TEST(Server, TakesChunkedBodies) {
  const Server server(any_port(), echo);
  Client client(server.port());
  client.send(
      "PUT / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: "
      "chunked\r\n\r\n2\r\nab\r\n1\r\nc\r\n0\r\n\r\n");
  EXPECT_EQ(client.read().body, "PUT / abc");
}

TEST(Server, LeavesOutTheBodyForHead) {
  const Server server(any_port(), echo);
  Client client(server.port());
  client.send("HEAD /a HTTP/1.1\r\nHost: a\r\n\r\nGET /b HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_TRUE(says(client.read(true), "Content-Length: 8"));
  EXPECT_EQ(client.read().body, "GET /b ");
}

TEST(Server, SendsNoContentWhereThereIsNone) {
  const Server server(any_port(), [](const Request& request) {
    return request.target == "/old" ? Response{304, "", "", {{"ETag", "\"1\""}}} : echo(request);
  });
  Client client(server.port());
  client.get("/old");
  client.get("/new");
  const auto reply = client.read();
  EXPECT_EQ(reply.status, 304);
  EXPECT_TRUE(says(reply, "ETag: \"1\""));
  EXPECT_EQ(client.read().body, "GET /new ");
}

TEST(Server, InvitesTheBodyOfAClientThatWaits) {
  const Server server(any_port(), echo);
  Client client(server.port());
  client.send("PUT / HTTP/1.1\r\nHost: a\r\nExpect: 100-continue\r\nContent-Length: 1\r\n\r\n");
  EXPECT_EQ(client.read().status, 100);
  client.send("x");
  EXPECT_EQ(client.read().body, "PUT / x");
}

TEST(Server, ClosesWhenItIsAskedTo) {
  const Server server(any_port(), echo);
  Client client(server.port());
  client.send("GET / HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n");
  EXPECT_TRUE(says(client.read(), "Connection: close"));
  EXPECT_EQ(client.read_to_end(), "");
}

TEST(Server, ClosesAfterEveryAnswerInHttp10) {
  const Server server(any_port(), echo);
  Client client(server.port());
  client.send("GET / HTTP/1.0\r\nConnection: keep-alive\r\n\r\n");
  EXPECT_EQ(client.read().body, "GET / ");
  EXPECT_EQ(client.read_to_end(), "");
}

TEST(Server, AnswersAClientThatClosedItsSide) {
  const Server server(any_port(), echo);
  Client client(server.port());
  client.get("/1");
  client.get("/2");
  client.half_close();
  EXPECT_EQ(client.read().body, "GET /1 ");
  EXPECT_EQ(client.read().body, "GET /2 ");
  EXPECT_EQ(client.read_to_end(), "");
}

TEST(Server, AnswersWith500WhatIsThrown) {
  const Server server(any_port(),
                      [](const Request&) -> Response { throw std::runtime_error("secret"); });
  Client client(server.port());
  client.get("/");
  const auto reply = client.read();
  EXPECT_EQ(reply.status, 500);
  EXPECT_EQ(reply.body.find("secret"), std::string::npos);
}

TEST(Server, ServesManyClientsOnSeveralThreads) {
  auto config = any_port();
  config.threads = 4;
  const Server server(config, echo);
  constexpr int kClients = 8;
  std::vector<std::jthread> clients;
  clients.reserve(kClients);
  for (int c = 0; c < kClients; ++c) {
    clients.emplace_back([&, c] {
      Client client(server.port());
      for (int i = 0; i < 50; ++i) {
        const auto target = "/" + std::to_string(c) + "/" + std::to_string(i);
        client.get(target);
        EXPECT_EQ(client.read().body, "GET " + target + " ");
      }
    });
  }
}

TEST(Server, SaysWhereItCannotListen) {
  const Server server(any_port(), echo);
  auto config = any_port();
  config.port = server.port();
  try {
    const Server second(config, echo);
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), "cannot listen on 127.0.0.1:" + std::to_string(config.port) +
                                ": Address already in use");
  }
  config.address = "localhost";
  EXPECT_THROW(Server(config, echo), std::runtime_error);
}

TEST(Server, ListensOnIpv6) {
  auto config = any_port();
  config.address = "::1";
  const Server server(config, echo);
  EXPECT_NE(server.port(), 0);
}

TEST(Server, FinishesAnAnswerBeforeItStops) {
  std::latch asked(1);
  std::latch told(1);
  std::optional<Server> server(std::in_place, any_port(), [&](const Request& request) {
    asked.count_down();
    told.wait();
    return echo(request);
  });
  Client client(server->port());
  client.get("/slow");
  asked.wait();
  std::jthread stopping([&] { server.reset(); });
  told.count_down();
  EXPECT_EQ(client.read().body, "GET /slow ");
  EXPECT_EQ(client.read_to_end(), "");
}

TEST(Server, StopsWhateverClientsAreAt) {
  for (int round = 0; round < 20; ++round) {
    std::vector<Client> clients;
    auto config = any_port();
    config.threads = 2;
    std::optional<Server> server(std::in_place, config, echo);
    for (const char* text :
         {"", "G", "GET / HTTP/1.1\r\n", "GET / HTTP/1.1\r\nHost: a\r\n\r\n",
          "PUT / HTTP/1.1\r\nHost: a\r\nContent-Length: 9\r\n\r\nabc", "garbage\r\n\r\n"}) {
      clients.emplace_back(server->port()).send(text);
    }
    server.reset();
    for (auto& client : clients) {
      client.read_to_end();  // ends
    }
  }
}

/// Says what it is given, and ends with "end".
class Told final : public Feed {
 public:
  std::optional<std::string> next() override {
    const std::lock_guard lock(mutex_);
    auto text = std::exchange(text_, "");
    return text == "end" ? std::nullopt : std::optional(text);
  }
  void say(const std::string& text) {
    const std::lock_guard lock(mutex_);
    text_ += text;
  }

 private:
  std::mutex mutex_;
  std::string text_;
};

class ServerFeed : public ::testing::Test {
 protected:
  ServerFeed() { config_.max_feeds = 1; }

  Response answer() {
    Response response{200, "text/event-stream", ""};
    response.feed = told_;
    return response;
  }

  std::shared_ptr<Told> told_ = std::make_shared<Told>();
  ServerConfig config_ = any_port();
};

TEST_F(ServerFeed, SendsWhatComesUpUntilItEnds) {
  const Server server(config_, [this](const Request&) { return answer(); });
  Client client(server.port());
  client.get("/");
  const auto head = client.read().head;
  EXPECT_NE(head.find("200 OK"), std::string::npos);
  EXPECT_NE(head.find("Content-Type: text/event-stream"), std::string::npos);
  EXPECT_EQ(head.find("Content-Length"), std::string::npos);
  told_->say("one");
  EXPECT_EQ(client.read_some(3), "one");
  told_->say("two");
  EXPECT_EQ(client.read_some(3), "two");
  told_->say("end");
  EXPECT_EQ(client.read_to_end(), "");
}

TEST_F(ServerFeed, RefusesOneTooManyAndTakesItWhenAnotherLeft) {
  const Server server(config_, [this](const Request&) { return answer(); });
  {
    Client first(server.port());
    first.get("/");
    (void)first.read();
    Client second(server.port());
    second.get("/");
    EXPECT_EQ(second.read().status, 503);
  }
  int status = 503;
  while (status == 503) {  // until it is heard that the first one left
    Client third(server.port());
    third.get("/");
    status = third.read().status;
  }
  EXPECT_EQ(status, 200);
}

TEST_F(ServerFeed, ThatIsAskedForByHeadHasNone) {
  const Server server(config_, [this](const Request&) { return answer(); });
  Client client(server.port());
  client.send("HEAD / HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_EQ(client.read(true).status, 200);
  told_->say("nobody hears this");
  EXPECT_EQ(client.read_to_end(), "");
}

TEST_F(ServerFeed, EndsWithTheServer) {
  Client client = [&] {
    const Server server(config_, [this](const Request&) { return answer(); });
    Client follower(server.port());
    follower.get("/");
    (void)follower.read();
    return follower;
  }();
  EXPECT_EQ(client.read_to_end(), "");
}

TEST_F(ServerFeed, CutsAClientThatDoesNotTakeIt) {
  config_.write_timeout = std::chrono::milliseconds(200);
  const Server server(config_, [this](const Request&) { return answer(); });
  Client client(server.port());
  client.get("/");
  (void)client.read();
  told_->say(std::string(64U << 20U, 'x'));  // more than all buffers on the way hold
  while (told_.use_count() > 1) {
    std::this_thread::yield();
  }
}

}  // namespace
}  // namespace kidnapwatch::api
