// SPDX-License-Identifier: Apache-2.0
// Counting connections in and out.
#include "api/connections.hpp"

#include <utility>
#include <vector>

namespace kidnapwatch::api {

Place Connections::enter(const void* connection, Stop stop) {
  const std::scoped_lock lock(mutex_);
  if (closed_ || in_.size() >= 2 * max_served_) {
    return Place::cut;
  }
  const bool fits = served_ < max_served_;
  served_ += fits ? 1 : 0;
  in_.emplace(connection, Entry{std::move(stop), fits});
  return fits ? Place::served : Place::refused;
}

void Connections::leave(const void* connection) {
  const std::scoped_lock lock(mutex_);
  if (const auto found = in_.find(connection); found != in_.end()) {
    served_ -= found->second.served ? 1 : 0;
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
