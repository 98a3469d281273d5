// SPDX-License-Identifier: Apache-2.0
// The store's file as a whole: is it intact, put it aside, copy it.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace kidnapwatch::storage {

/// What is wrong with the file, in SQLite's words; nothing if no damage was found. Looks for at
/// most `limit`: a large file is then checked in part. Throws StorageError if the file cannot be
/// opened.
[[nodiscard]] std::optional<std::string> damage(const std::filesystem::path& file,
                                                std::chrono::milliseconds limit);

/// Renames the file with its -wal and -shm to the first free `file`.damaged-N. Returns that name.
/// Throws std::filesystem::filesystem_error.
std::filesystem::path quarantine(const std::filesystem::path& file);

/// Makes a usable store of `file`: creates it with its folder, checks and migrates it. A damaged
/// one is put aside and a fresh one started; returns where it was put. Throws StorageError,
/// std::filesystem_error.
std::optional<std::filesystem::path> prepare_store(
    const std::filesystem::path& file,
    std::chrono::milliseconds check_limit = std::chrono::seconds(2));

/// Bytes on the disk: of the file, and of what is to be merged into it. 0 if it is not there.
[[nodiscard]] std::uint64_t size_of(const std::filesystem::path& file);

/// Writes a consistent copy, replacing `target` once the copy is complete and durable. The store
/// may be in use. Throws StorageError, std::filesystem::filesystem_error.
void backup(const std::filesystem::path& file, const std::filesystem::path& target);

}  // namespace kidnapwatch::storage
