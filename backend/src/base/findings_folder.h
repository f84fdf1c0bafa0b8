// SPDX-License-Identifier: GPL-3.0-or-later
// Findings folder: large things that took long to make, each a file, kept from picture to picture.
#pragma once

#include "base/hash.h"

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace lodestone {

/// A keeper of whole files, by the hash of all that they depend on: KEY-SUM.ending, so that a file
/// that is damaged is not found. May be used from any thread, and by several processes.
class FindingsFolder {
public:
    /// Looks at the folder when asked for the first time; an empty path keeps nothing. `ending`:
    /// of the files, with its dot.
    FindingsFolder(std::filesystem::path folder, std::string_view ending);
    /// Removes the files that nobody asked for longest, where all take more than kMostBytes: of
    /// those that have such a name.
    ~FindingsFolder();
    FindingsFolder(const FindingsFolder&) = delete;
    FindingsFolder& operator=(const FindingsFolder&) = delete;

    /// The bytes kept for a key.
    std::optional<std::string> find(Hash key);
    /// A folder that cannot be written to is no problem.
    void add(Hash key, std::string_view bytes);

    /// Taste: a larger value keeps the pictures of larger scenes and of more cameras, on disk.
    static constexpr uint64_t kMostBytes = uint64_t{256} << 20u;

private:
    struct FolderFile {
        Hash sum = 0;
        uint64_t bytes = 0;
    };

    struct NamedFile {
        Hash key = 0;
        FolderFile file;
        std::filesystem::path path;
    };

    std::vector<NamedFile> named_files() const;
    void look();
    std::filesystem::path path_of(Hash key, Hash sum) const;

    std::filesystem::path folder_;
    std::string ending_;
    std::mutex mutex_;
    bool looked_ = false;
    bool added_ = false;
    std::unordered_map<Hash, FolderFile> known_;
};

}  // namespace lodestone
