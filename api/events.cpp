// SPDX-License-Identifier: Apache-2.0
// One client's view of the events: where it is, and what it may see.
#include "api/events.hpp"

#include <charconv>
#include <memory>
#include <utility>

#include "core/bad_input.hpp"

namespace kidnapwatch::api {
namespace {

constexpr std::size_t kAlertsAtOnce = 100;
constexpr double kRobotsEvery_s = 1.0;
constexpr double kCheckEvery_s = 1.0;
constexpr double kSignOfLifeEvery_s = 15.0;  // proxies cut what is silent for longer

/// `after`: the number of the last alert that is told by then, for whoever comes back.
std::string event(std::int64_t after, std::string_view type, std::string_view data) {
  return "id: " + std::to_string(after) + "\nevent: " + std::string(type) +
         "\ndata: " + std::string(data) + "\n\n";
}

class Events final : public Feed {
 public:
  /// After alert number `after`; `robot` empty: of all.
  Events(const Call& call, std::int64_t after, std::string robot, std::string first)
      : ports_(call.ports),
        request_(call.request),
        caller_(call.caller),
        robot_(std::move(robot)),
        after_(after),
        text_(std::move(first)),
        spoken_s_(ports_.live.now_s()),
        checked_s_(spoken_s_) {}

  std::optional<std::string> next() override {
    const double now_s = ports_.live.now_s();
    std::string text = std::exchange(text_, "");
    text += alerts();
    text += robots(now_s);
    if (text.empty() && now_s >= spoken_s_ + kSignOfLifeEvery_s) {
      text = ":\n\n";
    }
    if (text.empty() && now_s < checked_s_ + kCheckEvery_s) {
      return text;
    }
    checked_s_ = now_s;
    if (ports_.guard.caller(request_) != caller_) {
      return std::nullopt;  // the token was revoked, or means another role now
    }
    if (!text.empty()) {
      spoken_s_ = now_s;
    }
    return text;
  }

 private:
  [[nodiscard]] bool may_see(const std::string& robot) const {
    return caller_.may_see(robot) && (robot_.empty() || robot == robot_);
  }

  std::string alerts() {
    std::string text;
    for (const auto& alert : ports_.history.alerts(after_, kAlertsAtOnce)) {
      after_ = alert.number;
      if (may_see(alert.robot)) {
        text += event(after_, "alert", alert.json);
      }
    }
    return text;
  }

  std::string robots(double now_s) {
    if (now_s < robots_due_s_) {
      return "";
    }
    robots_due_s_ = now_s + kRobotsEvery_s;
    const auto json =
        ports_.live.since(robots_version_, [this](const auto& robot) { return may_see(robot); });
    return json.empty() ? "" : event(after_, "robots", json);
  }

  const Ports ports_;
  const Request request_;
  const Caller caller_;
  const std::string robot_;
  std::int64_t after_;
  std::string text_;  // not sent yet
  std::uint64_t robots_version_ = 0;
  double robots_due_s_ = 0.0;
  double spoken_s_;
  double checked_s_;  // that the token still means the same
};

/// Throws BadInput unless it is the id of an event.
std::optional<std::int64_t> last_event_id(const Request& request) {
  const std::string_view text = header(request, "Last-Event-ID");
  if (text.empty()) {
    return std::nullopt;
  }
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 0) {
    throw core::BadInput("Last-Event-ID", "must be the id of an event");
  }
  return number;
}

}  // namespace

Response get_events(const Call& call) {
  const auto robot = parameter(call, "robot").value_or("");
  const auto seen = last_event_id(call.request);
  if (!robot.empty() && !call.caller.may_see(robot)) {
    return no_such_robot(call);
  }
  const auto numbers = call.ports.history.alert_numbers();
  const bool is_gone = seen && (*seen > numbers.last || *seen + 1 < numbers.first);
  const auto after = seen && !is_gone ? *seen : numbers.last;
  std::string first = "retry: 1000\n\n";
  if (is_gone) {
    first += event(after, "gap", R"({"since":)" + std::to_string(*seen) + "}");
  }
  return {.status = 200,
          .content_type = "text/event-stream",
          .body = "",
          .headers = {{"X-Accel-Buffering", "no"}},
          .feed = std::make_shared<Events>(call, after, robot, std::move(first))};
}

}  // namespace kidnapwatch::api
