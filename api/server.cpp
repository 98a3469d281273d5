// SPDX-License-Identifier: Apache-2.0
// The only file that knows Boost.Beast: one chain of completion handlers per connection.
#include "api/server.hpp"

#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <boost/asio.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>

#include "api/connections.hpp"
#include "api/problem.hpp"

namespace kidnapwatch::api {
namespace {

namespace net = boost::asio;
namespace http = boost::beast::http;
using boost::system::error_code;
using net::ip::tcp;
using std::chrono::milliseconds;

/// What all connections share.
struct Shared {
  ServerConfig config;
  Server::Answer answer;
  Connections connections;
};

Request plain(http::request<http::string_body>&& message, const std::string& peer) {
  Request request{
      std::string(message.method_string()), std::string(message.target()), {}, {}, peer};
  for (const auto& field : message) {
    request.headers.push_back({std::string(field.name_string()), std::string(field.value())});
  }
  request.body = std::move(message.body());
  return request;
}

http::response<http::string_body> message(Response&& response, bool keep_alive) {
  http::response<http::string_body> result(static_cast<http::status>(response.status), 11);
  for (const auto& [name, value] : response.headers) {
    result.insert(name, value);
  }
  result.set(http::field::cache_control, "no-cache");
  result.set("X-Content-Type-Options", "nosniff");
  result.keep_alive(keep_alive);
  if (!response.content_type.empty()) {
    result.set(http::field::content_type, response.content_type);
    result.body() = std::move(response.body);
    result.prepare_payload();
  }
  return result;
}

/// The status that tells a client what was wrong with what it sent.
int status_of(error_code error) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return 431;
  }
  if (error == http::error::body_limit) {
    return 413;
  }
  return error == http::error::bad_version ? 505 : 400;
}

