// SPDX-License-Identifier: Apache-2.0
// Who changed what and when: only ever appended to, each entry bound to all before it by its hash.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "storage/records.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

/// Writes entries, within a transaction. Throws StorageError.
class AuditTrail {
 public:
  explicit AuditTrail(Database& database);

  void append(const AuditEntry& entry);

 private:
  Statement last_hash_;
  Statement add_;
};

/// Newest first, at most `limit`, only those before entry `before` if given.
[[nodiscard]] std::vector<NumberedAuditEntry> audit_entries(Database& database,
                                                            std::optional<std::int64_t> before,
                                                            std::size_t limit);

/// The number of the first entry that was changed, removed or put in afterwards; nothing if the
/// chain holds. Entries cut off at the end cannot be told from entries never made.
[[nodiscard]] std::optional<std::int64_t> first_broken_audit_entry(Database& database);

}  // namespace kidnapwatch::storage
