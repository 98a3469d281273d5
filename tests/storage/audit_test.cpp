// SPDX-License-Identifier: Apache-2.0
// The audit trail holds, and tells when somebody has been at it.
#include "storage/audit.hpp"

#include <gtest/gtest.h>

#include "storage/archive.hpp"
#include "storage/schema.hpp"
#include "storage/upkeep.hpp"
#include "storage/writer.hpp"
#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {
namespace {

AuditEntry entry(int i) {
  return {.at = at_s(i),
          .actor = "eve",
          .action = "token.create",
          .subject = "token-" + std::to_string(i),
          .detail = ""};
}

class AuditTest : public testing::Test {
 protected:
  AuditTest() {
    AuditTrail trail(database_);
    for (int i = 1; i <= 5; ++i) trail.append(entry(i));
  }

  static Database created(const std::filesystem::path& file) {
    migrate(file);
    return {file, Access::read_write};
  }
  /// What somebody with the file in hand can do.
  void tamper(const std::string& sql) {
    database_.execute("DROP TRIGGER audit_is_not_changed; DROP TRIGGER audit_is_not_deleted");
    database_.execute(sql);
  }

  StoreFolder folder_;
  Database database_ = created(folder_.store());
};

TEST_F(AuditTest, EntriesComeBackNewestFirstByPages) {
  EXPECT_EQ(audit_entries(database_, std::nullopt, 2),
            (std::vector<NumberedAuditEntry>{{5, entry(5)}, {4, entry(4)}}));
  EXPECT_EQ(audit_entries(database_, 3, 10),
            (std::vector<NumberedAuditEntry>{{2, entry(2)}, {1, entry(1)}}));
}

TEST_F(AuditTest, AnUntouchedChainHolds) {
  EXPECT_EQ(first_broken_audit_entry(database_), std::nullopt);
}

TEST_F(AuditTest, NoChangeAndNoDeletionIsTaken) {
  EXPECT_THROW(database_.execute("UPDATE audit SET actor = 'bob' WHERE id = 3"), StorageError);
  EXPECT_THROW(database_.execute("DELETE FROM audit WHERE id = 5"), StorageError);
  EXPECT_EQ(audit_entries(database_, std::nullopt, 10).size(), 5U);
}

TEST_F(AuditTest, EveryForgedFieldBreaksTheChain) {
  for (const char* change :
       {"at = at + 1", "actor = 'bob'", "action = 'token.revoke'", "subject = 'x'", "detail = ' '",
        "hash = zeroblob(32)", "actor = 'ev', action = 'etoken.create'"}) {
    StoreFolder folder;
    backup(folder_.store(), folder.store());
    Database copy(folder.store(), Access::read_write);
    copy.execute("DROP TRIGGER audit_is_not_changed");
    copy.execute("UPDATE audit SET " + std::string(change) + " WHERE id = 3");
    EXPECT_EQ(first_broken_audit_entry(copy), 3) << change;
  }
}

/// With a hash that is right for the entry itself: the one after it tells.
TEST_F(AuditTest, AnEntryTakenFromAnotherChainBreaksTheNext) {
  const StoreFolder folder;
  Database other = created(folder.store());
  AuditTrail trail(other);
  for (int i = 1; i <= 5; ++i) trail.append(i == 3 ? entry(33) : entry(i));
  tamper("DELETE FROM audit WHERE id = 3");
  Statement(database_, "ATTACH ?1 AS other").bind(folder.store().string()).run();
  database_.execute("INSERT INTO audit SELECT * FROM other.audit WHERE id = 3");
  EXPECT_EQ(first_broken_audit_entry(database_), 4);
}

TEST_F(AuditTest, ARemovedEntryBreaksTheChain) {
  tamper("DELETE FROM audit WHERE id = 2");
  EXPECT_EQ(first_broken_audit_entry(database_), 2);
}

TEST_F(AuditTest, ARenumberedChainIsBroken) {
  tamper("DELETE FROM audit WHERE id = 2; UPDATE audit SET id = id - 1 WHERE id > 2");
  EXPECT_EQ(first_broken_audit_entry(database_), 2);
}

TEST(Audit, ChangesOfIncidentsAndConfigurationsLeaveEntries) {
  const StoreFolder folder;
  Writer writer({.file = folder.store()});
  const Archive archive(folder.store(), writer.recent());
  auto incident = incident_of(1);
  writer.put_incident({.incident = incident, .changed_at = at_s(1)});
  incident.seq = 2;
  incident.state = core::IncidentState::acknowledged;
  writer.put_incident({.incident = incident,
                       .type = core::AlertType::acknowledged,
                       .changed_at = at_s(2),
                       .author = "eve"});
  incident.seq = 1;  // overtaken: changes nothing
  writer.put_incident({.incident = incident, .changed_at = at_s(3), .author = "bob"});
  writer.add_audit(entry(4));
  writer.add_config({.version = 7, .since = at_s(5), .author = "eve", .text = "{}"}).get();
  const auto entries = archive.audit(std::nullopt, 10);
  ASSERT_EQ(entries.size(), 4U);
  EXPECT_EQ(entries[0].entry, (AuditEntry{at_s(5), "eve", "config.set", "7", "{}"}));
  EXPECT_EQ(entries[1].entry, entry(4));
  EXPECT_EQ(entries[2].entry.action, "incident.acknowledged");
  EXPECT_EQ(entries[2].entry.actor, "eve");
  EXPECT_EQ(entries[2].entry.at, at_s(2));
  EXPECT_EQ(entries[3].entry, (AuditEntry{at_s(1), "kidnapwatch", "incident.opened", incident.id,
                                          "robot robot-1, seq 1"}));
  EXPECT_EQ(archive.broken_audit_entry(), std::nullopt);
}

}  // namespace
}  // namespace kidnapwatch::storage
