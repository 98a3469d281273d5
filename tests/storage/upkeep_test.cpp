// SPDX-License-Identifier: Apache-2.0
// Damaged files, quarantine and backup.
#include "storage/upkeep.hpp"

#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "storage/archive.hpp"
#include "storage/schema.hpp"
#include "storage/sqlite.hpp"
#include "storage/writer.hpp"
#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {
namespace {

namespace fs = std::filesystem;

constexpr std::streamoff kPage = 4096;

class UpkeepTest : public testing::Test {
 protected:
  /// A store of many pages.
  void fill() const {
    Writer writer({.file = folder_.store()});
    for (int i = 0; i < 5000; ++i) writer.add_score("robot-1", score_at(i), at_s(i));
    writer.put_incident({.incident = incident_of(1)});
  }

  void overwrite(std::streamoff at, const std::string& bytes) const {
    std::fstream file(folder_.store(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(at);
    file << bytes;
    ASSERT_TRUE(file.good());
  }

  StoreFolder folder_;
};

TEST_F(UpkeepTest, AnIntactStoreIsKept) {
  fill();
  EXPECT_EQ(damage(folder_.store(), std::chrono::minutes(1)), std::nullopt);
  EXPECT_EQ(prepare_store(folder_.store()), std::nullopt);
  EXPECT_TRUE(Archive(folder_.store()).incident(incident_id(1)));
}

TEST_F(UpkeepTest, ItsFolderIsMade) {
  const auto file = folder_.path() / "var" / "lib" / "store.sqlite";
  EXPECT_EQ(prepare_store(file), std::nullopt);
  EXPECT_TRUE(Archive(file).incidents({}).empty());
}

TEST_F(UpkeepTest, AFolderThatCannotBeIsNamed) {
  std::ofstream(folder_.path() / "var") << "a file";
  try {
    prepare_store(folder_.path() / "var" / "store.sqlite");
    FAIL() << "made a store below a file";
  } catch (const fs::filesystem_error& error) {
    EXPECT_EQ(error.path1(), folder_.path() / "var");
  }
}

TEST_F(UpkeepTest, ADamagedPageIsFoundAndTheFilePutAside) {
  fill();
  const auto size = fs::file_size(folder_.store());
  overwrite(40 * kPage, std::string(4096, 'x'));
  const Writer writer({.file = folder_.store()});
  ASSERT_TRUE(writer.quarantined());
  EXPECT_EQ(*writer.quarantined(), folder_.store().string() + ".damaged-1");
  EXPECT_EQ(fs::file_size(*writer.quarantined()), size);
  EXPECT_TRUE(Archive(folder_.store()).incidents({}).empty());
}

TEST_F(UpkeepTest, AnyGarbageForAFileEndsInAUsableStore) {
  std::mt19937 random(7);
  for (int round = 1; round <= 20; ++round) {
    std::string garbage(std::uniform_int_distribution<std::size_t>(1, 20'000)(random), '\0');
    for (char& c : garbage) c = static_cast<char>(random());
    std::ofstream(folder_.store(), std::ios::binary) << garbage;
    ASSERT_TRUE(prepare_store(folder_.store())) << round;
    EXPECT_TRUE(Archive(folder_.store()).incidents({}).empty());
    EXPECT_TRUE(fs::exists(folder_.store().string() + ".damaged-" + std::to_string(round)));
    fs::remove(folder_.store().string());
    fs::remove(folder_.store().string() + "-wal");
    fs::remove(folder_.store().string() + "-shm");
  }
}

TEST_F(UpkeepTest, ARandomFlippedPageNeverKeepsTheStoreFromOpening) {
  std::mt19937 random(11);
  int put_aside = 0;
  for (int round = 0; round < 10; ++round) {
    fs::remove(folder_.store());
    fill();
    const auto pages = static_cast<int>(fs::file_size(folder_.store()) / 4096);
    const auto page = std::uniform_int_distribution(0, pages - 1)(random);
    std::string noise(4096, '\0');
    for (char& c : noise) c = static_cast<char>(random());
    overwrite(page * kPage, noise);
    Writer writer({.file = folder_.store()});
    put_aside += writer.quarantined() ? 1 : 0;
    writer.put_incident({.incident = incident_of(2)});
    EXPECT_NO_THROW(writer.flush().get()) << "page " << page << " of " << pages;
  }
  EXPECT_GE(put_aside, 7);  // a free page may hold anything
}

TEST_F(UpkeepTest, AnEmptyFileIsAFreshStore) {
  std::ofstream(folder_.store()).flush();
  EXPECT_EQ(prepare_store(folder_.store()), std::nullopt);
  EXPECT_TRUE(Archive(folder_.store()).incidents({}).empty());
}

TEST_F(UpkeepTest, ACheckOfALargeFileEndsInTime) {
  migrate(folder_.store());
  Database(folder_.store(), Access::read_write)
      .execute(
          "WITH RECURSIVE n(i) AS (VALUES (1) UNION ALL SELECT i + 1 FROM n LIMIT 300000) "
          "INSERT INTO score_even SELECT i, 1, i, i, i, 0.5, 0.5, 0, 0.5, 1, x'', x'00' FROM n");
  overwrite(40 * kPage, std::string(4096, 'x'));  // among the oldest rows, which are checked last
  EXPECT_TRUE(damage(folder_.store(), std::chrono::hours(1)));
  EXPECT_EQ(damage(folder_.store(), std::chrono::milliseconds(1)), std::nullopt);
}

TEST_F(UpkeepTest, ABackupOfAStoreInUseIsWhole) {
  Writer writer({.file = folder_.store()});
  writer.put_incident({.incident = incident_of(1)});
  writer.flush().get();
  const auto target = folder_.path() / "copy.sqlite";
  backup(folder_.store(), target);
  writer.put_incident({.incident = incident_of(2)});
  writer.flush().get();
  EXPECT_EQ(Archive(target).incidents({}).size(), 1U);
  backup(folder_.store(), target);  // replaces
  EXPECT_EQ(Archive(target).incidents({}).size(), 2U);
  EXPECT_EQ(damage(target, std::chrono::minutes(1)), std::nullopt);
}

TEST(SizeOf, CountsWhatIsNotMergedYet) {
  const StoreFolder folder;
  EXPECT_EQ(size_of(folder.store()), 0U);
  prepare_store(folder.store());
  const auto fresh = size_of(folder.store());
  EXPECT_EQ(fresh, std::filesystem::file_size(folder.store()));
  Database database(folder.store(), Access::read_write);
  database.execute("CREATE TABLE more (data BLOB); INSERT INTO more VALUES (zeroblob(100000))");
  EXPECT_GT(size_of(folder.store()), fresh + 100'000);
}

}  // namespace
}  // namespace kidnapwatch::storage
