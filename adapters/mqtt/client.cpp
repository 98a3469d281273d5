// SPDX-License-Identifier: Apache-2.0
// The life of a client: connect, serve until the connection is lost, wait a little, again.
#include "adapters/mqtt/client.hpp"

#include <random>
#include <utility>

#include "adapters/mqtt/backoff.hpp"
#include "adapters/mqtt/connection.hpp"

namespace kidnapwatch::adapters::mqtt {
namespace {

constexpr int kMqtt5 = 5;
constexpr int kMqtt311 = 4;

using Clock = std::chrono::steady_clock;

/// Tells nobody where nobody listens, so that the calls need not ask.
[[nodiscard]] ClientEvents complete(ClientEvents events) {
  if (!events.on_message) {
    events.on_message = [](const Received&) {};
  }
  if (!events.on_connected) {
    events.on_connected = [] {};
  }
  if (!events.on_trouble) {
    events.on_trouble = [](const std::string&) {};
  }
  return events;
}

}  // namespace

Client::Client(const ClientConfig& config, ClientEvents events)
    : config_(config), events_(complete(std::move(events))), queue_(config.queue) {
  (void)paho_url(config_.broker.url);  // throws here rather than on the thread
}

Client::~Client() { stop(std::chrono::milliseconds{0}); }

void Client::start() {
  thread_ = std::thread([this] { run(); });
}

void Client::publish(Message message) noexcept {
  auto shared = std::make_shared<const Message>(std::move(message));
  {
    const std::lock_guard lock(mutex_);
    queue_.push(std::move(shared));
  }
  changed_.notify_all();
}

bool Client::wait_connected(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, timeout, [this] { return connected_.load(); });
}

bool Client::wait_for_room(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, timeout, [this] { return connected_ && !queue_.full(); });
}

bool Client::drain(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, timeout, [this] { return queue_.empty(); });
}

void Client::stop(std::chrono::milliseconds timeout) {
  {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return !connected_ || queue_.empty(); });
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
  }
}

ClientStats Client::stats() const {
  const std::lock_guard lock(mutex_);
  ClientStats stats = stats_;
  stats.connected = connected_;
  stats.queued = queue_.queued();
  stats.in_flight = queue_.in_flight();
  stats.dropped = queue_.dropped();
  return stats;
}

void Client::run() {
  Backoff backoff(config_.broker.backoff_min, config_.broker.backoff_max, std::random_device{}());
  while (!stopping()) {
    const auto since = Clock::now();
    if (connect()) {
      serve();
    }
    if (Clock::now() - since > config_.broker.backoff_max) {
      backoff.reset();  // not for a broker that lets us in only to throw us out
    }
    pause(backoff.next());
  }
  connection_.reset();
}

bool Client::connect() {
  Attempt result = attempt(kMqtt5);
  if (result == Attempt::wrong_protocol) {
    result = attempt(kMqtt311);
  }
  return result == Attempt::made;
}

Client::Attempt Client::attempt(int protocol) {
  const std::uint64_t epoch = begin_epoch(protocol);
  try {
    // The new one before the old one goes: without any client, Paho would end its threads.
    connection_ = std::make_unique<Connection>(config_, protocol, connection_events(epoch));
  } catch (const std::exception& error) {
    connect_ended(epoch, error.what(), false);
  }
  return await_attempt();
}

std::uint64_t Client::begin_epoch(int protocol) {
  const std::lock_guard lock(mutex_);
  attempt_ = Attempt::pending;
  lost_ = false;
  stats_.protocol = protocol;
  return ++epoch_;
}

ConnectionEvents Client::connection_events(std::uint64_t epoch) {
  return {
      .on_connect_ended = [this, epoch](
                              const std::string& error,
                              bool wrong_protocol) { connect_ended(epoch, error, wrong_protocol); },
      .on_lost = [this, epoch] { lost(epoch); },
      .on_message = events_.on_message,
      .on_delivered = [this](std::uint64_t ticket) { delivered(ticket); },
      .on_refused = [this](std::uint64_t ticket, const std::string& why) { refused(ticket, why); },
      .on_subscription_refused =
          [this](const std::string& why) { trouble("subscription " + why); }};
}

