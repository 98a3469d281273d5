// SPDX-License-Identifier: Apache-2.0
// A configuration's entity tag is its version, so that two writers cannot overwrite each other.
#include "api/config.hpp"

#include <charconv>
#include <functional>

#include "adapters/codecs/config_json.hpp"
#include "adapters/codecs/rfc3339.hpp"
#include "api/problem.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::api {
namespace {

using adapters::codecs::rfc3339;

std::string tag(std::int64_t version) { return '"' + std::to_string(version) + '"'; }

Response tagged(Response response, std::int64_t version) {
  response.headers.push_back({"ETag", tag(version)});
  return response;
}

Response conflict(std::int64_t current) {
  return tagged(problem(412, "the configuration is at version " + std::to_string(current)),
                current);
}

/// Why the caller may not know of this level, or that the robot is unknown.
std::optional<Response> refusal(const Call& call, const std::string& robot) {
  const bool is_there = call.caller.may_see(robot) && call.ports.fleet.robot(robot).has_value();
  return robot.empty() || is_there ? std::nullopt : std::optional(no_such_robot(call));
}

Response shown(const std::string& robot, const ConfigView& view) {
  const auto& [version, since, author, config] = view.effective;
  Json body = Json::object();
  if (!robot.empty()) body["robotId"] = robot;
  body.update({{"version", version},
               {"since", rfc3339(since)},
               {"author", author},
               {"values", robot.empty() ? view.fleet : view.robot},
               {"effective", adapters::codecs::json(config)},
               {"origins", adapters::codecs::config_origins(config, view.fleet, view.robot)}});
  return tagged(ok(body), version);
}

using Edit = std::function<Json(const Json& values)>;

/// Sets a level to what `edit` makes of its values. Without If-Match nobody's change is lost
/// either: the edit is made anew of what somebody else was faster to set.
Response edited(const Call& call, const std::string& robot, const Edit& edit) {
  if (robot.empty() && !call.caller.robots.empty()) {
    return problem(403, "this token is for some robots, the configuration for all");
  }
  if (auto refused = refusal(call, robot)) return *refused;
  const auto expected = header(call.request, "If-Match");
  while (true) {
    const ConfigView seen = call.ports.fleet.config(robot);
    const std::int64_t version = seen.effective.version;
    if (!expected.empty() && !lists_tag(expected, tag(version), false)) return conflict(version);
    try {
      const Json values = edit(robot.empty() ? seen.fleet : seen.robot);
      return shown(robot, call.ports.fleet.put_config(robot, values, version, call.caller.name));
    } catch (const VersionConflict& lost) {
      if (!expected.empty()) return conflict(lost.current);
    }
  }
}

Json body(const Call& call) { return adapters::codecs::parsed(call.request.body, "body"); }

std::int64_t version_from(const std::string& text, const char* field) {
  std::int64_t version = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), version);
  if (error != std::errc() || end != text.data() + text.size() || version < 1) {
    throw core::BadInput(field, "must be a version");
  }
  return version;
}

Json json(const ConfigChange& change) {
  Json object{
      {"version", change.version}, {"since", rfc3339(change.since)}, {"author", change.author}};
  if (!change.robot.empty()) object["robotId"] = change.robot;
  object["values"] = change.values;
  return object;
}

/// The first changes that the caller may see, at most `wanted.limit`.
std::vector<ConfigChange> visible(const Call& call, ConfigQuery wanted) {
  std::vector<ConfigChange> found;
  while (true) {
    const auto page = call.ports.history.configs(wanted);
    for (const auto& change : page) {
      const bool is_visible = change.robot.empty() || call.caller.may_see(change.robot);
      if (is_visible && found.size() < wanted.limit) found.push_back(change);
    }
    if (page.size() < wanted.limit || found.size() == wanted.limit) return found;
    wanted.before = page.back().version;
  }
}

}  // namespace

Response get_config(const Call& call) {
  if (auto refused = refusal(call, call.id)) return *refused;
  const auto view = call.ports.fleet.config(call.id);
  const auto version = view.effective.version;
  if (lists_tag(header(call.request, "If-None-Match"), tag(version), true)) {
    return tagged({304, "", ""}, version);
  }
  return shown(call.id, view);
}

Response put_config(const Call& call) {
  return edited(call, call.id, [&](const Json&) { return body(call); });
}

Response patch_config(const Call& call) {
  const Json patch = body(call);
  if (!patch.is_object()) throw core::BadInput("body", "must be an object");
  return edited(call, call.id, [&](Json values) {
    values.merge_patch(patch);
    return values;
  });
}

Response delete_config(const Call& call) {
  return edited(call, call.id, [](const Json&) { return Json::object(); });
}

Response get_config_history(const Call& call) {
  const auto limit = page_limit(call, kDefaultPage);
  ConfigQuery wanted{.robot = parameter(call, "robot"), .before = {}, .limit = limit + 1};
  if (const auto cursor = parameter(call, "cursor")) {
    wanted.before = version_from(*cursor, "cursor");
  }
  auto changes = visible(call, wanted);
  Json body{{"changes", Json::array()}};
  std::optional<std::string> next;
  if (changes.size() > limit) {
    changes.resize(limit);
    next = link_with(call, "cursor", std::to_string(changes.back().version));
  }
  for (const auto& change : changes) body["changes"].push_back(json(change));
  adapters::codecs::set(body, "next", next);
  Response response = ok(body);
  if (next) link_next(response, *next);
  return response;
}

Response restore_config(const Call& call) {
  const auto version = version_from(call.id, "version");
  const auto found = visible(call, {.robot = {}, .before = version + 1, .limit = 1});
  if (found.empty() || found.front().version != version) {
    return problem(404, "no change of the configuration has the version " + call.id);
  }
  const auto& change = found.front();
  return edited(call, change.robot, [&](const Json&) { return change.values; });
}

}  // namespace kidnapwatch::api
