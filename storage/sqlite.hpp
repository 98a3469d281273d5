// SPDX-License-Identifier: Apache-2.0
// SQLite with owners: a connection, a statement, a transaction; every failure is an exception.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/stamp.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace kidnapwatch::storage {

/// The store could not do what it was asked to.
class StorageError : public std::runtime_error {
 public:
  StorageError(int code, const std::string& what) : std::runtime_error(what), code_(code) {}

  /// Content that no version of this program wrote.
  [[nodiscard]] static StorageError damage(const std::string& what);

  /// SQLite's extended result code.
  [[nodiscard]] int code() const noexcept { return code_; }
  /// A row that the schema forbids: it will not become better by trying again.
  [[nodiscard]] bool is_constraint() const noexcept;
  /// The disk, or the file within its limit, has no room left.
  [[nodiscard]] bool is_full() const noexcept;
  /// The file is no intact database.
  [[nodiscard]] bool is_damage() const noexcept;

 private:
  int code_;
};

enum class Access { read_only, read_write };

/// A connection, for one thread at a time. Foreign keys on, trusted schema and extensions off;
/// waits 5 s for locks. Writing creates a missing file.
class Database {
 public:
  /// Throws StorageError.
  Database(const std::filesystem::path& file, Access access);

  /// Any number of statements, results ignored. Throws StorageError.
  void execute(const std::string& sql);
  /// The first column of the first row. Throws StorageError; there is such a row.
  [[nodiscard]] std::int64_t integer(const std::string& sql);
  /// Of the latest inserted row.
  [[nodiscard]] std::int64_t last_row_id() const;
  /// Rows that the latest statement inserted, changed or deleted.
  [[nodiscard]] std::int64_t changes() const;
  [[nodiscard]] sqlite3* handle() const { return handle_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* handle) const noexcept;
  };
  std::unique_ptr<sqlite3, Close> handle_;
};

/// One prepared statement of a connection that outlives it.
class Statement {
 public:
  /// Throws StorageError.
  Statement(Database& database, std::string_view sql);

  /// Starts over with these values for ?1, ?2, ...: integers, doubles (NaN is NULL), text, blobs,
  /// stamps (nanoseconds since 1970) or optionals of them, nullopt being NULL.
  template <typename... Values>
  Statement& bind(const Values&... values) {
    reset();
    int index = 0;
    (bind_at(++index, values), ...);
    return *this;
  }

  /// True: there is a row to look at; false: done. Throws StorageError.
  bool step();
  /// Steps to the end. Throws StorageError.
  void run();

  // Of the current row, columns from 0. Text and blobs live until the next step.
  [[nodiscard]] bool is_null(int column) const;
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double real(int column) const;  ///< NaN for NULL
  [[nodiscard]] core::Stamp stamp(int column) const;
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] std::span<const std::byte> blob(int column) const;

 private:
  void reset();
  void bind_at(int index, std::nullopt_t null);
  void bind_at(int index, double value);
  void bind_at(int index, std::string_view value);
  void bind_at(int index, std::span<const std::byte> value);
  void bind_at(int index, core::Stamp value);
  void bind_integer(int index, std::int64_t value);
  template <std::integral Integer>
  void bind_at(int index, Integer value) {
    bind_integer(index, static_cast<std::int64_t>(value));
  }
  template <typename Value>
  void bind_at(int index, const std::optional<Value>& value) {
    value ? bind_at(index, *value) : bind_at(index, std::nullopt);
  }

  struct Finalize {
    void operator()(sqlite3_stmt* handle) const noexcept;
  };
  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
};

/// Undone unless committed.
class Transaction {
 public:
  enum class Kind {
    read,   ///< one consistent look at all tables
    write,  ///< takes the write lock at once
  };
  /// Throws StorageError.
  Transaction(Database& database, Kind kind);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  /// Throws StorageError; then nothing was written.
  void commit();

 private:
  Database& database_;
};

}  // namespace kidnapwatch::storage
