// SPDX-License-Identifier: Apache-2.0
// The faulty disk as an SQLite VFS that passes everything on to the default one.
#include "tests/storage/fault_vfs.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <sqlite3.h>

namespace kidnapwatch::storage {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSector = 512;

std::atomic<int> g_write_code = SQLITE_OK;
std::atomic<int> g_sync_code = SQLITE_OK;
std::atomic<bool> g_spares_syncs = false;
sqlite3_vfs* g_real = nullptr;

/// What was written to a file and not synced yet.
struct Change {
  std::size_t at = 0;
  std::string bytes;
  bool truncates = false;  // to the size `at`
};

struct Content {
  std::string synced;
  std::vector<Change> changes;
};

std::mutex g_mutex;
std::function<void()> g_look;
std::map<std::string, Content> g_contents;  // by path

void apply(std::string& image, const Change& change) {
  if (change.truncates) return image.resize(change.at);
  image.resize(std::max(image.size(), change.at + change.bytes.size()));
  image.replace(change.at, change.bytes.size(), change.bytes);
}

/// Each sector arrives, or does not.
void apply_by_chance(std::string& image, const Change& change, std::mt19937& chance) {
  if (change.truncates) {
    if (chance() % 2 == 0) apply(image, change);
    return;
  }
  for (std::size_t from = 0; from < change.bytes.size(); from += kSector) {
    if (chance() % 2 == 0) apply(image, {change.at + from, change.bytes.substr(from, kSector)});
  }
}

/// As SQLite allocates it: the real file follows right behind.
struct File {
  sqlite3_file base;
  Content* content;  // nullptr: a temporary file
  [[nodiscard]] sqlite3_file* real() {
    return static_cast<sqlite3_file*>(static_cast<void*>(this + 1));
  }
};

File& ours(sqlite3_file* file) { return *static_cast<File*>(static_cast<void*>(file)); }

sqlite3_file* real(sqlite3_file* file) { return ours(file).real(); }

void remember(sqlite3_file* file, Change change) {
  const std::lock_guard lock(g_mutex);
  if (!g_look || ours(file).content == nullptr) return;
  g_look();
  ours(file).content->changes.push_back(std::move(change));
}

void remember_sync(sqlite3_file* file) {
  const std::lock_guard lock(g_mutex);
  if (!g_look || ours(file).content == nullptr) return;
  g_look();
  auto& content = *ours(file).content;
  for (const auto& change : content.changes) apply(content.synced, change);
  content.changes.clear();
}

int write(sqlite3_file* file, const void* bytes, int size, sqlite3_int64 at) {
  if (const int code = g_write_code; code != SQLITE_OK) return code;
  remember(file,
           {.at = static_cast<std::size_t>(at),
            .bytes = std::string(static_cast<const char*>(bytes), static_cast<std::size_t>(size))});
  return real(file)->pMethods->xWrite(real(file), bytes, size, at);
}

int truncate(sqlite3_file* file, sqlite3_int64 size) {
  remember(file, {.at = static_cast<std::size_t>(size), .bytes = {}, .truncates = true});
  return real(file)->pMethods->xTruncate(real(file), size);
}

int sync(sqlite3_file* file, int flags) {
  if (const int code = g_sync_code; code != SQLITE_OK) return code;
  remember_sync(file);
  return g_spares_syncs ? SQLITE_OK : real(file)->pMethods->xSync(real(file), flags);
}

/// A function of the same name of the real file.
template <auto kMethod, typename... Args>
auto pass(sqlite3_file* file, Args... args) {
  return (real(file)->pMethods->*kMethod)(real(file), args...);
}

using Methods = sqlite3_io_methods;

constexpr Methods kMethods{
    .iVersion = 2,
    .xClose = pass<&Methods::xClose>,
    .xRead = pass<&Methods::xRead, void*, int, sqlite3_int64>,
    .xWrite = write,
    .xTruncate = truncate,
    .xSync = sync,
    .xFileSize = pass<&Methods::xFileSize, sqlite3_int64*>,
    .xLock = pass<&Methods::xLock, int>,
    .xUnlock = pass<&Methods::xUnlock, int>,
    .xCheckReservedLock = pass<&Methods::xCheckReservedLock, int*>,
    .xFileControl = pass<&Methods::xFileControl, int, void*>,
    .xSectorSize = pass<&Methods::xSectorSize>,
    .xDeviceCharacteristics = pass<&Methods::xDeviceCharacteristics>,
    .xShmMap = pass<&Methods::xShmMap, int, int, int, void volatile**>,
    .xShmLock = pass<&Methods::xShmLock, int, int, int>,
    .xShmBarrier = pass<&Methods::xShmBarrier>,
    .xShmUnmap = pass<&Methods::xShmUnmap, int>,
    .xFetch = nullptr,
    .xUnfetch = nullptr,
};

std::string bytes_of(const char* name) {
  std::ostringstream bytes;
  bytes << std::ifstream(name, std::ios::binary).rdbuf();
  return bytes.str();
}

Content* content_of(const char* name) {
  const std::lock_guard lock(g_mutex);
  if (name == nullptr || !g_look) return nullptr;
  const auto [found, is_new] = g_contents.try_emplace(name);
  if (is_new) found->second.synced = bytes_of(name);
  return &found->second;
}

int open(sqlite3_vfs* /*vfs*/, const char* name, sqlite3_file* file, int flags, int* out_flags) {
  file->pMethods = nullptr;
  ours(file).content = content_of(name);
  const int code = g_real->xOpen(g_real, name, real(file), flags, out_flags);
  if (real(file)->pMethods != nullptr) file->pMethods = &kMethods;
  return code;
}

/// Durable at once.
int remove(sqlite3_vfs* /*vfs*/, const char* name, int sync_folder) {
  {
    const std::lock_guard lock(g_mutex);
    if (const auto found = g_contents.find(name); found != g_contents.end()) found->second = {};
  }
  return g_real->xDelete(g_real, name, g_spares_syncs ? 0 : sync_folder);
}

sqlite3_vfs g_vfs;

}  // namespace

