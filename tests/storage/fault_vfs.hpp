// SPDX-License-Identifier: Apache-2.0
// A disk that can be told to fail: a layer between SQLite and the real file system.
#pragma once

namespace kidnapwatch::storage {

/// While one lives, every file that SQLite opens in this process goes through it. One at a time.
class FaultyDisk {
 public:
  FaultyDisk();
  ~FaultyDisk();
  FaultyDisk(const FaultyDisk&) = delete;
  FaultyDisk& operator=(const FaultyDisk&) = delete;

  /// From now on, writing (or syncing) returns this SQLite result code; SQLITE_OK: works again.
  void let_writes_return(int code);
  void let_syncs_return(int code);
};

}  // namespace kidnapwatch::storage
