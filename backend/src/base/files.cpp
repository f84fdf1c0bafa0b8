// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/files.h"

#include "base/error.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

namespace lodestone {
namespace {

/// The time between two looks at a lock.
/// Taste: a larger value wakes less often and notices a free lock later.
constexpr std::chrono::milliseconds kLockPoll{20};

std::string reason(int number) {
    char buffer[256];
    return strerror_r(number, buffer, sizeof buffer);
}

}  // namespace

FileState file_state(const std::filesystem::path& path) {
    constexpr int64_t kNanoseconds = 1'000'000'000;  // Law: of a second
    struct stat info {};
    if (stat(path.c_str(), &info) != 0)
        return {};
    return {static_cast<uint64_t>(info.st_size), static_cast<uint64_t>(info.st_ino),
            static_cast<int64_t>(info.st_mtim.tv_sec) * kNanoseconds + info.st_mtim.tv_nsec};
}

std::string read_file(const std::filesystem::path& path, uint64_t limit) {
    // The flag is for a pipe that nobody writes to, which would hold us here; for files it means
    // nothing.
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0)
        fail(Status::Io, "cannot read '", path.string(), "': ", reason(errno));
    struct stat info {};
    if (fstat(file, &info) != 0 || !S_ISREG(info.st_mode)) {
        close(file);
        fail(Status::Io, "cannot read '", path.string(), "': not a regular file");
    }
    if (static_cast<uint64_t>(info.st_size) > limit) {
        close(file);
        fail(Status::Io, "cannot read '", path.string(), "': ", info.st_size,
             " bytes is more than the limit of ", limit);
    }
    std::string bytes(static_cast<size_t>(info.st_size), '\0');
    size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t got = read(file, bytes.data() + done, bytes.size() - done);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0) {
            const int number = errno;
            close(file);
            fail(Status::Io, "cannot read '", path.string(), "': ", reason(number));
        }
        if (got == 0)
            break;
        done += static_cast<size_t>(got);
    }
    bytes.resize(done);
    close(file);
    return bytes;
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
    // The temporary name is short whatever the path's own name is, which may be as long as a file
    // system allows.
    static std::atomic<uint32_t> counter{0};
    std::filesystem::path temporary;
    int file = -1;
    do {  // a killed process of our number may have left one
        temporary = path;
        temporary.replace_filename(text(".lodestone-", getpid(), "-", counter++, ".tmp"));
        file = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (file < 0 && errno == EEXIST);
    if (file < 0)
        fail(Status::Io, "cannot write '", path.string(), "': ", reason(errno));
    int number = 0;
    while (!bytes.empty() && number == 0) {
        const ssize_t put = write(file, bytes.data(), bytes.size());
        if (put >= 0)
            bytes.remove_prefix(static_cast<size_t>(put));
        else if (errno != EINTR)
            number = errno;
    }
    if (close(file) != 0 && number == 0)
        number = errno;
    if (number == 0 && rename(temporary.c_str(), path.c_str()) != 0)
        number = errno;
    if (number != 0) {
        unlink(temporary.c_str());
        fail(Status::Io, "cannot write '", path.string(), "': ", reason(number));
    }
}

void make_folder(const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error)
        fail(Status::Io, "cannot make the folder '", path.string(), "': ", error.message());
}

bool safe_relative_name(std::string_view name) {
    if (name.empty() || name.front() == '/' || name.size() > 240)
        return false;
    size_t begin = 0;
    while (begin <= name.size()) {
        const size_t end = std::min(name.find('/', begin), name.size());
        const std::string_view part = name.substr(begin, end - begin);
        if (part.empty() || part == "." || part == "..")
            return false;
        begin = end + 1;
    }
    return name.find_first_not_of(
               "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
               "0123456789_./-") == std::string_view::npos;
}

FileLock::FileLock(const std::filesystem::path& path, const Job& job) {
    file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0)
        fail(Status::Io, "cannot lock '", path.string(), "': ", reason(errno));
    while (flock(file_, LOCK_EX | LOCK_NB) != 0) {
        const int number = errno;
        if ((number == EWOULDBLOCK || number == EINTR) && !job.cancelled()) {
            std::this_thread::sleep_for(kLockPoll);
            continue;
        }
        close(file_);
        job.check();
        fail(Status::Io, "cannot lock '", path.string(), "': ", reason(number));
    }
}

FileLock::~FileLock() {
    flock(file_, LOCK_UN);
    close(file_);
}

}  // namespace lodestone
