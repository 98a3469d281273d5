// SPDX-License-Identifier: Apache-2.0
// Robots from the running fleet; scores from its history.
#include "api/robots.hpp"

#include "adapters/codecs/history_json.hpp"
#include "adapters/codecs/rfc3339.hpp"
#include "adapters/codecs/status_json.hpp"
#include "api/problem.hpp"

namespace kidnapwatch::api {
namespace {

using adapters::codecs::json;
using adapters::codecs::Json;
using Scores = std::vector<core::Score>;

/// If there are more than `limit` scores: cuts them to it and says where the next page starts.
std::optional<std::string> next_link(const Call& call, Scores& scores, std::size_t limit) {
  if (scores.size() <= limit) {
    return std::nullopt;
  }
  const auto next = scores[limit].stamp;
  scores.resize(limit);
  return link_with(call, "from", adapters::codecs::rfc3339(next));
}

Response csv(const Scores& scores) {
  return {200, "text/csv; charset=utf-8; header=present", adapters::codecs::scores_csv(scores)};
}

Response listed(const Scores& scores, const std::optional<std::string>& next) {
  Json body{{"scores", Json::array()}};
  for (const auto& score : scores) {
    body["scores"].push_back(json(score));
  }
  adapters::codecs::set(body, "next", next);
  return ok(body);
}

}  // namespace

Response get_robots(const Call& call) {
  Json body{{"robots", Json::array()}};
  for (const auto& robot : call.ports.fleet.robots()) {
    if (call.caller.may_see(robot.id)) {
      body["robots"].push_back(json(robot));
    }
  }
  return ok(body);
}

Response get_robot(const Call& call) {
  const auto robot = call.caller.may_see(call.id) ? call.ports.fleet.robot(call.id) : std::nullopt;
  return robot ? ok(json(*robot)) : no_such_robot(call);
}

Response get_scores(const Call& call) {
  const auto range = time_range(call);
  const auto limit = page_limit(call, kMaxPage);
  if (!call.caller.may_see(call.id)) {
    return no_such_robot(call);
  }
  auto scores = call.ports.history.scores(call.id, range, limit + 1);
  if (scores.empty() && !call.ports.fleet.robot(call.id)) {
    return no_such_robot(call);
  }
  const auto next = next_link(call, scores, limit);
  const bool as_csv = prefers(header(call.request, "Accept"), "text/csv", "application/json");
  Response response = as_csv ? csv(scores) : listed(scores, next);
  response.headers.push_back({"Vary", "Accept"});
  if (next) {
    link_next(response, *next);
  }
  return response;
}

}  // namespace kidnapwatch::api
