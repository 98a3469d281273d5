// SPDX-License-Identifier: Apache-2.0
// The outgoing queue: a window of flights before a line of waiting messages.
#include "adapters/mqtt/send_queue.hpp"

#include <algorithm>
#include <utility>

namespace kidnapwatch::adapters::mqtt {

void SendQueue::push(std::shared_ptr<const Message> message) {
  if (!connected_ && message->qos == 0) {
    ++dropped_;
    return;
  }
  if (full() && !waiting_.empty()) {
    waiting_.pop_front();
    ++dropped_;
  }
  waiting_.push_back(std::move(message));
}

void SendQueue::connection_lost() {
  connected_ = false;
  for (; !in_flight_.empty(); in_flight_.pop_back()) {
    waiting_.push_front(std::move(in_flight_.back().message));
  }
  dropped_ += std::erase_if(waiting_, [](const auto& message) { return message->qos == 0; });
}

bool SendQueue::can_send() const noexcept {
  return connected_ && !waiting_.empty() && in_flight_.size() < config_.max_in_flight;
}

std::optional<SendQueue::Sending> SendQueue::next() {
  if (!can_send()) {
    return std::nullopt;
  }
  in_flight_.push_back({next_ticket_++, std::move(waiting_.front())});
  waiting_.pop_front();
  return in_flight_.back();
}

std::shared_ptr<const Message> SendQueue::finish(std::uint64_t ticket) {
  const auto flight = std::ranges::lower_bound(in_flight_, ticket, {}, &Sending::ticket);
  if (flight == in_flight_.end() || flight->ticket != ticket) {
    return nullptr;
  }
  auto message = std::move(flight->message);
  in_flight_.erase(flight);
  return message;
}

}  // namespace kidnapwatch::adapters::mqtt
