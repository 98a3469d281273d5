// SPDX-License-Identifier: Apache-2.0
// The one thread that writes the store: everything through one bounded queue, in group commits.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <string>

#include "core/incident.hpp"
#include "core/status.hpp"

namespace kidnapwatch::storage {

struct WriterConfig {
  std::filesystem::path file;
  std::chrono::milliseconds commit_every{50};
  std::size_t max_queued = 100'000;
};

/// Durable once a commit returned (WAL, synchronous=FULL). Scores wait for the next group commit;
/// an incident, its evidence and a configuration are committed at once.
class Writer {
 public:
  /// Opens and migrates the file. Throws StorageError if that fails.
  explicit Writer(const WriterConfig& config);
  /// Writes all that is queued, then stops.
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// False, and counted, if the queue is full. Never blocks. Any thread.
  bool add_score(const std::string& robot, const core::Score& score, core::Stamp arrival);
  /// Inserts or, by id, replaces; `evidence` only with the first. Never refused. Any thread.
  void put_incident(const core::Incident& incident, std::optional<core::ScanPair> evidence);
  /// A new version of the configuration, as text; the future is ready when it is durable, and
  /// throws what went wrong.
  std::future<void> add_config(std::int64_t version, core::Stamp since, const std::string& author,
                               const std::string& text);

  [[nodiscard]] std::uint64_t queued() const;
  [[nodiscard]] std::uint64_t lost() const;  ///< refused scores
  [[nodiscard]] bool healthy() const;        ///< the last commit succeeded
};

}  // namespace kidnapwatch::storage
