// SPDX-License-Identifier: Apache-2.0
// Topics built and taken apart.
#include "adapters/mqtt/topics.hpp"

#include <algorithm>

#include "core/bad_input.hpp"
#include "core/robot.hpp"

namespace kidnapwatch::adapters::mqtt {
namespace {

using core::BadInput;

[[nodiscard]] bool has_control(std::string_view text) {
  return std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
}

void check_prefix(std::string_view prefix) {
  const bool usable = !prefix.empty() && prefix.size() <= 256 && !prefix.starts_with('/') &&
                      !prefix.starts_with('$') && !prefix.ends_with('/') &&
                      prefix.find_first_of("+#") == std::string_view::npos && !has_control(prefix);
  if (!usable) {
    throw BadInput("prefix", "is not the beginning of a topic such as kidnapwatch/v1");
  }
}

void check_filter(std::string_view filter) {
  const std::size_t plus = filter.find('+');
  const bool once = plus != std::string_view::npos && plus == filter.rfind('+') &&
                    filter.find('#') == std::string_view::npos && !has_control(filter);
  const bool whole_level = once && (plus == 0 || filter[plus - 1] == '/') &&
                           (plus + 1 == filter.size() || filter[plus + 1] == '/');
  if (!whole_level) {
    throw BadInput("scan_filters", "\"" + std::string(filter) + "\" has not exactly one level +");
  }
}

[[nodiscard]] TopicKind kind_of(std::string_view level) {
  if (level == "scan") {
    return TopicKind::scan;
  }
  if (level == "odom") {
    return TopicKind::odom;
  }
  if (level == "particles") {
    return TopicKind::particles;
  }
  if (level == "command") {
    return TopicKind::command;
  }
  const bool own = level == "alert" || level == "state" || level == "score" ||
                   level == "response" || level.starts_with("response/");
  return own ? TopicKind::own : TopicKind::unknown;
}

[[nodiscard]] Topic with_robot(TopicKind kind, std::string_view robot) {
  if (kind == TopicKind::unknown || kind == TopicKind::own) {
    return {kind, {}};
  }
  if (!core::is_robot_id(robot)) {
    return {TopicKind::bad_robot_id, {}};
  }
  return {kind, robot};
}

}  // namespace

Topics::Topics(const TopicsConfig& config) : prefix_(config.prefix + "/") {
  check_prefix(config.prefix);
  for (const std::string& filter : config.scan_filters) {
    check_filter(filter);
    const std::size_t plus = filter.find('+');
    scan_filters_.push_back({filter.substr(0, plus), filter.substr(plus + 1)});
  }
}

std::string Topics::of(std::string_view robot, std::string_view kind) const {
  std::string topic;
  topic.reserve(prefix_.size() + robot.size() + 1 + kind.size());
  return topic.append(prefix_).append(robot).append("/").append(kind);
}

std::vector<std::string> Topics::filters() const {
  std::vector<std::string> filters{prefix_ + "#"};
  for (const auto& [before, after] : scan_filters_) {
    filters.emplace_back(before).append("+").append(after);
  }
  return filters;
}

bool Topics::may_answer(std::string_view robot, std::string_view topic) const {
  if (topic.empty() || !topic.starts_with(prefix_)) {
    return !topic.empty();
  }
  const std::string own = of(robot, "response");
  return topic == own || topic.starts_with(own + "/");
}

Topic Topics::below_prefix(std::string_view rest) const {
  const std::size_t slash = rest.find('/');
  if (slash == std::string_view::npos) {
    return {};
  }
  if (rest == "service/status") {
    return {TopicKind::own, {}};
  }
  return with_robot(kind_of(rest.substr(slash + 1)), rest.substr(0, slash));
}

Topic Topics::parse(std::string_view topic) const {
  for (const auto& [before, after] : scan_filters_) {
    if (topic.size() >= before.size() + after.size() && topic.starts_with(before) &&
        topic.ends_with(after)) {
      const std::string_view level =
          topic.substr(before.size(), topic.size() - before.size() - after.size());
      if (level.find('/') == std::string_view::npos) {
        return with_robot(TopicKind::scan, level);
      }
    }
  }
  return topic.starts_with(prefix_) ? below_prefix(topic.substr(prefix_.size())) : Topic{};
}

}  // namespace kidnapwatch::adapters::mqtt
