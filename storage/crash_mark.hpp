// SPDX-License-Identifier: Apache-2.0
// Says after a crash which scores may be missing.
#pragma once

#include <optional>

#include "core/stamp.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

/// In the store while somebody writes scores: found there at the next start, he died, and what he
/// had queued since his last commit is lost. One thread. Throws StorageError.
class CrashMark {
 public:
  /// Reads whether there is one, and how far that writer came.
  explicit CrashMark(Database& database);

  /// Within a transaction: with the first scores, sets it, and adds the gap that a crash left
  /// before them.
  void set(core::Stamp first_arrival);
  void committed() { is_set_ = is_set_ || is_setting_; }
  void undone() { is_setting_ = false; }

  /// After the last commit: nothing is missing.
  void clear();

 private:
  Database& database_;
  std::optional<core::Stamp> died_at_;  // time of arrival of the last score before the crash
  bool is_setting_ = false;             // in this transaction
  bool is_set_ = false;
};

}  // namespace kidnapwatch::storage
