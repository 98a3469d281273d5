// SPDX-License-Identifier: Apache-2.0
// Alerts on their way to the broker: at once, and again until they have arrived.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "storage/records.hpp"

namespace kidnapwatch::service {

/// The store's outbox and the link's queue, kept in step: what the link has lost, or an earlier run
/// of the service left behind, goes out again. Every repetition carries the id of its event.
class Outbox {
 public:
  /// Where alerts go and where they come from.
  struct Ways {
    /// To the broker. `on_delivered` is called when it has the alert, and destroyed when it was
    /// delivered, refused or dropped.
    std::function<void(const storage::OutboxMessage&, std::function<void()> on_delivered)> publish;
    /// To the store: this one has arrived.
    std::function<void(const std::string& event_id)> confirm;
    /// Of the store, in order. Throws StorageError.
    std::function<std::vector<storage::OutboxMessage>()> stored;
  };
  explicit Outbox(Ways ways) : ways_(std::move(ways)) {}

  /// The store has the alert, or will have. Never blocks. Any thread.
  void send(const storage::OutboxMessage& alert);

  /// What was not delivered and is not on its way; after a connection was made also the alerts of
  /// unresolved incidents, for a broker may forget what it has confirmed. Throws StorageError.
  void send_again(bool unresolved_too);

 private:
  /// Ids of events; shared with messages, which may outlive this.
  struct Sent {
    std::mutex mutex;
    std::set<std::string> on_their_way;  // in the link's hands
    std::set<std::string> delivered;     // as the store may not know yet
  };
  class OnItsWay;

  [[nodiscard]] bool is_due(const storage::OutboxMessage& alert, bool unresolved_too) const;
  void forget_delivered_but(const std::set<std::string>& undelivered);

  const Ways ways_;
  const std::shared_ptr<Sent> sent_ = std::make_shared<Sent>();
};

}  // namespace kidnapwatch::service
