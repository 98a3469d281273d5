// SPDX-License-Identifier: Apache-2.0
// Serves the dashboard: compressed where the client takes it, and not again if it has it already.
#include "api/assets.hpp"

#include <algorithm>
#include <string>

#include "api/problem.hpp"

namespace kidnapwatch::api {
namespace {

/// Nothing comes from elsewhere, nothing inline is run, and nobody frames the page.
constexpr const char* kPolicy =
    "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

Response served(const Asset& asset, const Request& request) {
  const bool packed = accepts(header(request, "Accept-Encoding"), "gzip");
  const auto tag = "\"" + std::string(asset.digest) + (packed ? "-gzip\"" : "\"");
  Response response;
  response.headers = {{"ETag", tag},
                      {"Vary", "Accept-Encoding"},
                      {"Content-Security-Policy", kPolicy},
                      {"Referrer-Policy", "no-referrer"}};
  if (lists_tag(header(request, "If-None-Match"), tag, true)) {
    response.status = 304;
    return response;
  }
  response.content_type = asset.content_type;
  response.body = packed ? asset.gzip : asset.plain;
  if (packed) {
    response.headers.push_back({"Content-Encoding", "gzip"});
  }
  return response;
}

}  // namespace

Response get_page(const Call& call) { return served(assets().front(), call.request); }

Response get_asset(const Call& call) {
  const auto found = std::ranges::find(assets(), call.id, &Asset::name);
  return found == assets().end() ? problem(404, "nothing is at this address")
                                 : served(*found, call.request);
}

}  // namespace kidnapwatch::api
