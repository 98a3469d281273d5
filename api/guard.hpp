// SPDX-License-Identifier: Apache-2.0
// Who is let in: tokens and rates, asked once per request.
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <variant>

#include "api/auth.hpp"
#include "api/http.hpp"
#include "api/rate_limit.hpp"

namespace kidnapwatch::api {

class Guard {
 public:
  /// Whose secret it is; empty where nobody needs one.
  using Lookup = std::function<std::optional<Caller>(std::string_view secret)>;

  /// `now_s`: seconds of a clock that never goes back. Both are called from any thread.
  Guard(Lookup lookup, const RateLimitConfig& limit, std::function<double()> now_s)
      : lookup_(std::move(lookup)), limit_(limit), now_s_(std::move(now_s)) {}

  /// The caller, or why not: 401 (RFC 6750), 429 (RFC 6585). Without tokens the caller is an admin
  /// of the name of its address.
  [[nodiscard]] std::variant<Caller, Response> admit(const Request& request);

  /// Who calls, at no charge: for what was admitted, and goes on.
  [[nodiscard]] std::optional<Caller> caller(const Request& request) const;

 private:
  const Lookup lookup_;
  RateLimit limit_;
  const std::function<double()> now_s_;
};

}  // namespace kidnapwatch::api
