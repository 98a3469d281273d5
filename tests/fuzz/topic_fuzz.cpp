// SPDX-License-Identifier: Apache-2.0
// Any bytes as the topic of a message, and, as a filter, in front of one.
#include <cassert>

#include "adapters/mqtt/topics.hpp"
#include "core/bad_input.hpp"
#include "core/robot.hpp"
#include "tests/fuzz/input.hpp"

using namespace kidnapwatch;
using adapters::mqtt::TopicKind;

namespace {

bool names_a_robot(TopicKind kind) {
  return kind == TopicKind::scan || kind == TopicKind::odom || kind == TopicKind::particles ||
         kind == TopicKind::command;
}

void parse(const adapters::mqtt::Topics& topics, std::string_view text) {
  const auto topic = topics.parse(text);
  assert(names_a_robot(topic.kind) == core::is_robot_id(topic.robot));
}

}  // namespace

/// The first line is a filter and may be empty, the rest a topic.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const adapters::mqtt::Topics plain;
  const auto text = test::text_of(data, size);
  const auto end = std::min(text.find('\n'), text.size());
  const auto topic = std::string_view(text).substr(std::min(end + 1, text.size()));
  parse(plain, topic);
  try {
    parse(adapters::mqtt::Topics({.scan_filters = {text.substr(0, end)}}), topic);
  } catch (const core::BadInput&) {
  }
  return 0;
}
