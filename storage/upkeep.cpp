// SPDX-License-Identifier: Apache-2.0
// Checks, quarantine and backup of the store's file.
#include "storage/upkeep.hpp"

#include <cerrno>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include "storage/schema.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {
namespace {

namespace fs = std::filesystem;

/// Interrupts what the connection is doing once `limit` is over. (SQLite 3.40 asks its progress
/// handler too rarely within a check.)
class TimeLimit {
 public:
  TimeLimit(Database& database, std::chrono::milliseconds limit)
      : thread_([this, &database, limit](const std::stop_token& done) {
          std::unique_lock lock(mutex_);
          over_.wait_for(lock, done, limit, [] { return false; });
          while (!done.stop_requested()) {  // one that comes before the statement is forgotten
            sqlite3_interrupt(database.handle());
            over_.wait_for(lock, done, std::chrono::milliseconds(1), [] { return false; });
          }
        }) {}

 private:
  std::mutex mutex_;
  std::condition_variable_any over_;
  std::jthread thread_;
};

fs::path with_suffix(fs::path file, const std::string& suffix) { return file += suffix; }

fs::path free_name(const fs::path& file) {
  for (int i = 1;; ++i) {
    auto name = with_suffix(file, ".damaged-" + std::to_string(i));
    if (!fs::exists(name)) return name;
  }
}

void rename_if_there(const fs::path& from, const fs::path& to) {
  if (fs::exists(from)) fs::rename(from, to);
}

/// VACUUM INTO leaves its file to the page cache.
void make_durable(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const bool done = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!done) throw fs::filesystem_error("fsync", file, {error, std::generic_category()});
}

fs::path folder_of(const fs::path& file) { return fs::absolute(file).parent_path(); }

}  // namespace

std::optional<std::string> damage(const fs::path& file, std::chrono::milliseconds limit) {
  Database database(file, Access::read_write);  // a leftover -wal must be read, too
  const TimeLimit time_limit(database, limit);
  try {
    Statement check(database, "PRAGMA quick_check(1)");
    if (!check.step() || check.text(0) == "ok") return std::nullopt;
    return check.text(0);
  } catch (const StorageError& error) {
    if (error.code() == SQLITE_INTERRUPT) return std::nullopt;
    if (error.is_damage()) return error.what();
    throw;
  }
}

fs::path quarantine(const fs::path& file) {
  auto aside = free_name(file);
  for (const char* suffix : {"-wal", "-shm", ""}) {
    rename_if_there(with_suffix(file, suffix), with_suffix(aside, suffix));
  }
  return aside;
}

std::optional<fs::path> prepare_store(const fs::path& file, std::chrono::milliseconds check_limit) {
  std::optional<fs::path> aside;
  fs::create_directories(folder_of(file));
  if (fs::exists(file) && damage(file, check_limit)) aside = quarantine(file);
  migrate(file);
  return aside;
}

std::uint64_t size_of(const fs::path& file) {
  std::uint64_t bytes = 0;
  for (const char* suffix : {"", "-wal"}) {
    std::error_code missing;
    const auto size = fs::file_size(with_suffix(file, suffix), missing);
    if (!missing) bytes += size;
  }
  return bytes;
}

void backup(const fs::path& file, const fs::path& target) {
  const auto unfinished = with_suffix(target, ".part");
  fs::remove(unfinished);
  {
    Database database(file, Access::read_only);
    Statement(database, "VACUUM INTO ?1").bind(unfinished.string()).run();
  }
  make_durable(unfinished);
  fs::rename(unfinished, target);
  make_durable(folder_of(target));
}

}  // namespace kidnapwatch::storage
