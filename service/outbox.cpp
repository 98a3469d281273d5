// SPDX-License-Identifier: Apache-2.0
// Which alerts are on their way, which have arrived, which are to go again.
#include "service/outbox.hpp"

namespace kidnapwatch::service {

/// Lives as long as the link holds the message: until it was delivered, refused or dropped.
class Outbox::OnItsWay {
 public:
  OnItsWay(std::shared_ptr<Sent> sent, std::string event_id)
      : sent_(std::move(sent)), event_id_(std::move(event_id)) {
    const std::lock_guard lock(sent_->mutex);
    sent_->on_their_way.insert(event_id_);
  }
  ~OnItsWay() {
    const std::lock_guard lock(sent_->mutex);
    sent_->on_their_way.erase(event_id_);
  }
  OnItsWay(const OnItsWay&) = delete;
  OnItsWay& operator=(const OnItsWay&) = delete;

  void arrived() const {
    const std::lock_guard lock(sent_->mutex);
    sent_->delivered.insert(event_id_);
  }
  [[nodiscard]] const std::string& event_id() const noexcept { return event_id_; }

 private:
  const std::shared_ptr<Sent> sent_;
  const std::string event_id_;
};

void Outbox::send(const storage::OutboxMessage& alert) {
  const auto on_its_way = std::make_shared<const OnItsWay>(sent_, alert.event_id);
  ways_.publish(alert, [this, on_its_way] {
    on_its_way->arrived();
    ways_.confirm(on_its_way->event_id());
  });
}

void Outbox::send_again(bool unresolved_too) {
  std::set<std::string> undelivered;
  for (const auto& alert : ways_.stored()) {
    if (!alert.delivered) undelivered.insert(alert.event_id);
    if (is_due(alert, unresolved_too)) send(alert);
  }
  forget_delivered_but(undelivered);
}

bool Outbox::is_due(const storage::OutboxMessage& alert, bool unresolved_too) const {
  const std::lock_guard lock(sent_->mutex);
  if (sent_->on_their_way.contains(alert.event_id)) return false;
  return unresolved_too || !(alert.delivered || sent_->delivered.contains(alert.event_id));
}

void Outbox::forget_delivered_but(const std::set<std::string>& undelivered) {
  const std::lock_guard lock(sent_->mutex);
  std::erase_if(sent_->delivered, [&](const auto& id) { return !undelivered.contains(id); });
}

}  // namespace kidnapwatch::service
