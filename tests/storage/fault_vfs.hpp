// SPDX-License-Identifier: Apache-2.0
// A disk that can be told to fail: a layer between SQLite and the real file system.
#pragma once

#include <filesystem>
#include <functional>
#include <random>

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

  /// From now on, nothing really waits for the disk.
  void spare_syncs();

  /// From now on, remembers of every file that is opened what it would hold after a power cut, and
  /// calls `look` before every write and sync. Nothing: no longer.
  void expect_power_cuts(std::function<void()> look);
  /// What a power cut at this moment leaves of the files, written to `folder`: all that was synced,
  /// and of what came after it, sector by sector, whatever chance wants.
  void cut_power(const std::filesystem::path& folder, std::mt19937& chance) const;
};

}  // namespace kidnapwatch::storage
