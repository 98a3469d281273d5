// SPDX-License-Identifier: Apache-2.0
// The descriptions of REST and of MQTT, built in.
#pragma once

#include <string_view>

namespace kidnapwatch::api {

/// openapi.yaml as JSON, converted when the service is built (embed_descriptions.py).
[[nodiscard]] std::string_view openapi_json();

/// asyncapi.yaml, likewise.
[[nodiscard]] std::string_view asyncapi_json();

}  // namespace kidnapwatch::api
