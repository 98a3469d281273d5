// SPDX-License-Identifier: Apache-2.0
// A request and a response as plain values, and the few rules of HTTP that routes need.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kidnapwatch::api {

struct Header {
  std::string name;
  std::string value;

  friend bool operator==(const Header&, const Header&) = default;
};

struct Request {
  std::string method;  ///< as sent: "GET"
  std::string target;  ///< as sent: path and query, percent-encoded
  std::vector<Header> headers;
  std::string body;
  std::string peer;  ///< the client's address
};

/// A body without an end, made piece by piece. One thread at a time.
class Feed {
 public:
  virtual ~Feed() = default;
  /// What is to be sent now, empty if nothing is; nothing at all: it ends here after all.
  [[nodiscard]] virtual std::optional<std::string> next() = 0;
};

struct Response {
  int status = 200;
  std::string content_type;  ///< empty exactly if there is no content, as in 304
  std::string body;          ///< for HEAD too: the server leaves it out
  std::vector<Header> headers = {};
  std::shared_ptr<Feed> feed = nullptr;  ///< in place of the body, while somebody listens
};

/// What stands before the next `separator`, which is taken off `rest` with it: all of `rest` if
/// there is none.
std::string_view take_until(std::string_view& rest, char separator);

/// "Not Found" for 404: the reason phrase.
[[nodiscard]] std::string_view reason(int status);

/// The value of the first header of that name (in any case), empty if there is none.
[[nodiscard]] std::string_view header(const Request& request, std::string_view name);

/// A request target, decoded.
struct Target {
  std::vector<std::string> segments;         ///< of the path: "/a/b" is {"a", "b"}, "/" is {}
  std::map<std::string, std::string> query;  ///< by name
};

/// Takes "/path?query" and "http://host/path?query" (RFC 9112, section 3.2). A plus sign is a plus
/// sign, so that "+02:00" needs no encoding. Throws BadInput for a broken %-escape or a name given
/// twice.
[[nodiscard]] Target parsed_target(std::string_view target);

/// `text` with everything but A-Z a-z 0-9 - . _ ~ : percent-encoded, to stand in a query.
[[nodiscard]] std::string percent_encoded(std::string_view text);

/// Whether a Content-Type header has the media type `type`, with any parameters.
[[nodiscard]] bool is_media_type(std::string_view content_type, std::string_view type);

/// Whether `accept` (the header's value) prefers `type` to `other`, which is the default.
[[nodiscard]] bool prefers(std::string_view accept, std::string_view type, std::string_view other);

/// Whether `accept_encoding` (the header's value) names `coding`, and not with a weight of 0.
[[nodiscard]] bool accepts(std::string_view accept_encoding, std::string_view coding);

/// As in the Date header: "Sun, 06 Nov 1994 08:49:37 GMT" (RFC 9110, section 5.6.7).
[[nodiscard]] std::string http_date(std::chrono::system_clock::time_point time);

/// Whether a list of entity tags (If-Match, If-None-Match) has `tag`, or is "*". A weak tag (W/"1")
/// has only those that `weak` allows.
[[nodiscard]] bool lists_tag(std::string_view list, std::string_view tag, bool weak);

}  // namespace kidnapwatch::api
