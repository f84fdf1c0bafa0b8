// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/findings_folder.h"

#include "base/error.h"
#include "base/files.h"

#include <algorithm>
#include <charconv>
#include <tuple>

namespace lodestone {
namespace {

namespace fs = std::filesystem;

/// Law: the digits of a hash.
constexpr size_t kDigits = 16;

Hash sum_of(std::string_view bytes) {
    return Hasher().text(bytes).result();
}

/// The hash that 16 digits are; none for anything else.
std::optional<Hash> hash_of_digits(std::string_view digits) {
    Hash out = 0;
    const char* end = digits.data() + digits.size();
    const auto [at, error] = std::from_chars(digits.data(), end, out, 16);
    if (error != std::errc() || at != end || hex16(out) != digits)
        return {};
    return out;
}

}  // namespace

FindingsFolder::FindingsFolder(fs::path folder, std::string_view ending)
    : folder_(std::move(folder)), ending_(ending) {}

FindingsFolder::~FindingsFolder() {
    if (!added_)
        return;
    std::vector<std::tuple<fs::file_time_type, fs::path, uint64_t>> files;
    uint64_t sum = 0;
    for (const NamedFile& named : named_files()) {
        std::error_code error;
        files.emplace_back(fs::last_write_time(named.path, error), named.path, named.file.bytes);
        sum += named.file.bytes;
    }
    std::sort(files.begin(), files.end());
    for (const auto& [time, path, bytes] : files) {
        if (sum <= kMostBytes)
            break;
        sum -= bytes;
        std::error_code error;
        fs::remove(path, error);
    }
}

fs::path FindingsFolder::path_of(Hash key, Hash sum) const {
    return folder_ / text(hex16(key), '-', hex16(sum), ending_);
}

/// The files that have a name of a finding; others are somebody else's.
std::vector<FindingsFolder::NamedFile> FindingsFolder::named_files() const {
    std::vector<NamedFile> out;
    std::error_code error;
    for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
        const std::string name = at->path().filename().string();
        if (name.size() != 2 * kDigits + 1 + ending_.size() || !name.ends_with(ending_) ||
            name[kDigits] != '-')
            continue;
        const std::string_view view(name);
        const std::optional<Hash> key = hash_of_digits(view.substr(0, kDigits));
        const std::optional<Hash> sum = hash_of_digits(view.substr(kDigits + 1, kDigits));
        std::error_code one;
        const uint64_t bytes = at->file_size(one);
        if (key && sum && !one)
            out.push_back({*key, {*sum, bytes}, at->path()});
    }
    return out;
}

void FindingsFolder::look() {
    if (looked_ || folder_.empty())
        return;
    looked_ = true;
    for (const NamedFile& named : named_files())
        known_[named.key] = named.file;
}

std::optional<std::string> FindingsFolder::find(Hash key) {
    FolderFile file;
    {
        const std::lock_guard lock(mutex_);
        look();
        const auto at = known_.find(key);
        if (at == known_.end() || at->second.bytes > kMostBytes)
            return {};
        file = at->second;
    }
    const fs::path path = path_of(key, file.sum);
    std::error_code error;
    try {
        std::string bytes = read_file(path, kMostBytes);
        if (sum_of(bytes) == file.sum) {
            fs::last_write_time(path, fs::file_time_type::clock::now(), error);  // it is of use
            return bytes;
        }
        fs::remove(path, error);
    } catch (const Error&) {
        // It was removed meanwhile.
    }
    const std::lock_guard lock(mutex_);
    known_.erase(key);
    return {};
}

void FindingsFolder::add(Hash key, std::string_view bytes) {
    if (folder_.empty() || bytes.size() > kMostBytes)
        return;
    std::error_code error;
    fs::create_directories(folder_, error);
    const Hash sum = sum_of(bytes);
    try {
        write_file(path_of(key, sum), bytes);
    } catch (const Error&) {
        return;  // the next picture makes it again
    }
    const std::lock_guard lock(mutex_);
    look();
    known_[key] = {sum, bytes.size()};
    added_ = true;
}

}  // namespace lodestone
