// SPDX-License-Identifier: Apache-2.0
// Robots from the running fleet; scores from its history.
#include "api/robots.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <utility>

#include "adapters/codecs/history_json.hpp"
#include "adapters/codecs/rfc3339.hpp"
#include "adapters/codecs/status_json.hpp"
#include "api/problem.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::api {
namespace {

using adapters::codecs::json;
using adapters::codecs::Json;
constexpr int kLongestResolution_s = 86'400;

/// Nothing: scores one by one. Throws BadInput unless it is a whole number of seconds.
std::optional<std::chrono::seconds> resolution(const Call& call) {
  const auto text = parameter(call, "resolution");
  if (!text) return std::nullopt;
  int seconds = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), seconds);
  if (error != std::errc() || end != text->data() + text->size() || seconds < 1 ||
      seconds > kLongestResolution_s) {
    throw core::BadInput("resolution", "must be whole seconds from 1 to 86400");
  }
  return std::chrono::seconds(seconds);
}

core::Stamp begin(const core::Score& score) { return score.stamp; }
core::Stamp begin(const core::ScoreBucket& bucket) { return bucket.from; }

/// Of the widest bucket.
std::optional<std::chrono::seconds> resolution_of(const std::vector<core::ScoreBucket>& buckets) {
  const auto widest = std::ranges::max_element(buckets, {}, &core::ScoreBucket::width);
  return widest == buckets.end() ? std::nullopt : std::optional(widest->width);
}
std::optional<std::chrono::seconds> resolution_of(const std::vector<core::Score>& /*all*/) {
  return std::nullopt;
}

std::string csv(const std::vector<core::Score>& scores) {
  return adapters::codecs::scores_csv(scores);
}
std::string csv(const std::vector<core::ScoreBucket>& buckets) {
  return adapters::codecs::score_buckets_csv(buckets);
}

/// A page of `items`, of which there may be more than `limit`: then it says where the next starts.
template <typename Item>
Response page(const Call& call, const char* name, std::vector<Item> items, std::size_t limit) {
  std::optional<std::string> next;
  if (items.size() > limit) {
    next = link_with(call, "from", adapters::codecs::rfc3339(begin(items[limit])));
    items.erase(items.begin() + static_cast<std::ptrdiff_t>(limit), items.end());
  }
  Response response;
  const auto widest = resolution_of(items);
  if (prefers(header(call.request, "Accept"), "text/csv", "application/json")) {
    response = {200, "text/csv; charset=utf-8; header=present", csv(items)};
  } else {
    Json body{{name, Json::array()}};
    for (const auto& item : items) body[name].push_back(json(item));
    if (widest) body["resolution"] = widest->count();
    adapters::codecs::set(body, "next", next);
    response = ok(body);
  }
  response.headers.push_back({"Vary", "Accept"});
  if (next) link_next(response, *next);
  return response;
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

Response get_scans(const Call& call) {
  if (!call.caller.may_see(call.id) || !call.ports.fleet.robot(call.id)) {
    return no_such_robot(call);
  }
  try {
    return ok_text(adapters::codecs::scans_json(call.ports.fleet.last_scans(call.id)));
  } catch (const Unavailable& busy) {
    return problem(503, busy.what());
  }
}

Response get_scores(const Call& call) {
  const auto range = time_range(call);
  const auto limit = page_limit(call, kMaxPage);
  if (!call.caller.may_see(call.id)) {
    return no_such_robot(call);
  }
  const auto& history = call.ports.history;
  const bool is_known = call.ports.fleet.robot(call.id).has_value();
  if (const auto by = resolution(call)) {
    auto buckets = history.score_buckets(call.id, range, *by, limit + 1);
    const bool is_there = is_known || !buckets.empty();
    return is_there ? page(call, "buckets", std::move(buckets), limit) : no_such_robot(call);
  }
  auto scores = history.scores(call.id, range, limit + 1);
  const bool is_there = is_known || !scores.empty();
  return is_there ? page(call, "scores", std::move(scores), limit) : no_such_robot(call);
}

}  // namespace kidnapwatch::api
