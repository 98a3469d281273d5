// SPDX-License-Identifier: Apache-2.0
// The faulty disk as an SQLite VFS that passes everything on to the default one.
#include "tests/storage/fault_vfs.hpp"

#include <atomic>
#include <cassert>
#include <new>

#include <sqlite3.h>

namespace kidnapwatch::storage {
namespace {

std::atomic<int> g_write_code = SQLITE_OK;
std::atomic<int> g_sync_code = SQLITE_OK;
sqlite3_vfs* g_real = nullptr;

/// As SQLite allocates it: the real file follows right behind.
struct File {
  sqlite3_file base;
  [[nodiscard]] sqlite3_file* real() {
    return static_cast<sqlite3_file*>(static_cast<void*>(this + 1));
  }
};

sqlite3_file* real(sqlite3_file* file) {
  return static_cast<File*>(static_cast<void*>(file))->real();
}

int write(sqlite3_file* file, const void* bytes, int size, sqlite3_int64 at) {
  if (const int code = g_write_code; code != SQLITE_OK) return code;
  return real(file)->pMethods->xWrite(real(file), bytes, size, at);
}

int sync(sqlite3_file* file, int flags) {
  if (const int code = g_sync_code; code != SQLITE_OK) return code;
  return real(file)->pMethods->xSync(real(file), flags);
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
    .xTruncate = pass<&Methods::xTruncate, sqlite3_int64>,
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

int open(sqlite3_vfs* /*vfs*/, const char* name, sqlite3_file* file, int flags, int* out_flags) {
  file->pMethods = nullptr;
  const int code = g_real->xOpen(g_real, name, real(file), flags, out_flags);
  if (real(file)->pMethods != nullptr) file->pMethods = &kMethods;
  return code;
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
  sqlite3_vfs_register(&g_vfs, 1);
}

FaultyDisk::~FaultyDisk() {
  sqlite3_vfs_unregister(&g_vfs);
  sqlite3_vfs_register(g_real, 1);
  g_real = nullptr;
  let_writes_return(SQLITE_OK);
  let_syncs_return(SQLITE_OK);
}

void FaultyDisk::let_writes_return(int code) { g_write_code = code; }

void FaultyDisk::let_syncs_return(int code) { g_sync_code = code; }

}  // namespace kidnapwatch::storage
