// SPDX-License-Identifier: Apache-2.0
// One call of a route: the request, taken apart, and what it may ask.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "adapters/codecs/json.hpp"
#include "api/guard.hpp"
#include "api/http.hpp"
#include "api/live.hpp"
#include "api/ports.hpp"

namespace kidnapwatch::api {

/// What the routes stand on. All outlive every call.
struct Ports {
  Fleet& fleet;
  const History& history;
  Guard& guard;
  LiveRobots& live;
};

struct Call {
  const Ports& ports;
  const Request& request;
  const Target& target;  ///< its query has only parameters that the route takes
  std::string id;        ///< what stood for {id} in the path
  Caller caller;
};

/// 404 for a robot that is not there, or not for this caller.
[[nodiscard]] Response no_such_robot(const Call& call);

/// Most items on a page, and how many if the call does not say.
inline constexpr std::size_t kMaxPage = 1000;
inline constexpr std::size_t kDefaultPage = 100;

/// The query parameter, or nothing.
[[nodiscard]] std::optional<std::string> parameter(const Call& call, const std::string& name);

/// `limit`, else `otherwise`. Throws BadInput unless it is from 1 to kMaxPage.
[[nodiscard]] std::size_t page_limit(const Call& call, std::size_t otherwise);

/// `from` and `to` (exclusive), else all time. Throws BadInput unless they are RFC 3339, in order.
[[nodiscard]] TimeRange time_range(const Call& call);

/// The same target with one query parameter set to another value: a link to the next page.
[[nodiscard]] std::string link_with(const Call& call, const std::string& parameter,
                                    const std::string& value);

/// 200, application/json; ok_text for JSON that is text already.
[[nodiscard]] Response ok_text(std::string json);
[[nodiscard]] Response ok(const adapters::codecs::Json& body);

/// Adds the address of the next page as RFC 8288 has it.
void link_next(Response& response, const std::string& link);

}  // namespace kidnapwatch::api
