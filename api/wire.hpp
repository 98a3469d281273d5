// SPDX-License-Identifier: Apache-2.0
// Requests and responses as Beast has them, and as routes have them.
#pragma once

#include <chrono>
#include <string>
#include <utility>

#include <boost/asio.hpp>
#include <boost/beast/http.hpp>

#include "api/http.hpp"

namespace kidnapwatch::api {

namespace http = boost::beast::http;
using boost::system::error_code;

inline Request plain(http::request<http::string_body>&& message, const std::string& peer) {
  Request request{
      std::string(message.method_string()), std::string(message.target()), {}, {}, peer};
  for (const auto& field : message) {
    request.headers.push_back({std::string(field.name_string()), std::string(field.value())});
  }
  request.body = std::move(message.body());
  return request;
}

inline http::response<http::string_body> message(Response&& response, bool keep_alive) {
  http::response<http::string_body> result(static_cast<http::status>(response.status), 11);
  for (const auto& [name, value] : response.headers) {
    result.insert(name, value);
  }
  result.set(http::field::date, http_date(std::chrono::system_clock::now()));
  result.set(http::field::cache_control, "no-cache");
  result.set("X-Content-Type-Options", "nosniff");
  result.keep_alive(keep_alive && !response.feed);
  if (!response.content_type.empty()) {
    result.set(http::field::content_type, response.content_type);
  }
  if (!response.content_type.empty() && !response.feed) {  // that one ends with the connection
    result.body() = std::move(response.body);
    result.prepare_payload();
  }
  return result;
}

/// The status that tells a client what was wrong with what it sent.
inline int status_of(error_code error) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return 431;
  }
  if (error == http::error::body_limit) {
    return 413;
  }
  return error == http::error::bad_version ? 505 : 400;
}

}  // namespace kidnapwatch::api
