// SPDX-License-Identifier: Apache-2.0
// Routes: the service itself, for people and for machines that watch it.
#pragma once

#include "api/call.hpp"

namespace kidnapwatch::api {

/// Who calls: for a page that shows only what the caller may do.
[[nodiscard]] Response get_me(const Call& call);
[[nodiscard]] Response get_service(const Call& call);
[[nodiscard]] Response get_openapi(const Call& call);
[[nodiscard]] Response get_asyncapi(const Call& call);
/// 200 as long as the process answers at all.
[[nodiscard]] Response get_health(const Call& call);
/// 503 with the reasons while the service cannot do its work: no broker, no store.
[[nodiscard]] Response get_readiness(const Call& call);
/// Prometheus text format 0.0.4.
[[nodiscard]] Response get_metrics(const Call& call);

}  // namespace kidnapwatch::api
