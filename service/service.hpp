// SPDX-License-Identifier: Apache-2.0
// The running service: broker, fleet, store and REST wired together.
#pragma once

#include <cstdint>
#include <memory>

#include "service/settings.hpp"

namespace kidnapwatch::service {

class Service {
 public:
  /// Starts everything. The broker need not be there yet. Throws BadInput for settings that cannot
  /// work together, StorageError or std::system_error where a resource is not to be had.
  explicit Service(const Settings& settings);
  /// stop()s.
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  [[nodiscard]] std::uint16_t http_port() const;

  /// In the order in which a scan travels: no new messages, queued scans judged, their alerts sent,
  /// their scores written, REST closed. What the broker does not take within 5 s stays unsent.
  void stop();

 private:
  class Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace kidnapwatch::service
