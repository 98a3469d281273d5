// SPDX-License-Identifier: Apache-2.0
// What waits for the store, and is written in one transaction.
#pragma once

#include <exception>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "storage/records.hpp"
#include "storage/segments.hpp"

namespace kidnapwatch::storage {

/// Something that somebody waits for.
struct Awaited {
  std::optional<ConfigText> config;  // nothing: a flush
  std::promise<void> done;
  std::exception_ptr refusal = nullptr;  // by the schema
};

/// A message that was confirmed.
struct Delivery {
  std::string event_id;
};

using Command = std::variant<IncidentChange, AuditEntry, Delivery, Gap, Awaited>;

/// What one transaction writes.
struct Batch {
  std::vector<ScoreRow> scores;
  std::map<std::string, std::vector<float>> learned;  // by robot
  std::vector<Command> commands;

  [[nodiscard]] bool empty() const { return scores.empty() && learned.empty() && commands.empty(); }
};

}  // namespace kidnapwatch::storage
