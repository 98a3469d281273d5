// SPDX-License-Identifier: Apache-2.0
// The lock, by flock(2).
#include "storage/file_lock.hpp"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <unistd.h>

#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

FileLock::FileLock(const std::filesystem::path& file) {
  std::filesystem::create_directories(std::filesystem::absolute(file).parent_path());
  descriptor_ = ::open((file.string() + ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const int error = errno;
  if (descriptor_ >= 0) ::close(descriptor_);
  throw StorageError(error == EWOULDBLOCK ? SQLITE_BUSY : SQLITE_CANTOPEN,
                     "store " + file.string() + ": " +
                         (error == EWOULDBLOCK ? "in use by another kidnapwatch"
                                               : std::generic_category().message(error)));
}

FileLock::~FileLock() { ::close(descriptor_); }

}  // namespace kidnapwatch::storage
