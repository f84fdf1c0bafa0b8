// SPDX-License-Identifier: GPL-3.0-or-later
// Findings file: what took long to find, kept in one file from picture to picture.
#pragma once

#include "base/hash.h"

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

namespace lodestone {

/// A keeper of what was found, by the hash of all that it depends on. A file that is missing,
/// damaged or of another version is empty. Of several writers the last one's file stays. May be
/// used from any thread.
class FindingsFile {
public:
    /// Reads the file; an empty path keeps nothing. `version`: eight letters that begin the file.
    FindingsFile(std::filesystem::path file, std::string_view version);

    /// The bytes kept for a key.
    std::optional<std::string> find(Hash key);
    void add(Hash key, std::string bytes);
    /// Writes the file, if anything was added. Bytes that no picture of the last kMostAge with
    /// anything new asked for are left out, and the oldest where all take more than kMostBytes.
    /// A folder that cannot be written to is no problem.
    void save();

    /// Taste: a larger value keeps what a scene that goes to and fro needs again, on disk.
    static constexpr uint32_t kMostAge = 24;
    /// Taste: a larger value keeps the pictures of larger scenes, and takes longer to read.
    static constexpr uint64_t kMostBytes = uint64_t{64} << 20u;

private:
    struct KeptFinding {
        std::string bytes;
        uint32_t age = 0;  // in files written since it was asked for
        bool used = false;
    };

    std::filesystem::path file_;
    std::string version_;
    std::mutex mutex_;
    std::unordered_map<Hash, KeptFinding> kept_;
    bool changed_ = false;
};

}  // namespace lodestone
