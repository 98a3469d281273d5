// SPDX-License-Identifier: Apache-2.0
// One client of the server, over TCP or TLS: one chain of completion handlers.
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <boost/asio.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>

#include "api/connections.hpp"
#include "api/problem.hpp"
#include "api/server.hpp"
#include "api/wire.hpp"

namespace kidnapwatch::api {

namespace net = boost::asio;
using net::ip::tcp;
using std::chrono::milliseconds;

using Plain = tcp::socket;
using Secure = net::ssl::stream<tcp::socket>;

inline tcp::socket& socket(Plain& stream) { return stream; }
inline tcp::socket& socket(Secure& stream) { return stream.next_layer(); }

/// What all connections share.
struct Shared {
  ServerConfig config;
  Server::Answer answer;
  Connections connections;
  std::atomic<std::size_t> feeds = 0;
};

inline constexpr std::size_t kFirstBytes = 2048;  // of a request, at most, at once

/// One client: wait for a request, read its header, its body, answer, and again. All of it runs on
/// the connection's strand. A timer is always set; what it cuts depends on the step.
template <typename Stream>
class Connection : public std::enable_shared_from_this<Connection<Stream>> {
 public:
  Connection(Stream stream, std::shared_ptr<Shared> shared)
      : shared_(std::move(shared)),
        stream_(std::move(stream)),
        timer_(stream_.get_executor()),
        buffer_(shared_->config.max_header_bytes) {
    error_code ignored;
    peer_ = socket(stream_).remote_endpoint(ignored).address().to_string();
    socket(stream_).set_option(tcp::no_delay(true), ignored);
  }

