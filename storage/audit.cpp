// SPDX-License-Identifier: Apache-2.0
// The chain: SHA-256 over the hash before, the entry's number and its fields.
#include "storage/audit.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <openssl/evp.h>

#include "storage/bytes.hpp"

namespace kidnapwatch::storage {
namespace {

using Hash = std::array<std::byte, 32>;

Hash sha256(std::span<const std::byte> bytes) {
  Hash hash;
  auto* out = static_cast<unsigned char*>(static_cast<void*>(hash.data()));
  if (EVP_Digest(bytes.data(), bytes.size(), out, nullptr, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("SHA-256 is not available");
  }
  return hash;
}

/// Lengths go in front of the texts, so that nothing can move from one field into the next.
Hash chained(const Hash& before, const NumberedAuditEntry& numbered) {
  const AuditEntry& entry = numbered.entry;
  ByteWriter bytes;
  bytes.put(before);
  bytes.put(numbered.number);
  bytes.put(core::ns_since_epoch(entry.at));
  for (const std::string_view text :
       {std::string_view(entry.actor), std::string_view(entry.action),
        std::string_view(entry.subject), std::string_view(entry.detail)}) {
    bytes.put_varint(text.size());
    for (const char c : text) bytes.put(c);
  }
  return sha256(bytes.bytes());
}

Hash hash_from(std::span<const std::byte> blob) {
  Hash hash{};
  std::ranges::copy(blob.first(std::min(blob.size(), hash.size())), hash.begin());
  return hash;
}

NumberedAuditEntry entry_from(const Statement& row) {
  return {.number = row.integer(0),
          .entry = {.at = row.stamp(1),
                    .actor = row.text(2),
                    .action = row.text(3),
                    .subject = row.text(4),
                    .detail = row.text(5)}};
}

}  // namespace

AuditTrail::AuditTrail(Database& database)
    : last_hash_(database, "SELECT id, hash FROM audit ORDER BY id DESC LIMIT 1"),
      add_(database, "INSERT INTO audit VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)") {}

void AuditTrail::append(const AuditEntry& entry) {
  NumberedAuditEntry numbered{.number = 1, .entry = entry};
  Hash before{};
  if (last_hash_.bind().step()) {
    numbered.number = last_hash_.integer(0) + 1;
    before = hash_from(last_hash_.blob(1));
  }
  last_hash_.bind();
  const Hash hash = chained(before, numbered);
  add_.bind(numbered.number, entry.at, entry.actor, entry.action, entry.subject, entry.detail,
            std::span<const std::byte>(hash))
      .run();
}

std::vector<NumberedAuditEntry> audit_entries(Database& database,
                                              std::optional<std::int64_t> before,
                                              std::size_t limit) {
  Statement query(database,
                  "SELECT * FROM audit WHERE ?1 IS NULL OR id < ?1 ORDER BY id DESC LIMIT ?2");
  query.bind(before, limit);
  std::vector<NumberedAuditEntry> entries;
  while (query.step()) entries.push_back(entry_from(query));
  return entries;
}

std::optional<std::int64_t> first_broken_audit_entry(Database& database) {
  Statement query(database, "SELECT * FROM audit ORDER BY id");
  Hash before{};
  for (std::int64_t expected = 1; query.step(); ++expected) {
    const auto numbered = entry_from(query);
    before = chained(before, numbered);
    if (numbered.number != expected || !std::ranges::equal(query.blob(6), before)) {
      return expected;
    }
  }
  return std::nullopt;
}

}  // namespace kidnapwatch::storage
