// SPDX-License-Identifier: Apache-2.0
// A configuration's entity tag is its version, so that two writers cannot overwrite each other.
#include "api/config.hpp"

#include "adapters/codecs/config_json.hpp"
#include "api/problem.hpp"

namespace kidnapwatch::api {
namespace {

std::string tag(std::int64_t version) { return '"' + std::to_string(version) + '"'; }

Response tagged(Response response, std::int64_t version) {
  response.headers.push_back({"ETag", tag(version)});
  return response;
}

Response conflict(std::int64_t current) {
  return tagged(problem(412, "the configuration is at version " + std::to_string(current)),
                current);
}

}  // namespace

Response get_config(const Call& call) {
  const auto current = call.ports.fleet.config();
  const auto known = header(call.request, "If-None-Match");
  if (lists_tag(known, tag(current.version), true)) {
    return tagged({304, "", ""}, current.version);
  }
  return tagged(ok(adapters::codecs::json(current.config)), current.version);
}

Response put_config(const Call& call) {
  auto& fleet = call.ports.fleet;
  if (!call.caller.robots.empty()) {
    return problem(403, "this token is for some robots, the configuration for all");
  }
  const auto config =
      adapters::codecs::detection_config(adapters::codecs::parsed(call.request.body, "body"));
  const auto expected = header(call.request, "If-Match");
  std::optional<std::int64_t> seen_version;
  if (!expected.empty()) {
    seen_version = fleet.config().version;
    if (!lists_tag(expected, tag(*seen_version), false)) {
      return conflict(*seen_version);
    }
  }
  try {
    const auto put = fleet.put_config(config, seen_version, call.caller.name);
    return tagged(ok(adapters::codecs::json(put.config)), put.version);
  } catch (const VersionConflict& lost) {
    return conflict(lost.current);
  }
}

}  // namespace kidnapwatch::api
