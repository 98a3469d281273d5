// SPDX-License-Identifier: Apache-2.0
// The table of routes, and the way of a request through it.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "api/call.hpp"

namespace kidnapwatch::api {

struct Route {
  std::string_view method;
  std::string_view pattern;     ///< "{id}" stands for any one segment
  std::string_view parameters;  ///< names that the query may have, between spaces
  std::optional<Role> needs;    ///< nothing: anybody may, without a token
  Response (*answer)(const Call& call);
};

[[nodiscard]] std::span<const Route> routes();

/// Told of a fault of our own, once per request; the client learns no more than that it was one.
using Report = std::function<void(const std::string& what)>;

/// The answer to any request at all: never throws for what a client sent. HEAD is answered as GET.
/// What a caller may not see is not there for it.
[[nodiscard]] Response answer(const Ports& ports, const Request& request, const Report& report);

}  // namespace kidnapwatch::api
