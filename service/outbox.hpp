// SPDX-License-Identifier: Apache-2.0
// Alerts on their way to the broker: at once, and again until they have arrived.
#pragma once

#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "adapters/mqtt/link.hpp"
#include "storage/archive.hpp"
#include "storage/writer.hpp"

namespace kidnapwatch::service {

/// The store's outbox and the link's queue, kept in step: what the link has lost, or an earlier run
/// of the service left behind, goes out again. Every repetition carries the id of its event.
class Outbox {
 public:
  /// All outlive this.
  Outbox(adapters::mqtt::Link& link, storage::Writer& writer, const storage::Archive& archive)
      : link_(link), writer_(writer), archive_(archive) {}

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

  adapters::mqtt::Link& link_;
  storage::Writer& writer_;
  const storage::Archive& archive_;
  const std::shared_ptr<Sent> sent_ = std::make_shared<Sent>();
};

}  // namespace kidnapwatch::service
