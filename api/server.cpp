// SPDX-License-Identifier: Apache-2.0
// Listens, accepts, and gives connections threads to run on.
#include "api/server.hpp"

#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "api/connection.hpp"

namespace kidnapwatch::api {
namespace {

// Forward secrecy and authenticated encryption only; TLS 1.3 has nothing else.
constexpr const char* kCiphers = "ECDHE+AESGCM:ECDHE+CHACHA20";

template <typename Step>
void use(const std::string& file, const char* setting, Step step) {
  error_code error;
  step(error);
  if (error) {
    throw std::runtime_error(std::string(setting) + ": " + file + ": " + error.message());
  }
}

/// TLS 1.2 and later; nothing if it is not configured.
std::optional<net::ssl::context> tls(const ServerConfig& config) {
  if (config.cert_file.empty() && config.key_file.empty()) return std::nullopt;
  if (config.cert_file.empty() || config.key_file.empty()) {
    throw std::runtime_error("http.cert_file and http.key_file: one is missing");
  }
  std::optional<net::ssl::context> context(std::in_place, net::ssl::context::tls_server);
  SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_2_VERSION);
  SSL_CTX_set_cipher_list(context->native_handle(), kCiphers);
  SSL_CTX_set_options(context->native_handle(), SSL_OP_NO_RENEGOTIATION);
  use(config.cert_file, "http.cert_file",
      [&](error_code& error) { context->use_certificate_chain_file(config.cert_file, error); });
  use(config.key_file, "http.key_file", [&](error_code& error) {
    context->use_private_key_file(config.key_file, net::ssl::context::pem, error);
  });
  return context;
}

}  // namespace

/// Accepts connections, and gives them threads to run on.
class Server::Listener {
 public:
  Listener(const ServerConfig& config, Answer answer)
      : shared_(new Shared{config, std::move(answer),
                           Connections(config.max_connections, config.max_connections_per_peer)}),
        tls_(tls(config)),
        acceptor_(net::make_strand(io_)),
        pause_(acceptor_.get_executor()) {
    listen();
    accept();
    for (std::size_t i = 0; i < config.threads; ++i) {
      threads_.emplace_back([this] { io_.run(); });
    }
  }

  ~Listener() {
    net::post(acceptor_.get_executor(), [this] {
      pause_.cancel();
      acceptor_.close();
    });
    shared_->connections.close();
    shared_->connections.wait_until_empty(shared_->config.linger_timeout);
    io_.stop();
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  void listen() {
    const auto& config = shared_->config;
    try {
      const tcp::endpoint endpoint(net::ip::make_address(config.address), config.port);
      acceptor_.open(endpoint.protocol());
      acceptor_.set_option(tcp::acceptor::reuse_address(true));
      acceptor_.bind(endpoint);
      acceptor_.listen();
      port_ = acceptor_.local_endpoint().port();
    } catch (const boost::system::system_error& error) {
      throw std::runtime_error("cannot listen on " + config.address + ":" +
                               std::to_string(config.port) + ": " + error.code().message());
    }
  }

  void accept() {
    acceptor_.async_accept(net::make_strand(io_), [this](error_code error, tcp::socket socket) {
      if (error == net::error::operation_aborted) {
        return;
      }
      error ? pause() : admit(std::move(socket));
    });
  }

  /// Out of file descriptors: trying again at once would only burn the processor.
  void pause() {
    pause_.expires_after(milliseconds{100});
    pause_.async_wait([this](error_code error) {
      if (!error) {
        accept();
      }
    });
  }

  void admit(tcp::socket socket) {
    if (tls_) {
      serve(Secure(std::move(socket), *tls_));
    } else {
      serve(std::move(socket));
    }
    accept();
  }

  template <typename Stream>
  void serve(Stream stream) {
    const auto connection = std::make_shared<Connection<Stream>>(std::move(stream), shared_);
    connection->start(shared_->connections.enter(connection.get(), connection->peer(),
                                                 [weak = std::weak_ptr(connection)] {
                                                   if (const auto self = weak.lock()) {
                                                     self->stop();
                                                   }
                                                 }));
  }

  std::shared_ptr<Shared> shared_;
  std::optional<net::ssl::context> tls_;
  net::io_context io_;
  tcp::acceptor acceptor_;
  net::steady_timer pause_;
  std::uint16_t port_ = 0;
  std::vector<std::jthread> threads_;  // last: joined before anything they use is gone
};

Server::Server(const ServerConfig& config, Answer answer)
    : listener_(std::make_unique<Listener>(config, std::move(answer))) {}

Server::~Server() = default;

std::uint16_t Server::port() const { return listener_->port(); }

}  // namespace kidnapwatch::api
