// SPDX-License-Identifier: Apache-2.0
// The server over real sockets: what slow, greedy and broken clients get.
#include <atomic>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "api/server.hpp"
#include "client.hpp"

namespace kidnapwatch::api {
namespace {

using std::chrono::milliseconds;

Response ok(const Request& /*request*/) { return {200, "text/plain", "ok"}; }

/// Impatient, so that the tests need not be patient.
ServerConfig impatient() {
  ServerConfig config;
  config.port = 0;
  config.header_timeout = milliseconds{100};
  config.body_timeout = milliseconds{100};
  config.write_timeout = milliseconds{100};
  config.idle_timeout = milliseconds{100};
  config.linger_timeout = milliseconds{100};
  return config;
}

/// Patient for a minute, for tests in which nothing may be cut.
ServerConfig patient() {
  ServerConfig config;
  config.port = 0;
  config.header_timeout = std::chrono::minutes{1};
  return config;
}

std::string put(std::size_t length) {
  return "PUT / HTTP/1.1\r\nHost: a\r\nContent-Length: " + std::to_string(length) + "\r\n\r\n";
}

/// A fresh client still gets an answer.
void expect_serves(const Server& server) {
  Client client(server.port());
  client.get("/");
  EXPECT_EQ(client.read().status, 200);
}

TEST(ServerAbuse, CutsAHeaderThatDribbles) {
  const Server server(impatient(), ok);
  Client client(server.port());
  client.send("GET / HTTP/1.1\r\nHost: a\r\nX: ");
  while (!client.readable(5) && client.send("x")) {
  }
  EXPECT_EQ(client.read().status, 408);
  EXPECT_EQ(client.read_to_end(), "");
}

TEST(ServerAbuse, CutsABodyThatDribbles) {
  const Server server(impatient(), ok);
  Client client(server.port());
  client.send(put(60'000));
  while (!client.readable(5) && client.send("x")) {
  }
  EXPECT_EQ(client.read().status, 408);
}

TEST(ServerAbuse, ClosesSilentlyOnAClientThatNeverAsks) {
  const Server server(impatient(), ok);
  Client client(server.port());
  EXPECT_EQ(client.read_to_end(), "");
}

TEST(ServerAbuse, ClosesSilentlyOnAClientThatAsksNoMore) {
  const Server server(impatient(), ok);
  Client client(server.port());
  client.get("/");
  EXPECT_EQ(client.read().status, 200);
  EXPECT_EQ(client.read_to_end(), "");
}

TEST(ServerAbuse, CutsAClientThatDoesNotReadItsAnswer) {
  auto config = impatient();
  config.max_connections = 1;
  std::atomic<bool> first{true};
  const Server server(config, [&](const Request&) {
    return Response{200, "text/plain", std::string(first.exchange(false) ? 64 << 20 : 2, 'x')};
  });
  Client greedy(server.port());
  greedy.get("/");
  ASSERT_TRUE(greedy.readable(30'000));
  Reply reply;
  do {  // refused for as long as the greedy one is there
    Client next(server.port());
    next.get("/");
    reply = next.read();
  } while (reply.status != 200);
  EXPECT_LT(greedy.read_to_end().size(), std::size_t{64} << 20);
}

TEST(ServerAbuse, RefusesAHeaderAbove8kB) {
  const Server server(patient(), ok);
  const auto request = [](std::size_t length) {
    const std::string around = "GET / HTTP/1.1\r\nHost: a\r\nX: \r\n\r\n";
    return "GET / HTTP/1.1\r\nHost: a\r\nX: " + std::string(length - around.size(), 'x') +
           "\r\n\r\n";
  };
  Client fitting(server.port());
  fitting.send(request(8'192));
  EXPECT_EQ(fitting.read().status, 200);
  for (const std::size_t length : {8'193, 9'000, 100'000, 5'000'000}) {
    Client client(server.port());
    client.send(request(length));
    EXPECT_EQ(client.read().status, 431) << length;
    EXPECT_EQ(client.read_to_end(), "");
  }
}

TEST(ServerAbuse, RefusesManyHeadersToo) {
  const Server server(patient(), ok);
  Client client(server.port());
  std::string request = "GET / HTTP/1.1\r\nHost: a\r\n";
  for (int i = 0; i < 1000; ++i) {
    request += "X" + std::to_string(i) + ": y\r\n";
  }
  client.send(request + "\r\n");
  EXPECT_EQ(client.read().status, 431);
}

TEST(ServerAbuse, RefusesABodyAbove64kBButTakesThatMuch) {
  const Server server(patient(), ok);
  Client client(server.port());
  client.send(put(65'536) + std::string(65'536, 'x'));
  EXPECT_EQ(client.read().status, 200);
  client.send(put(65'537) + std::string(65'537, 'x'));
  EXPECT_EQ(client.read().status, 413);
  EXPECT_EQ(client.read_to_end(), "");
}

TEST(ServerAbuse, RefusesAChunkedBodyThatGrowsTooLong) {
  const Server server(patient(), ok);
  Client client(server.port());
  client.send("PUT / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n");
  for (int i = 0; i < 100; ++i) {
    client.send("400\r\n" + std::string(1024, 'x') + "\r\n");
  }
  EXPECT_EQ(client.read().status, 413);
}

TEST(ServerAbuse, RefusesWhatIsNotHttp) {
  const Server server(patient(), ok);
  for (const std::string text :
       {"garbage\r\n\r\n", "\x16\x03\x01\x02\x05\x01\r\n\r\n", "GET /\r\n\r\n",
        "GET / HTTP/9.9\r\n\r\n", "GET  / HTTP/1.1\r\nHost: a\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: a\r\nbroken\r\n\r\n", "GET / HTTP/1.1\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n",
        "PUT / HTTP/1.1\r\nHost: a\r\nContent-Length: -1\r\n\r\n",
        "PUT / HTTP/1.1\r\nHost: a\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\nab",
        "PUT / HTTP/1.1\r\nHost: a\r\nContent-Length: 1\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n",
        "PUT / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n",
        "PUT / HTTP/1.1\r\nHost: a\r\nExpect: a miracle\r\nContent-Length: 1\r\n\r\nx"}) {
    Client client(server.port());
    client.send(text);
    const auto reply = client.read();
    EXPECT_TRUE(reply.status == 400 || reply.status == 417 || reply.status == 505)
        << reply.status << " to " << text;
    EXPECT_NE(reply.body.find("\"status\":"), std::string::npos) << text;
    EXPECT_EQ(client.read_to_end(), "") << text;
  }
}

TEST(ServerAbuse, RefusesARequestThatEndsInTheMiddle) {
  const Server server(patient(), ok);
  Client client(server.port());
  client.send("GET / HTTP/1.1\r\nHo");
  client.half_close();
  EXPECT_EQ(client.read().status, 400);
}

TEST(ServerAbuse, SurvivesGarbage) {
  const Server server(patient(), ok);
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    std::string text = i % 3 == 0 ? "GET / HTTP/1.1\r\nHost: a\r\n\r\n" : put(10) + "0123456789";
    for (auto edits = random() % 8; edits > 0; --edits) {
      text[random() % text.size()] = static_cast<char>(random() % 256);
    }
    Client client(server.port());
    client.send(text);
    client.half_close();
    client.read_to_end();  // ends
  }
  expect_serves(server);
}

TEST(ServerAbuse, SurvivesResets) {
  const Server server(patient(), ok);
  for (int i = 0; i < 100; ++i) {
    Client client(server.port());
    client.send(std::string_view("GET / HTTP/1.1\r\nHost: a\r\n\r\n").substr(0, i % 28));
    client.reset();
  }
  expect_serves(server);
}

TEST(ServerAbuse, Serves256ClientsAndRefusesTheRest) {
  const Server server(patient(), ok);
  std::vector<Client> served;
  for (int i = 0; i < 300; ++i) {
    Client client(server.port());
    client.get("/");
    const auto reply = client.read();
    EXPECT_EQ(reply.status, i < 256 ? 200 : 503) << i;
    if (reply.status == 200) {
      served.push_back(std::move(client));
    } else {
      EXPECT_NE(reply.head.find("Retry-After: 1\r\n"), std::string::npos);
      EXPECT_EQ(client.read_to_end(), "");
    }
  }
  for (auto& client : served) {  // those are not disturbed
    client.get("/");
    EXPECT_EQ(client.read().status, 200);
  }
}

TEST(ServerAbuse, ServesAgainWhenAClientHasLeft) {
  auto config = patient();
  config.max_connections = 1;
  const Server server(config, ok);
  for (int i = 0; i < 10; ++i) {
    Reply reply;
    do {  // it takes the server a moment to notice that the one before has gone
      Client client(server.port());
      client.get("/");
      reply = client.read();
    } while (reply.status != 200);
  }
}

TEST(ServerAbuse, RefusesALongHeaderOfHeadWithoutABody) {
  const Server server(patient(), ok);
  Client client(server.port());
  client.send("HEAD / HTTP/1.1\r\nHost: a\r\nX: " + std::string(9000, 'x') + "\r\n\r\n");
  EXPECT_EQ(client.read(true).status, 431);
  EXPECT_EQ(client.read_to_end(), "");
}

}  // namespace
}  // namespace kidnapwatch::api
