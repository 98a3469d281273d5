// SPDX-License-Identifier: Apache-2.0
// The description of the API, built in.
#pragma once

#include <string_view>

namespace kidnapwatch::api {

/// openapi.yaml as JSON, converted when the service is built (embed_openapi.py).
[[nodiscard]] std::string_view openapi_json();

}  // namespace kidnapwatch::api
