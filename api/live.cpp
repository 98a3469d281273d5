// SPDX-License-Identifier: Apache-2.0
// What changed, robot by robot.
#include "api/live.hpp"

#include "adapters/codecs/status_json.hpp"

namespace kidnapwatch::api {
namespace {

constexpr double kEvery_s = 1.0;

}  // namespace

std::string LiveRobots::since(std::uint64_t& version,
                              const std::function<bool(const std::string& robot)>& may_see) {
  const std::lock_guard lock(mutex_);
  if (version_ == 0 || now_s_() >= refreshed_s_ + kEvery_s) {
    refresh();
  }
  std::string list;
  for (const auto& [robot, words] : robots_) {
    if (words.version > version && may_see(robot)) {
      list.append(list.empty() ? "" : ",").append(words.json);
    }
  }
  const bool is_first = version == 0;  // that there are none is worth telling once
  version = version_;
  return list.empty() && !is_first ? "" : R"({"robots":[)" + list + "]}";
}

void LiveRobots::refresh() {
  ++version_;
  refreshed_s_ = now_s_();
  for (const auto& robot : fleet_.robots()) {
    auto json = adapters::codecs::text(adapters::codecs::brief_json(robot));
    auto& words = robots_[robot.id];
    if (words.json != json) {
      words = {std::move(json), version_};
    }
  }
}

}  // namespace kidnapwatch::api
