// SPDX-License-Identifier: GPL-3.0-or-later
// Files: whole reads with a size limit, writes that are never torn, one writer at a time.
#pragma once

#include "base/job.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace lodestone {

/// Reads the whole file. Throws Error(Io) with the reason, or when it is larger than `limit` bytes.
std::string read_file(const std::filesystem::path& path, uint64_t limit = uint64_t{4} << 30u);

/// The state of a file, which tells whether it has changed: one that is replaced is another file.
struct FileState {
    uint64_t bytes = 0;
    uint64_t number = 0;     // of the file on its device
    int64_t changed_ns = 0;  // when its content changed last
    bool operator==(const FileState&) const = default;
};
/// All zero when there is no such file.
FileState file_state(const std::filesystem::path& path);

/// Writes to a temporary name beside `path`, then renames: a killed run leaves the old file or the
/// new one. Throws Error(Io), and leaves nothing behind.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Makes a folder, and those it lies in, where there is none. Throws Error(Io).
void make_folder(const std::filesystem::path& path);

/// True when `name` is a plain relative ASCII path of [A-Za-z0-9_./-] that stays below its folder.
bool safe_relative_name(std::string_view name);

/// A lock on a file, exclusive and advisory, for one writer; released when destroyed or killed.
class FileLock {
public:
    /// Waits while somebody else holds the lock. Throws Error(Io) naming the file when it cannot be
    /// made, and Error(Cancelled) when `job` is cancelled.
    explicit FileLock(const std::filesystem::path& path, const Job& job = {});
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

private:
    int file_ = -1;
};

}  // namespace lodestone