FaultyDisk::FaultyDisk() {
  assert(g_real == nullptr);
  g_real = sqlite3_vfs_find(nullptr);
  g_vfs = *g_real;
  g_vfs.pNext = nullptr;
  g_vfs.zName = "faulty-disk";
  g_vfs.szOsFile = static_cast<int>(sizeof(File)) + g_real->szOsFile;
  g_vfs.xOpen = open;
  g_vfs.xDelete = remove;
  sqlite3_vfs_register(&g_vfs, 1);
}

FaultyDisk::~FaultyDisk() {
  sqlite3_vfs_unregister(&g_vfs);
  sqlite3_vfs_register(g_real, 1);
  g_real = nullptr;
  g_look = nullptr;
  g_spares_syncs = false;
  g_contents.clear();
  let_writes_return(SQLITE_OK);
  let_syncs_return(SQLITE_OK);
}

void FaultyDisk::let_writes_return(int code) { g_write_code = code; }

void FaultyDisk::let_syncs_return(int code) { g_sync_code = code; }

void FaultyDisk::spare_syncs() { g_spares_syncs = true; }

void FaultyDisk::expect_power_cuts(std::function<void()> look) {
  const std::lock_guard lock(g_mutex);
  g_look = std::move(look);
}

void FaultyDisk::cut_power(const fs::path& folder, std::mt19937& chance) const {
  for (const auto& [path, content] : g_contents) {  // called by `look`: the mutex is held
    std::string image = content.synced;
    for (const auto& change : content.changes) apply_by_chance(image, change, chance);
    std::ofstream(folder / fs::path(path).filename(), std::ios::binary) << image;
  }
}

}  // namespace kidnapwatch::storage