/// One client: wait for a request, read its header, its body, answer, and again. All of it runs on
/// the connection's strand. A timer is always set; what it cuts depends on the step.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, std::shared_ptr<Shared> shared)
      : shared_(std::move(shared)),
        socket_(std::move(socket)),
        timer_(socket_.get_executor()),
        buffer_(shared_->config.max_header_bytes) {
    error_code ignored;
    peer_ = socket_.remote_endpoint(ignored).address().to_string();
    socket_.set_option(tcp::no_delay(true), ignored);
  }

  ~Connection() { shared_->connections.leave(this); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Any thread.
  void start(Place place) {
    net::post(socket_.get_executor(), [self = shared_from_this(), place] {
      if (place == Place::served) {
        self->read_header();
      } else if (place == Place::refused) {
        self->refuse();
      }
    });
  }

  /// Any thread: a response under way is finished, anything else is cut.
  void stop() {
    net::post(socket_.get_executor(), [self = shared_from_this()] {
      self->stopping_ = true;
      if (!self->answering_) {
        self->close();
      }
    });
  }

 private:
  void refuse() {
    auto full = problem(503, "too many connections");
    full.headers.push_back({"Retry-After", "1"});
    send(std::move(full), false);
  }

  void wait_for_request() {
    if (buffer_.size() > 0) {  // the next one is already here: pipelined
      read_header();
      return;
    }
    allow(config().idle_timeout, &Connection::close);
    socket_.async_wait(tcp::socket::wait_read, [self = shared_from_this()](error_code error) {
      if (!error) {
        self->read_header();
      }
    });
  }

  void read_header() {
    head_ = false;
    parser_.emplace();
    parser_->header_limit(config().max_header_bytes);
    parser_->body_limit(config().max_body_bytes);
    allow(config().header_timeout, &Connection::stop_reading);
    header_bytes_ = 0;
    read_fields();
  }

  /// Some of the header at a time, because Beast's own limit is per field: it would let a client
  /// send as many as it likes.
  void read_fields() {
    http::async_read_some(socket_, buffer_, *parser_,
                          [self = shared_from_this()](error_code error, std::size_t parsed) {
                            self->on_fields(error, parsed);
                          });
  }

  void on_fields(error_code error, std::size_t parsed) {
    header_bytes_ += parsed;
    if (!error && header_bytes_ > config().max_header_bytes) {
      error = http::error::header_limit;
    }
    if (error) {
      reject(error);
    } else if (parser_->is_header_done()) {
      on_header();
    } else {
      read_fields();
    }
  }

  void on_header() {
    head_ = parser_->get().method() == http::verb::head;
    const auto expect = parser_->get()[http::field::expect];
    if (expect.empty()) {
      read_body();
    } else if (boost::beast::iequals(expect, "100-continue")) {
      invite_body();
    } else {
      send(problem(417, "the only expectation that is met is 100-continue"), false);
    }
  }

  void invite_body() {
    static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
    net::async_write(socket_, net::buffer(kContinue),
                     [self = shared_from_this()](error_code error, std::size_t) {
                       error ? self->close() : self->read_body();
                     });
  }

  void read_body() {
    allow(config().body_timeout, &Connection::stop_reading);
    http::async_read(socket_, buffer_, *parser_,
                     [self = shared_from_this()](error_code error, std::size_t) {
                       error ? self->reject(error) : self->on_request();
                     });
  }

  void on_request() {
    const bool http_1_1 = parser_->get().version() == 11;
    const bool keep_alive = http_1_1 && parser_->keep_alive() && !stopping_;
    if (http_1_1 && parser_->get().count(http::field::host) != 1) {
      send(problem(400, "Host: must be given once"), false);
      return;
    }
    send(answered(plain(parser_->release(), peer_)), keep_alive);
  }

  Response answered(const Request& request) {
    try {
      return shared_->answer(request);
    } catch (const std::exception&) {
      return problem(500, "the service failed");
    }
  }

  /// Of a request that cannot be read.
  void reject(error_code error) {
    if (late_ && parser_->got_some()) {
      send(problem(408, "the request took too long"), false);
    } else if (late_ || error == http::error::end_of_stream ||
               error.category() != http::make_error_code(http::error::bad_method).category()) {
      close();
    } else {
      send(problem(status_of(error), error.message()), false);
    }
  }

  void send(Response response, bool keep_alive) {
    answering_ = true;
    message_ = message(std::move(response), keep_alive);
    serializer_.emplace(message_);
    allow(config().write_timeout, &Connection::close);
    auto sent = [self = shared_from_this()](error_code error, std::size_t) {
      error ? self->close() : self->on_sent();
    };
    if (head_) {
      http::async_write_header(socket_, *serializer_, std::move(sent));
    } else {
      http::async_write(socket_, *serializer_, std::move(sent));
    }
  }

  void on_sent() {
    answering_ = false;
    if (stopping_) {
      close();
    } else if (message_.keep_alive()) {
      wait_for_request();
    } else {
      linger();
    }
  }

  /// Reads and forgets what the client still sends: to close on unread bytes resets the connection,
  /// and the client would lose the response that says what was wrong.
  void linger() {
    error_code ignored;
    socket_.shutdown(tcp::socket::shutdown_send, ignored);
    allow(config().linger_timeout, &Connection::close);
    drain();
  }

  void drain() {
    buffer_.clear();
    socket_.async_read_some(buffer_.prepare(buffer_.max_size()),
                            [self = shared_from_this()](error_code error, std::size_t) {
                              error ? self->close() : self->drain();
                            });
  }

  /// From now on `late` happens unless the next step comes before `at_most` is over.
  void allow(milliseconds at_most, void (Connection::*late)()) {
    timer_.expires_after(at_most);
    timer_.async_wait([self = shared_from_this(), late](error_code error) {
      // A wait that ended just before it was replaced is not told that it was cancelled.
      if (!error && self->timer_.expiry() <= net::steady_timer::clock_type::now()) {
        (self.get()->*late)();
      }
    });
  }

  /// The pending read and all further ones end, while a response can still be written.
  void stop_reading() {
    late_ = true;
    error_code ignored;
    socket_.shutdown(tcp::socket::shutdown_receive, ignored);
  }

  void close() {
    error_code ignored;
    timer_.cancel();
    socket_.close(ignored);
  }

  [[nodiscard]] const ServerConfig& config() const { return shared_->config; }

  std::shared_ptr<Shared> shared_;
  tcp::socket socket_;
  net::steady_timer timer_;
  std::string peer_;
  boost::beast::flat_buffer buffer_;
  std::size_t header_bytes_ = 0;
  std::optional<http::request_parser<http::string_body>> parser_;
  http::response<http::string_body> message_;
  std::optional<http::response_serializer<http::string_body>> serializer_;
  bool head_ = false;       // the request is HEAD
  bool late_ = false;       // the request took too long
  bool answering_ = false;  // a response is being made or written
  bool stopping_ = false;   // after this response
};

}  // namespace

/// Accepts connections, and gives them threads to run on.
class Server::Listener {
 public:
  Listener(const ServerConfig& config, Answer answer)
      : shared_(new Shared{config, std::move(answer), Connections(config.max_connections)}),
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
    const auto connection = std::make_shared<Connection>(std::move(socket), shared_);
    connection->start(
        shared_->connections.enter(connection.get(), [weak = std::weak_ptr(connection)] {
          if (const auto self = weak.lock()) {
            self->stop();
          }
        }));
    accept();
  }

  std::shared_ptr<Shared> shared_;
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
