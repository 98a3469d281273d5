// SPDX-License-Identifier: Apache-2.0
// Migrations: fresh files, older ones, newer ones and those of others.
#include "storage/schema.hpp"

#include <array>

#include <gtest/gtest.h>

#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {
namespace {

constexpr std::array<std::string_view, 1> kOld{"CREATE TABLE a (x INTEGER) STRICT"};
constexpr std::array<std::string_view, 2> kNew{kOld[0],
                                               "ALTER TABLE a ADD COLUMN y INTEGER DEFAULT 5"};
constexpr std::array<std::string_view, 3> kBroken{kNew[0], kNew[1],
                                                  "CREATE TABLE c (x INTEGER); NONSENSE"};

class MigrationTest : public testing::Test {
 protected:
  [[nodiscard]] std::int64_t read(const std::string& sql) const {
    return Database(folder_.store(), Access::read_only).integer(sql);
  }
  [[nodiscard]] std::int64_t version() const { return read("PRAGMA user_version"); }

  StoreFolder folder_;
};

TEST_F(MigrationTest, AFreshFileGetsTheLatestSchema) {
  migrate(folder_.store());
  EXPECT_EQ(version(), static_cast<std::int64_t>(migrations().size()));
  EXPECT_EQ(read("SELECT count(*) FROM incident"), 0);
  EXPECT_EQ(read("PRAGMA auto_vacuum"), 2);  // incremental
}

TEST_F(MigrationTest, EveryTableIsStrict) {
  migrate(folder_.store());
  EXPECT_EQ(read("SELECT count(*) FROM pragma_table_list WHERE type = 'table' AND strict = 0 AND "
                 "name NOT LIKE 'sqlite_%'"),
            0);
}

TEST_F(MigrationTest, AnOlderFileKeepsItsRowsAndIsCopiedFirst) {
  migrate(folder_.store(), kOld);
  Database(folder_.store(), Access::read_write).execute("INSERT INTO a VALUES (41)");
  migrate(folder_.store(), kNew);
  EXPECT_EQ(version(), 2);
  EXPECT_EQ(read("SELECT x + y FROM a"), 46);
  Database copy(folder_.store().string() + ".schema-1", Access::read_only);
  EXPECT_EQ(copy.integer("PRAGMA user_version"), 1);
  EXPECT_EQ(copy.integer("SELECT x FROM a"), 41);
}

TEST_F(MigrationTest, AMigratedFileIsLeftAlone) {
  migrate(folder_.store(), kNew);
  Database(folder_.store(), Access::read_write).execute("INSERT INTO a (x) VALUES (1)");
  migrate(folder_.store(), kNew);
  EXPECT_EQ(read("SELECT count(*) FROM a"), 1);
  EXPECT_FALSE(std::filesystem::exists(folder_.store().string() + ".schema-2"));
}

TEST_F(MigrationTest, AFailingStepChangesNothing) {
  migrate(folder_.store(), kOld);
  EXPECT_THROW(migrate(folder_.store(), kBroken), StorageError);
  EXPECT_EQ(version(), 1);
  EXPECT_EQ(read("SELECT count(*) FROM pragma_table_info('a')"), 1);
}

TEST_F(MigrationTest, ANewerSchemaIsRefusedByName) {
  migrate(folder_.store(), kNew);
  try {
    migrate(folder_.store(), kOld);
    FAIL();
  } catch (const StorageError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("schema 2 is newer than this program's 1"), std::string::npos) << what;
    EXPECT_NE(what.find(folder_.store().string()), std::string::npos) << what;
  }
  EXPECT_EQ(version(), 2);
}

TEST_F(MigrationTest, ADatabaseOfAnotherProgramIsRefused) {
  Database(folder_.store(), Access::read_write).execute("CREATE TABLE precious (x)");
  EXPECT_THROW(migrate(folder_.store()), StorageError);
  EXPECT_EQ(read("SELECT count(*) FROM sqlite_schema"), 1);
}

}  // namespace
}  // namespace kidnapwatch::storage
