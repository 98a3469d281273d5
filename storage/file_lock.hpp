// SPDX-License-Identifier: Apache-2.0
// Keeps a second service from writing to the same store.
#pragma once

#include <filesystem>

namespace kidnapwatch::storage {

/// Holds `file`.lock until destroyed, or until the process ends in whatever way. (A file of its
/// own: closing the store's would let go of SQLite's locks on it.)
class FileLock {
 public:
  /// Throws StorageError if somebody else holds it.
  explicit FileLock(const std::filesystem::path& file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace kidnapwatch::storage
