// SPDX-License-Identifier: Apache-2.0
// What went wrong with a request, as RFC 9457 problem details.
#pragma once

#include <string>

#include "api/http.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::api {

/// application/problem+json with type "about:blank", so the title is the status's reason.
[[nodiscard]] Response problem(int status, const std::string& detail);

/// 400, with the field beside the detail.
[[nodiscard]] Response problem(const core::BadInput& error);

}  // namespace kidnapwatch::api
