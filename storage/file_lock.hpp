// SPDX-License-Identifier: Apache-2.0
// Keeps a second service from writing to the same store.
#pragma once

#include <filesystem>

namespace kidnapwatch::storage {

/// Holds `file`.lock until destroyed, or until the process ends in whatever way. (A file of its
/// own: closing the store's would let go of SQLite's locks on it.)
class FileLock {
 public:
  /// Creates the folder. Throws StorageError if somebody else holds the lock,
  /// std::filesystem::filesystem_error.
  explicit FileLock(const std::filesystem::path& file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace kidnapwatch::storage
