// SPDX-License-Identifier: Apache-2.0
// The server over TLS: old protocols, plain text, half a handshake, and those who are just slow.
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <boost/asio.hpp>
#include <boost/asio/ssl.hpp>
#include <gtest/gtest.h>

#include "api/server.hpp"
#include "client.hpp"

namespace kidnapwatch::api {
namespace {

namespace net = boost::asio;
using net::ip::tcp;

class ServerTls : public ::testing::Test {
 public:
  ~ServerTls() override { std::filesystem::remove_all(folder_); }

 protected:
  ServerTls() {
    std::string path = (std::filesystem::temp_directory_path() / "kidnapwatch-XXXXXX").string();
    EXPECT_NE(::mkdtemp(path.data()), nullptr);
    folder_ = path;
    const std::string command =
        "cd " + path +
        " && openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 1 -subj "
        "/CN=127.0.0.1 -keyout key.pem -out cert.pem 2>openssl.log";
    EXPECT_EQ(std::system(command.c_str()), 0);  // NOLINT(cert-env33-c): words of our own
  }

  [[nodiscard]] ServerConfig config() const {
    ServerConfig config;
    config.port = 0;
    config.cert_file = folder_ / "cert.pem";
    config.key_file = folder_ / "key.pem";
    return config;
  }

  [[nodiscard]] std::string complaint(const ServerConfig& config) const {
    try {
      const Server server(config, {});
      return "";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  }

  std::filesystem::path folder_;
};

Response echo(const Request& request) {
  return {200, "text/plain", request.method + " " + request.target + " " + request.body};
}

/// Throws boost::system::system_error where the server refuses.
class TlsClient {
 public:
  explicit TlsClient(std::uint16_t port, int newest = TLS1_3_VERSION) {
    SSL_set_max_proto_version(stream_.native_handle(), newest);
    SSL_set_min_proto_version(stream_.native_handle(), TLS1_VERSION);
    SSL_set_security_level(stream_.native_handle(), 0);  // else the client refuses first
    stream_.next_layer().connect({net::ip::make_address("127.0.0.1"), port});
    stream_.handshake(net::ssl::stream_base::client);
  }

  void send(const std::string& bytes) { net::write(stream_, net::buffer(bytes)); }

  /// The next so many bytes.
  std::string read(std::size_t size) {
    std::string bytes(size, '\0');
    net::read(stream_, net::buffer(bytes));
    return bytes;
  }

  /// Up to the end of the connection, however it ends.
  std::string read_to_end() {
    std::string bytes;
    boost::system::error_code end;
    net::read(stream_, net::dynamic_buffer(bytes), end);
    return bytes;
  }

 private:
  net::io_context io_;
  net::ssl::context context_{net::ssl::context::tls_client};
  net::ssl::stream<tcp::socket> stream_{io_, context_};
};

TEST_F(ServerTls, AnswersAgainAndAgainOverOneConnection) {
  const Server server(config(), echo);
  TlsClient client(server.port());
  for (int i = 0; i < 3; ++i) {
    client.send("GET /" + std::to_string(i) + " HTTP/1.1\r\nHost: a\r\n\r\n");
    EXPECT_EQ(client.read(15), "HTTP/1.1 200 OK");
    std::string rest;
    while (!rest.ends_with("\r\n\r\n")) rest += client.read(1);
    EXPECT_EQ(client.read(7), "GET /" + std::to_string(i) + " ");
  }
}

TEST_F(ServerTls, TakesABodyAndSaysGoodbye) {
  const Server server(config(), echo);
  TlsClient client(server.port());
  client.send("PUT / HTTP/1.1\r\nHost: a\r\nConnection: close\r\nContent-Length: 40000\r\n\r\n" +
              std::string(40'000, 'x'));
  const std::string reply = client.read_to_end();
  EXPECT_TRUE(reply.starts_with("HTTP/1.1 200 OK"));
  EXPECT_TRUE(reply.ends_with("PUT / " + std::string(40'000, 'x')));
}

/// One, two, three, and the end.
class Countdown final : public Feed {
 public:
  std::optional<std::string> next() override {
    return count_ == 3 ? std::nullopt : std::optional(std::to_string(++count_) + " ");
  }

 private:
  int count_ = 0;
};

TEST_F(ServerTls, SendsAFeedToItsEnd) {
  const Server server(config(), [](const Request&) {
    Response response{200, "text/event-stream", ""};
    response.feed = std::make_shared<Countdown>();
    return response;
  });
  TlsClient client(server.port());
  client.send("GET / HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_TRUE(client.read_to_end().ends_with("\r\n\r\n1 2 3 "));
}

TEST_F(ServerTls, SpeaksNothingOlderThanTls12) {
  const Server server(config(), echo);
  EXPECT_NO_THROW(TlsClient(server.port(), TLS1_2_VERSION));
  EXPECT_THROW(TlsClient(server.port(), TLS1_1_VERSION), boost::system::system_error);
  EXPECT_THROW(TlsClient(server.port(), TLS1_VERSION), boost::system::system_error);
}

TEST_F(ServerTls, TellsNothingToThoseWhoSpeakInTheClear) {
  const Server server(config(), echo);
  Client plain(server.port());
  plain.get("/");
  EXPECT_EQ(plain.read_to_end().find("HTTP/"), std::string::npos);
  EXPECT_NO_THROW(TlsClient(server.port()));
}

TEST_F(ServerTls, CutsHalfAHandshakeAndHalfARequest) {
  ServerConfig impatient = config();
  impatient.header_timeout = std::chrono::milliseconds(200);
  const Server server(impatient, echo);
  Client silent(server.port());
  EXPECT_EQ(silent.read_to_end(), "");
  TlsClient slow(server.port());
  slow.send("GET / HTTP/1.1\r\nHo");
  EXPECT_EQ(slow.read_to_end(), "");
}

TEST_F(ServerTls, RefusesOneConnectionTooMany) {
  ServerConfig small = config();
  small.max_connections = 1;
  const Server server(small, echo);
  const TlsClient first(server.port());
  TlsClient second(server.port());
  EXPECT_TRUE(second.read_to_end().starts_with("HTTP/1.1 503 "));
}

TEST_F(ServerTls, StopsWhateverClientsAreAt) {
  std::optional<Server> server(std::in_place, config(), echo);
  const TlsClient idle(server->port());
  const Client silent(server->port());
  server.reset();
}

TEST_F(ServerTls, NamesTheFileThatIsNone) {
  ServerConfig wrong = config();
  wrong.key_file = folder_ / "cert.pem";
  EXPECT_NE(complaint(wrong).find("http.key_file: " + wrong.key_file), std::string::npos);
  wrong.cert_file = folder_ / "missing.pem";
  EXPECT_NE(complaint(wrong).find("http.cert_file: " + wrong.cert_file), std::string::npos);
  wrong.cert_file.clear();
  EXPECT_NE(complaint(wrong).find("one is missing"), std::string::npos);
}

}  // namespace
}  // namespace kidnapwatch::api
