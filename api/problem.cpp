// SPDX-License-Identifier: Apache-2.0
// Problem details, RFC 9457.
#include "api/problem.hpp"

#include "adapters/codecs/json.hpp"

namespace kidnapwatch::api {
namespace {

using adapters::codecs::Json;

Json details(int status, const std::string& detail) {
  return {
      {"type", "about:blank"}, {"title", reason(status)}, {"status", status}, {"detail", detail}};
}

Response response(int status, const Json& body) {
  return {status, "application/problem+json", adapters::codecs::text(body)};
}

}  // namespace

Response problem(int status, const std::string& detail) {
  return response(status, details(status, detail));
}

Response problem(const core::BadInput& error) {
  Json body = details(400, error.what());
  body["field"] = error.field();
  return response(400, body);
}

}  // namespace kidnapwatch::api
