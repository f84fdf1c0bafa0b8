// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/run/state_file.h"

#include <chrono>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace lodestone::povray {
namespace {

/// The bytes read at once: three blocks of a picture.
/// Taste: a larger value looks at the clock less often.
constexpr size_t kPieceBytes = 65536;
/// The time that a call may take.
/// Taste: a larger value is slower to notice that the work is to stop.
constexpr std::chrono::milliseconds kMostTime{5};
/// The time that the rest of a file may take.
/// Taste: a larger value waits longer for a file that goes on growing, or paints all again and
/// again.
constexpr std::chrono::seconds kMostRestTime{1};

}  // namespace

StateFile::~StateFile() {
    if (file_ >= 0)
        close(file_);
}

bool StateFile::read_some() {
    if (broken())
        return false;
    if (file_ < 0) {
        // Not blocking: nothing waits for the writer of what is no file at all.
        file_ = open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
        if (file_ < 0)
            return false;
    }
    const auto start = std::chrono::steady_clock::now();
    std::vector<char> piece(kPieceBytes);
    while (std::chrono::steady_clock::now() - start < kMostTime) {
        if (reader_.behind()) {
            reader_.read({});
            continue;
        }
        const ssize_t got = pread(file_, piece.data(), piece.size(), at_);
        if (got <= 0)
            return false;
        at_ += got;
        reader_.read({piece.data(), static_cast<size_t>(got)});
    }
    return true;
}

void StateFile::read_rest() {
    const auto start = std::chrono::steady_clock::now();
    while (read_some() && std::chrono::steady_clock::now() - start < kMostRestTime) {
    }
}

}  // namespace lodestone::povray
