// SPDX-License-Identifier: Apache-2.0
// Counting connections in and out.
#include "api/connections.hpp"

#include <utility>
#include <vector>

namespace kidnapwatch::api {

Place Connections::enter(const void* connection, const std::string& peer, Stop stop) {
  const std::scoped_lock lock(mutex_);
  const auto known = peers_.find(peer);
  const Peer before = known == peers_.end() ? Peer{} : known->second;
  if (closed_ || in_.size() >= 2 * max_served_ || before.in >= 2 * max_per_peer_) {
    return Place::cut;
  }
  const bool is_served = served_ < max_served_ && before.served < max_per_peer_;
  const std::size_t more = is_served ? 1 : 0;
  served_ += more;
  peers_[peer] = {before.in + 1, before.served + more};
  in_.emplace(connection, Entry{std::move(stop), is_served, peer});
  return is_served ? Place::served : Place::refused;
}

void Connections::leave(const void* connection) {
  const std::scoped_lock lock(mutex_);
  if (const auto found = in_.find(connection); found != in_.end()) {
    const auto& [stop, is_served, name] = found->second;
    const auto peer = peers_.find(name);
    served_ -= is_served ? 1 : 0;
    peer->second.served -= is_served ? 1 : 0;
    if (--peer->second.in == 0) {
      peers_.erase(peer);
    }
    in_.erase(found);
  }
  left_.notify_all();
}

void Connections::close() {
  std::vector<Stop> stops;
  {
    const std::scoped_lock lock(mutex_);
    closed_ = true;
    for (const auto& [connection, entry] : in_) {
      stops.push_back(entry.stop);
    }
  }
  for (const auto& stop : stops) {  // outside the lock: the last one to hold a connection leaves
    stop();
  }
}

void Connections::wait_until_empty(std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  left_.wait_for(lock, at_most, [this] { return in_.empty(); });
}

}  // namespace kidnapwatch::api
