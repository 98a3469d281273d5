// SPDX-License-Identifier: Apache-2.0
// SQLite's C functions, wrapped: result codes become exceptions, handles get owners.
#include "storage/sqlite.hpp"

#include <cassert>
#include <limits>

#include <sqlite3.h>

namespace kidnapwatch::storage {
namespace {

constexpr int kBusyTimeoutMs = 5000;

[[noreturn]] void fail(sqlite3* database, int code) {
  const int extended = database != nullptr ? sqlite3_extended_errcode(database) : code;
  const char* message = database != nullptr ? sqlite3_errmsg(database) : sqlite3_errstr(code);
  throw StorageError(extended, std::string("store: ") + message);
}

void check(sqlite3* database, int code) {
  if (code != SQLITE_OK) fail(database, code);
}

int flags(Access access) {
  return access == Access::read_only ? SQLITE_OPEN_READONLY
                                     : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
}

/// The file may have been written by others: nothing in its schema may run code.
void harden(sqlite3* database) {
  sqlite3_extended_result_codes(database, 1);
  sqlite3_busy_timeout(database, kBusyTimeoutMs);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_DQS_DML, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_DQS_DDL, 0, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_FKEY, 1, nullptr);
}

}  // namespace

StorageError StorageError::damage(const std::string& what) {
  return {SQLITE_CORRUPT, "store: " + what};
}

bool StorageError::is_constraint() const noexcept { return (code_ & 0xff) == SQLITE_CONSTRAINT; }

bool StorageError::is_full() const noexcept { return (code_ & 0xff) == SQLITE_FULL; }

bool StorageError::is_damage() const noexcept {
  return (code_ & 0xff) == SQLITE_CORRUPT || (code_ & 0xff) == SQLITE_NOTADB;
}

Database::Database(const std::filesystem::path& file, Access access) {
  sqlite3* handle = nullptr;
  const int code =
      sqlite3_open_v2(file.c_str(), &handle, flags(access) | SQLITE_OPEN_NOMUTEX, nullptr);
  handle_.reset(handle);  // even a failed open gives a handle to close
  if (code != SQLITE_OK) {
    throw StorageError(code, "store " + file.string() + ": " + sqlite3_errstr(code));
  }
  harden(handle);
}

void Database::Close::operator()(sqlite3* handle) const noexcept { sqlite3_close(handle); }

void Database::execute(const std::string& sql) {
  check(handle(), sqlite3_exec(handle(), sql.c_str(), nullptr, nullptr, nullptr));
}

std::int64_t Database::integer(const std::string& sql) {
  Statement query(*this, sql);
  const bool found = query.step();
  assert(found);
  return found ? query.integer(0) : 0;
}

std::int64_t Database::last_row_id() const { return sqlite3_last_insert_rowid(handle()); }

std::int64_t Database::changes() const { return sqlite3_changes64(handle()); }

Statement::Statement(Database& database, std::string_view sql) : database_(database.handle()) {
  sqlite3_stmt* handle = nullptr;
  check(database_, sqlite3_prepare_v3(database_, sql.data(), static_cast<int>(sql.size()), 0,
                                      &handle, nullptr));
  handle_.reset(handle);
}

void Statement::Finalize::operator()(sqlite3_stmt* handle) const noexcept {
  sqlite3_finalize(handle);
}

bool Statement::step() {
  const int code = sqlite3_step(handle_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  const int extended = sqlite3_extended_errcode(database_);
  const std::string message = sqlite3_errmsg(database_);
  sqlite3_reset(handle_.get());
  throw StorageError(extended, "store: " + message);
}

void Statement::run() {
  while (step()) {
  }
  reset();  // an unfinished statement would hold its transaction open
}

void Statement::reset() { sqlite3_reset(handle_.get()); }

void Statement::bind_at(int index, std::nullopt_t /*null*/) {
  check(database_, sqlite3_bind_null(handle_.get(), index));
}

void Statement::bind_integer(int index, std::int64_t value) {
  check(database_, sqlite3_bind_int64(handle_.get(), index, value));
}

void Statement::bind_at(int index, core::Stamp value) {
  bind_integer(index, core::ns_since_epoch(value));
}

void Statement::bind_at(int index, double value) {
  check(database_, sqlite3_bind_double(handle_.get(), index, value));
}

void Statement::bind_at(int index, std::string_view value) {
  const char* first = value.empty() ? "" : value.data();  // a null pointer would bind NULL
  check(database_, sqlite3_bind_text64(handle_.get(), index, first, value.size(), SQLITE_TRANSIENT,
                                       SQLITE_UTF8));
}

void Statement::bind_at(int index, std::span<const std::byte> value) {
  const void* first = value.empty() ? static_cast<const void*>("") : value.data();
  check(database_,
        sqlite3_bind_blob64(handle_.get(), index, first, value.size(), SQLITE_TRANSIENT));
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(handle_.get(), column) == SQLITE_NULL;
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(handle_.get(), column);
}

core::Stamp Statement::stamp(int column) const { return core::stamp_from_ns(integer(column)); }

double Statement::real(int column) const {
  return is_null(column) ? std::numeric_limits<double>::quiet_NaN()
                         : sqlite3_column_double(handle_.get(), column);
}

std::string Statement::text(int column) const {
  const auto* first = static_cast<const char*>(
      static_cast<const void*>(sqlite3_column_text(handle_.get(), column)));
  const int size = sqlite3_column_bytes(handle_.get(), column);
  return first == nullptr ? std::string() : std::string(first, static_cast<std::size_t>(size));
}

std::span<const std::byte> Statement::blob(int column) const {
  const void* first = sqlite3_column_blob(handle_.get(), column);
  const int size = sqlite3_column_bytes(handle_.get(), column);
  return {static_cast<const std::byte*>(first), static_cast<std::size_t>(size)};
}

Transaction::Transaction(Database& database, Kind kind) : database_(database) {
  database_.execute(kind == Kind::write ? "BEGIN IMMEDIATE" : "BEGIN");
}

Transaction::~Transaction() {
  // Some failures (disk full, I/O) have rolled it back already.
  if (sqlite3_get_autocommit(database_.handle()) == 0) {
    sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
  }
}

void Transaction::commit() { database_.execute("COMMIT"); }

}  // namespace kidnapwatch::storage
