// SPDX-License-Identifier: Apache-2.0
// The dashboard's files, built in (web/embed.py), and the routes that serve them.
#pragma once

#include <span>
#include <string_view>

#include "api/call.hpp"

namespace kidnapwatch::api {

struct Asset {
  std::string_view name;
  std::string_view content_type;
  std::string_view digest;  ///< of the content
  std::string_view plain;
  std::string_view gzip;  ///< the same, compressed
};

/// The first is the page itself.
[[nodiscard]] std::span<const Asset> assets();

[[nodiscard]] Response get_page(const Call& call);
[[nodiscard]] Response get_asset(const Call& call);

}  // namespace kidnapwatch::api
