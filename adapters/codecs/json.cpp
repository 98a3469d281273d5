// SPDX-License-Identifier: Apache-2.0
// Strict parsing and forgiving printing of JSON.
#include "adapters/codecs/json.hpp"

#include <set>
#include <vector>

#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

using Event = Json::parse_event_t;

/// Parser callback: which of two equal members counts is anybody's guess, so neither does.
class RefuseRepeatedMembers {
 public:
  explicit RefuseRepeatedMembers(std::string field) : field_(std::move(field)) {}

  bool operator()(int /*depth*/, Event event, const Json& value) {
    if (event == Event::object_start) {
      members_.emplace_back();
    } else if (event == Event::object_end) {
      members_.pop_back();
    } else if (event == Event::key && !members_.back().insert(value.get<std::string>()).second) {
      throw core::BadInput(field_, "names the member " + value.dump() + " twice");
    }
    return true;
  }

 private:
  std::string field_;
  std::vector<std::set<std::string>> members_;  // of the objects that are open
};

}  // namespace

Json parsed(std::string_view text, const std::string& field) {
  try {
    return Json::parse(text, RefuseRepeatedMembers(field));
  } catch (const Json::exception& error) {
    throw core::BadInput(field, std::string("is not JSON: ") + error.what());
  }
}

std::string text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace kidnapwatch::adapters::codecs
