// SPDX-License-Identifier: Apache-2.0
// MQTT byte by byte, for robots by the thousand: a client library would be the bottleneck.
#pragma once

#include <string>

namespace kidnapwatch::test {

/// A text with its length in front, as MQTT writes it.
inline std::string counted(const std::string& text) {
  return std::string{static_cast<char>(text.size() >> 8U), static_cast<char>(text.size())} + text;
}

/// A packet of MQTT 3.1.1 (2.2): type, remaining length in base 128, the rest.
inline std::string packet(char type, const std::string& rest) {
  std::string bytes{type};
  for (std::size_t left = rest.size();;) {
    const auto low = static_cast<unsigned char>(left % 128);
    left /= 128;
    bytes += static_cast<char>(left > 0 ? low | 0x80U : low);
    if (left == 0) return bytes + rest;
  }
}

inline std::string connect_packet(const std::string& id) {
  return packet('\x10',
                counted("MQTT") + std::string{'\x04', '\x02', '\x00', '\x3c'} + counted(id));
}

inline std::string publish_packet(const std::string& topic, const std::string& payload) {
  return packet('\x30', counted(topic) + payload);  // QoS 0
}

}  // namespace kidnapwatch::test