Client::Attempt Client::await_attempt() {
  std::unique_lock lock(mutex_);
  const auto patience = config_.broker.connect_timeout + std::chrono::seconds{5};
  changed_.wait_for(lock, patience, [this] { return attempt_ != Attempt::pending || stopping_; });
  return attempt_;
}

void Client::serve() {
  connection_->subscribe();
  {
    const std::lock_guard lock(mutex_);
    queue_.connection_made();
    ++stats_.connects;
    connected_ = true;
  }
  changed_.notify_all();
  events_.on_connected();
  std::unique_lock lock(mutex_);
  while (!lost_ && !stopping_) {
    send_waiting(lock);
    changed_.wait(lock, [this] { return lost_ || stopping_ || queue_.can_send(); });
  }
  leave(lock);
}

void Client::send_waiting(std::unique_lock<std::mutex>& lock) {
  while (const auto sending = lost_ ? std::nullopt : queue_.next()) {
    lock.unlock();
    send(*sending);
    lock.lock();
  }
}

void Client::send(const SendQueue::Sending& sending) {
  switch (connection_->publish(sending.ticket, sending.message)) {
    case Connection::Sent::yes:
      break;
    case Connection::Sent::disconnected:
      lost(epoch_);  // which only this thread changes
      break;
    case Connection::Sent::unsendable:
      refused(sending.ticket, "is not sendable");
      break;
  }
}

void Client::leave(std::unique_lock<std::mutex>& lock) {
  connected_ = false;
  queue_.connection_lost();
  const bool was_lost = lost_;
  lock.unlock();
  changed_.notify_all();
  if (was_lost) {
    trouble("connection lost");
  } else {
    connection_->disconnect(std::chrono::seconds{1});
  }
}

bool Client::stopping() const {
  const std::lock_guard lock(mutex_);
  return stopping_;
}

void Client::pause(std::chrono::milliseconds wait) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, wait, [this] { return stopping_; });
}

void Client::connect_ended(std::uint64_t epoch, const std::string& error, bool wrong_protocol) {
  bool is_news = false;
  {
    const std::lock_guard lock(mutex_);
    if (epoch != epoch_) {
      return;
    }
    const Attempt failure = wrong_protocol ? Attempt::wrong_protocol : Attempt::failed;
    attempt_ = error.empty() ? Attempt::made : failure;
    is_news = !wrong_protocol && std::exchange(told_, error) != error;
  }
  changed_.notify_all();
  if (is_news && !error.empty()) {
    trouble("connecting: " + error);
  }
}

void Client::lost(std::uint64_t epoch) {
  {
    const std::lock_guard lock(mutex_);
    lost_ = lost_ || epoch == epoch_;
  }
  changed_.notify_all();
}

void Client::delivered(std::uint64_t ticket) {
  std::shared_ptr<const Message> message;
  {
    const std::lock_guard lock(mutex_);
    message = queue_.finish(ticket);
    stats_.delivered += message ? 1 : 0;
  }
  changed_.notify_all();
  if (message && message->on_delivered) {
    message->on_delivered();
  }
}

void Client::refused(std::uint64_t ticket, const std::string& why) {
  std::shared_ptr<const Message> message;
  {
    const std::lock_guard lock(mutex_);
    message = queue_.finish(ticket);
    stats_.refused += message ? 1 : 0;
  }
  changed_.notify_all();
  if (message) {
    trouble("message on " + message->topic + " " + why);
  }
}

void Client::trouble(const std::string& what) const {
  events_.on_trouble(config_.broker.url + ": " + what);
}

}  // namespace kidnapwatch::adapters::mqtt
