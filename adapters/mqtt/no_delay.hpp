// SPDX-License-Identifier: Apache-2.0
// Small messages at once: Nagle's algorithm turned off where Paho leaves it on.
#pragma once

#include <cstdint>
#include <string>

namespace kidnapwatch::adapters::mqtt {

/// The port of a broker's URL, mqtt://host:1883; its scheme's own if it names none.
[[nodiscard]] std::uint16_t port_of(const std::string& url);

/// Sets TCP_NODELAY on every connection of this process to that port, for Paho neither does so nor
/// gives its sockets away. Does nothing where there is no /proc/self/fd.
void set_no_delay(std::uint16_t peer_port);

}  // namespace kidnapwatch::adapters::mqtt
