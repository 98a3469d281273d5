// SPDX-License-Identifier: Apache-2.0
// The thin layer over SQLite.
#include "storage/sqlite.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {
namespace {

class SqliteTest : public testing::Test {
 protected:
  SqliteTest() { database_.execute("CREATE TABLE t (id INTEGER PRIMARY KEY, v ANY) STRICT"); }

  std::int64_t rows() { return database_.integer("SELECT count(*) FROM t"); }

  StoreFolder folder_;
  Database database_{folder_.store(), Access::read_write};
};

TEST_F(SqliteTest, ValuesOfEveryTypeComeBack) {
  const std::vector<std::byte> bytes{std::byte{0}, std::byte{255}};
  Statement echo(database_, "SELECT ?1, ?2, ?3, ?4, ?5, ?6");
  ASSERT_TRUE(echo.bind(std::numeric_limits<std::int64_t>::min(), 0.1, std::string("a\0b", 3),
                        bytes, std::optional<double>(), std::optional<std::string>("x"))
                  .step());
  EXPECT_EQ(echo.integer(0), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(echo.real(1), 0.1);
  EXPECT_EQ(echo.text(2), std::string("a\0b", 3));
  EXPECT_TRUE(std::ranges::equal(echo.blob(3), bytes));
  EXPECT_TRUE(echo.is_null(4));
  EXPECT_EQ(echo.text(5), "x");
}

TEST_F(SqliteTest, NanIsNullAndNullReadsAsNan) {
  Statement echo(database_, "SELECT ?1, ?2");
  ASSERT_TRUE(echo.bind(std::nan(""), std::numeric_limits<double>::infinity()).step());
  EXPECT_TRUE(echo.is_null(0));
  EXPECT_TRUE(std::isnan(echo.real(0)));
  EXPECT_EQ(echo.real(1), std::numeric_limits<double>::infinity());
}

TEST_F(SqliteTest, EmptyTextAndBlobsAreNotNull) {
  Statement echo(database_, "SELECT ?1, ?2");
  ASSERT_TRUE(echo.bind(std::string_view(), std::span<const std::byte>()).step());
  EXPECT_FALSE(echo.is_null(0));
  EXPECT_FALSE(echo.is_null(1));
  EXPECT_EQ(echo.text(0), "");
  EXPECT_TRUE(echo.blob(1).empty());
}

TEST_F(SqliteTest, ATransactionNotCommittedIsUndone) {
  {
    const Transaction transaction(database_, Transaction::Kind::write);
    database_.execute("INSERT INTO t (v) VALUES (1)");
    EXPECT_EQ(rows(), 1);
  }
  EXPECT_EQ(rows(), 0);
}

TEST_F(SqliteTest, ACommittedTransactionStays) {
  Transaction transaction(database_, Transaction::Kind::write);
  database_.execute("INSERT INTO t (v) VALUES (1)");
  transaction.commit();
  EXPECT_EQ(Database(folder_.store(), Access::read_only).integer("SELECT count(*) FROM t"), 1);
}

TEST_F(SqliteTest, TellsAForbiddenRowFromOtherFailures) {
  database_.execute("INSERT INTO t VALUES (7, 1)");
  try {
    database_.execute("INSERT INTO t VALUES (7, 2)");
    FAIL();
  } catch (const StorageError& error) {
    EXPECT_TRUE(error.is_constraint());
    EXPECT_FALSE(error.is_damage());
    EXPECT_NE(std::string(error.what()).find("t.id"), std::string::npos) << error.what();
  }
}

TEST_F(SqliteTest, RefusesBadSqlWithItsReason) {
  try {
    const Statement statement(database_, "SELECT x FROM nowhere");
    FAIL();
  } catch (const StorageError& error) {
    EXPECT_NE(std::string(error.what()).find("nowhere"), std::string::npos) << error.what();
    EXPECT_FALSE(error.is_constraint());
  }
}

TEST_F(SqliteTest, AReaderCannotWrite) {
  Database reader(folder_.store(), Access::read_only);
  EXPECT_THROW(reader.execute("INSERT INTO t (v) VALUES (1)"), StorageError);
}

TEST_F(SqliteTest, AReaderDoesNotCreateAFile) {
  EXPECT_THROW(Database(folder_.path() / "other", Access::read_only), StorageError);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "other"));
}

TEST_F(SqliteTest, LoadsNoExtensions) {
  EXPECT_THROW(database_.execute("SELECT load_extension('x')"), StorageError);
}

TEST_F(SqliteTest, ForeignKeysHold) {
  database_.execute("CREATE TABLE child (t INTEGER REFERENCES t)");
  EXPECT_THROW(database_.execute("INSERT INTO child VALUES (99)"), StorageError);
}

}  // namespace
}  // namespace kidnapwatch::storage