  ~Connection() {
    if (feed_) {
      --shared_->feeds;
    }
    shared_->connections.leave(this);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  [[nodiscard]] const std::string& peer() const { return peer_; }

  /// Any thread.
  void start(Place place) {
    net::post(stream_.get_executor(), [self = this->shared_from_this(), place] {
      if (place == Place::served) {
        self->greet(&Connection::read_header);
      } else if (place == Place::refused) {
        self->greet(&Connection::refuse);
      }
    });
  }

  /// Any thread: a response under way is finished, anything else is cut.
  void stop() {
    net::post(stream_.get_executor(), [self = this->shared_from_this()] {
      self->stopping_ = true;
      if (!self->answering_) {
        self->close();
      }
    });
  }

 private:
  static constexpr bool kIsSecure = std::is_same_v<Stream, Secure>;

  void greet(void (Connection::*next)()) {
    if constexpr (kIsSecure) {
      allow(config().header_timeout, &Connection::close);
      stream_.async_handshake(Secure::server,
                              [self = this->shared_from_this(), next](error_code error) {
                                error ? self->close() : (self.get()->*next)();
                              });
    } else {
      (this->*next)();
    }
  }

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
    const auto room = std::min(buffer_.max_size(), kFirstBytes);
    stream_.async_read_some(buffer_.prepare(room),
                            [self = this->shared_from_this()](error_code error, std::size_t bytes) {
                              self->buffer_.commit(bytes);
                              error ? self->close() : self->read_header();
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
    http::async_read_some(stream_, buffer_, *parser_,
                          [self = this->shared_from_this()](error_code error, std::size_t parsed) {
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
    net::async_write(stream_, net::buffer(kContinue),
                     [self = this->shared_from_this()](error_code error, std::size_t) {
                       error ? self->close() : self->read_body();
                     });
  }

  void read_body() {
    allow(config().body_timeout, &Connection::stop_reading);
    http::async_read(stream_, buffer_, *parser_,
                     [self = this->shared_from_this()](error_code error, std::size_t) {
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
    head_ = parser_->get().method() == http::verb::head;  // if it came so far
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
    if (response.feed && !head_ && ++shared_->feeds > config().max_feeds) {
      --shared_->feeds;
      response = problem(503, "too many clients follow the events");
      response.headers.push_back({"Retry-After", "10"});
    } else if (response.feed && !head_) {
      feed_ = response.feed;
    }
    message_ = message(std::move(response), keep_alive);
    serializer_.emplace(message_);
    allow(config().write_timeout, &Connection::close);
    auto sent = [self = this->shared_from_this()](error_code error, std::size_t) {
      error ? self->close() : self->on_sent();
    };
    if (head_ || feed_) {
      http::async_write_header(stream_, *serializer_, std::move(sent));
    } else {
      http::async_write(stream_, *serializer_, std::move(sent));
    }
  }

  void on_sent() {
    answering_ = false;
    if (stopping_) {
      close();
    } else if (feed_) {
      drain();  // to hear when the client leaves
      follow();
    } else if (message_.keep_alive()) {
      wait_for_request();
    } else {
      linger();
    }
  }

  /// Sends what there is to say, and looks for more a little later.
  void follow() {
    if (!socket(stream_).is_open()) {
      return;
    }
    auto piece = next_piece();
    if (!piece) {
      close();
    } else if (piece->empty()) {
      allow(config().feed_every, &Connection::follow);
    } else {
      piece_ = std::move(*piece);
      allow(config().write_timeout, &Connection::close);
      net::async_write(stream_, net::buffer(piece_),
                       [self = this->shared_from_this()](error_code error, std::size_t) {
                         error ? self->close() : self->follow();
                       });
    }
  }

  std::optional<std::string> next_piece() {
    try {
      return feed_->next();
    } catch (const std::exception&) {
      return std::nullopt;  // the client comes back, and is told then
    }
  }

  /// Reads and forgets what the client still sends: to close on unread bytes resets the connection,
  /// and the client would lose the response that says what was wrong.
  void linger() {
    allow(config().linger_timeout, &Connection::close);
    if constexpr (kIsSecure) {
      stream_.async_shutdown([self = this->shared_from_this()](error_code) { self->close(); });
    } else {
      error_code ignored;
      stream_.shutdown(tcp::socket::shutdown_send, ignored);
      drain();
    }
  }

  void drain() {
    buffer_.clear();
    stream_.async_read_some(buffer_.prepare(buffer_.max_size()),
                            [self = this->shared_from_this()](error_code error, std::size_t) {
                              error ? self->close() : self->drain();
                            });
  }

  /// From now on `late` happens unless the next step comes before `at_most` is over.
  void allow(milliseconds at_most, void (Connection::*late)()) {
    timer_.expires_after(at_most);
    timer_.async_wait([self = this->shared_from_this(), late](error_code error) {
      // A wait that ended just before it was replaced is not told that it was cancelled.
      if (!error && self->timer_.expiry() <= net::steady_timer::clock_type::now()) {
        (self.get()->*late)();
      }
    });
  }

  /// The pending read and all further ones end, while a response can still be written; over TLS it
  /// cannot.
  void stop_reading() {
    late_ = true;
    if constexpr (kIsSecure) {
      close();
    } else {
      error_code ignored;
      stream_.shutdown(tcp::socket::shutdown_receive, ignored);
    }
  }

  void close() {
    error_code ignored;
    timer_.cancel();
    socket(stream_).close(ignored);
  }

  [[nodiscard]] const ServerConfig& config() const { return shared_->config; }

  std::shared_ptr<Shared> shared_;
  Stream stream_;
  net::steady_timer timer_;
  std::string peer_;
  boost::beast::flat_buffer buffer_;
  std::size_t header_bytes_ = 0;
  std::optional<http::request_parser<http::string_body>> parser_;
  http::response<http::string_body> message_;
  std::optional<http::response_serializer<http::string_body>> serializer_;
  std::shared_ptr<Feed> feed_;  // of a response that has no end
  std::string piece_;           // of it, being written
  bool head_ = false;           // the request is HEAD
  bool late_ = false;           // the request took too long
  bool answering_ = false;      // a response is being made or written
  bool stopping_ = false;       // after this response
};

}  // namespace kidnapwatch::api
