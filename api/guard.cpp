// SPDX-License-Identifier: Apache-2.0
// The way of a request past the guard.
#include "api/guard.hpp"

#include <cmath>
#include <string>

#include "api/problem.hpp"

namespace kidnapwatch::api {
namespace {

/// Of "Bearer SECRET", in any case; empty if it is something else.
std::string_view secret_of(std::string_view authorization) {
  constexpr std::string_view kBearer = "bearer ";
  if (authorization.size() <= kBearer.size()) {
    return {};
  }
  for (std::size_t i = 0; i < kBearer.size(); ++i) {
    if ((authorization[i] | 0x20) != (kBearer[i] | 0x20)) {
      return {};
    }
  }
  return authorization.substr(kBearer.size());
}

Response unauthorized(bool wrong) {
  Response response = problem(401, wrong ? "Authorization: this token is not known"
                                         : "Authorization: a bearer token is needed");
  response.headers.push_back(
      {"WWW-Authenticate", wrong ? R"(Bearer error="invalid_token")" : "Bearer"});
  return response;
}

Response too_many(double wait_s) {
  Response response = problem(429, "too many requests");
  response.headers.push_back({"Retry-After", std::to_string(std::lround(std::ceil(wait_s)))});
  return response;
}

}  // namespace

std::optional<Caller> Guard::caller(const Request& request) const {
  if (!lookup_) {
    return Caller{.name = request.peer};
  }
  const std::string_view secret = secret_of(header(request, "Authorization"));
  return secret.empty() ? std::nullopt : lookup_(secret);
}

std::variant<Caller, Response> Guard::admit(const Request& request) {
  const auto known = caller(request);
  // A wrong token is charged to the address, so that guessing is no faster than asking.
  const std::string client = lookup_ && known ? "token " + known->name : request.peer;
  if (const double wait_s = limit_.wait_s(client, now_s_()); wait_s > 0.0) {
    return too_many(wait_s);
  }
  if (!known) {
    return unauthorized(!secret_of(header(request, "Authorization")).empty());
  }
  return *known;
}

}  // namespace kidnapwatch::api
