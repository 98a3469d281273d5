// SPDX-License-Identifier: Apache-2.0
// Targets (RFC 3986), content negotiation and entity tags (RFC 9110).
#include "api/http.hpp"

#include <algorithm>
#include <charconv>
#include <ctime>
#include <iomanip>
#include <locale>
#include <optional>
#include <sstream>

#include "core/bad_input.hpp"

namespace kidnapwatch::api {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; }

bool same_word(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, lower, lower);
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::optional<unsigned> hex_digit(char c) {
  if (c >= '0' && c <= '9') {
    return c - '0';
  }
  const char letter = lower(c);
  return letter >= 'a' && letter <= 'f' ? std::optional<unsigned>(letter - 'a' + 10) : std::nullopt;
}

std::string decoded(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      plain += text[i];
      continue;
    }
    const auto high = i + 1 < text.size() ? hex_digit(text[i + 1]) : std::nullopt;
    const auto low = i + 2 < text.size() ? hex_digit(text[i + 2]) : std::nullopt;
    if (!high || !low) {
      throw core::BadInput("target", "has a % without two hexadecimal digits");
    }
    plain += static_cast<char>(*high * 16 + *low);
    i += 2;
  }
  return plain;
}

/// The target without the "http://host" that proxies send.
std::string_view origin_form(std::string_view target) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (same_word(target.substr(0, scheme.size()), scheme)) {
      const auto path = target.find('/', scheme.size());
      return path == std::string_view::npos ? "/" : target.substr(path);
    }
  }
  return target;
}

std::vector<std::string> segments(std::string_view path) {
  std::vector<std::string> result;
  path.remove_prefix(1);
  if (path.empty()) {
    return result;
  }
  for (bool more = true; more;) {
    more = path.find('/') != std::string_view::npos;
    result.push_back(decoded(take_until(path, '/')));
  }
  return result;
}

std::map<std::string, std::string> parameters(std::string_view query) {
  std::map<std::string, std::string> result;
  while (!query.empty()) {
    auto value = take_until(query, '&');
    const auto name = decoded(take_until(value, '='));
    if (name.empty() && value.empty()) {
      continue;
    }
    if (!result.emplace(name, decoded(value)).second) {
      throw core::BadInput(name, "is given twice");
    }
  }
  return result;
}

/// The weight of `type` in an Accept header, or of a coding in Accept-Encoding: its q, of the most
/// specific range that fits; 0 if none.
double weight(std::string_view accept, std::string_view type) {
  const auto family = std::string(type.substr(0, type.find('/'))) + "/*";
  double best = 0.0;
  int best_rank = 0;
  while (!accept.empty()) {
    auto parameters = take_until(accept, ',');
    const auto range = trimmed(take_until(parameters, ';'));
    const int rank = same_word(range, type) ? 3 : same_word(range, family) ? 2 : range == "*/*";
    double q = 1.0;
    while (!parameters.empty()) {
      const auto parameter = trimmed(take_until(parameters, ';'));
      if (parameter.starts_with("q=")) {
        q = 0.0;
        std::from_chars(parameter.data() + 2, parameter.data() + parameter.size(), q);
      }
    }
    if (rank > best_rank) {
      best_rank = rank;
      best = q;
    }
  }
  return best;
}

}  // namespace

std::string_view take_until(std::string_view& rest, char separator) {
  const auto end = std::min(rest.find(separator), rest.size());
  const auto taken = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return taken;
}

std::string_view reason(int status) {
  static const std::map<int, std::string_view> kReasons{{200, "OK"},
                                                        {304, "Not Modified"},
                                                        {400, "Bad Request"},
                                                        {401, "Unauthorized"},
                                                        {403, "Forbidden"},
                                                        {404, "Not Found"},
                                                        {405, "Method Not Allowed"},
                                                        {408, "Request Timeout"},
                                                        {409, "Conflict"},
                                                        {412, "Precondition Failed"},
                                                        {413, "Content Too Large"},
                                                        {415, "Unsupported Media Type"},
                                                        {417, "Expectation Failed"},
                                                        {429, "Too Many Requests"},
                                                        {431, "Request Header Fields Too Large"},
                                                        {500, "Internal Server Error"},
                                                        {503, "Service Unavailable"},
                                                        {505, "HTTP Version Not Supported"}};
  const auto found = kReasons.find(status);
  return found == kReasons.end() ? "Unknown" : found->second;
}

std::string_view header(const Request& request, std::string_view name) {
  const auto found = std::ranges::find_if(
      request.headers, [&](const Header& one) { return same_word(one.name, name); });
  return found == request.headers.end() ? std::string_view() : std::string_view(found->value);
}

Target parsed_target(std::string_view target) {
  auto query = origin_form(target);
  if (!query.starts_with('/') || query.find('#') != std::string_view::npos) {
    throw core::BadInput("target", "must be a path");
  }
  const auto path = take_until(query, '?');
  return {segments(path), parameters(query)};
}

std::string percent_encoded(std::string_view text) {
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string result;
  for (const char c : text) {
    const bool plain = (lower(c) >= 'a' && lower(c) <= 'z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~:").find(c) != std::string_view::npos;
    const auto byte = static_cast<unsigned char>(c);
    result += plain ? std::string(1, c) : std::string{'%', kHex[byte >> 4U], kHex[byte & 15U]};
  }
  return result;
}

bool is_media_type(std::string_view content_type, std::string_view type) {
  return same_word(trimmed(take_until(content_type, ';')), type);
}

bool prefers(std::string_view accept, std::string_view type, std::string_view other) {
  return weight(accept, type) > weight(accept, other);
}

bool accepts(std::string_view accept_encoding, std::string_view coding) {
  return weight(accept_encoding, coding) > 0.0;
}

std::string http_date(std::chrono::system_clock::time_point time) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::put_time(&utc, "%a, %d %b %Y %H:%M:%S GMT");
  return text.str();
}

bool lists_tag(std::string_view list, std::string_view tag, bool weak) {
  while (!list.empty()) {
    auto one = trimmed(take_until(list, ','));
    if (weak && one.starts_with("W/")) {
      one.remove_prefix(2);
    }
    if (one == "*" || one == tag) {
      return true;
    }
  }
  return false;
}

}  // namespace kidnapwatch::api
