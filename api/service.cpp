// SPDX-License-Identifier: Apache-2.0
// The service's own state, and the descriptions of REST and MQTT.
#include "api/service.hpp"

#include "adapters/codecs/status_json.hpp"
#include "api/descriptions.hpp"

namespace kidnapwatch::api {

using adapters::codecs::Json;

Response get_me(const Call& call) {
  Json body{{"name", call.caller.name}, {"role", name(call.caller.role)}};
  if (!call.caller.robots.empty()) {
    body["robots"] = call.caller.robots;
  }
  return ok(body);
}

Response get_service(const Call& call) {
  return ok(adapters::codecs::json(call.ports.fleet.status()));
}

Response get_openapi(const Call& /*call*/) { return ok_text(std::string(openapi_json())); }

Response get_asyncapi(const Call& /*call*/) { return ok_text(std::string(asyncapi_json())); }

Response get_health(const Call& /*call*/) { return ok({{"status", "ok"}}); }

Response get_readiness(const Call& call) {
  const auto status = call.ports.fleet.status();
  Json reasons = Json::array();
  for (const auto& degradation : status.degraded) {
    reasons.push_back(degradation.what);
  }
  const bool ready = status.broker_connected && status.store_healthy;
  const char* how = !ready ? "not ready" : reasons.empty() ? "ready" : "degraded";
  Response response = ok({{"status", how}, {"reasons", reasons}});
  response.status = ready ? 200 : 503;
  return response;
}

}  // namespace kidnapwatch::api
