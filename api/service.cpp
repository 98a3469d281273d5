// SPDX-License-Identifier: Apache-2.0
// The service's own state, and the description of this API.
#include "api/service.hpp"

#include "adapters/codecs/status_json.hpp"
#include "api/openapi.hpp"

namespace kidnapwatch::api {

using adapters::codecs::Json;

Response get_service(const Call& call) {
  return ok(adapters::codecs::json(call.ports.fleet.status()));
}

Response get_openapi(const Call& /*call*/) { return ok_text(std::string(openapi_json())); }

Response get_health(const Call& /*call*/) { return ok({{"status", "ok"}}); }

Response get_readiness(const Call& call) {
  const auto status = call.ports.fleet.status();
  Json reasons = Json::array();
  if (!status.broker_connected) {
    reasons.push_back("the broker is not connected");
  }
  if (!status.store_healthy) {
    reasons.push_back("the store does not take writes");
  }
  const bool ready = reasons.empty();
  Response response = ok({{"status", ready ? "ready" : "not ready"}, {"reasons", reasons}});
  response.status = ready ? 200 : 503;
  return response;
}

}  // namespace kidnapwatch::api
