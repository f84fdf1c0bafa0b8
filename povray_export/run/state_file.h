// SPDX-License-Identifier: GPL-3.0-or-later
// StateFile: follows the file in which POV-Ray keeps what it has drawn, while POV-Ray writes it.
#pragma once

#include "povray_export/run/state_reader.h"

#include <cstdint>
#include <filesystem>
#include <utility>

namespace lodestone::povray {

/// A file that grows, and may not be there yet or any more. It is read to where it ends now.
class StateFile {
public:
    StateFile(std::filesystem::path path, LivePicture& picture)
        : path_(std::move(path)), reader_(picture) {}
    ~StateFile();
    StateFile(const StateFile&) = delete;
    StateFile& operator=(const StateFile&) = delete;

    /// Draws what was written since the last call. What takes longer than a few milliseconds is left
    /// for the next one; then it returns true.
    bool read_some();
    /// Draws what is left once nobody writes any more.
    void read_rest();
    /// True once the file turned out to be something else.
    bool broken() const { return reader_.broken(); }

private:
    std::filesystem::path path_;
    StateReader reader_;
    int file_ = -1;
    int64_t at_ = 0;  // bytes read
};

}  // namespace lodestone::povray
