// SPDX-License-Identifier: Apache-2.0
// What is to be done to an incident, in.
#pragma once

#include <string_view>

#include "adapters/codecs/json.hpp"
#include "core/incident_command.hpp"

namespace kidnapwatch::adapters::codecs {

/// The command "ack", "unack", "resolve", "shelve" or "label" with its members in `body`: a
/// `comment`; with shelve the `seconds`, with label the `label`. It passes core::check; its author
/// is left to the caller. Throws BadInput naming the member.
[[nodiscard]] core::IncidentCommand incident_command(std::string_view action, const Json& body);

}  // namespace kidnapwatch::adapters::codecs
