// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/findings_file.h"

#include "base/error.h"
#include "base/files.h"

#include <algorithm>
#include <cstring>
#include <tuple>
#include <vector>

namespace lodestone {
namespace {

struct FindingHead {
    Hash key = 0;
    uint32_t age = 0;
    uint32_t size = 0;
};

Hash hash_of_text(std::string_view text) {
    return Hasher().text(text).result();
}

}  // namespace

FindingsFile::FindingsFile(std::filesystem::path file, std::string_view version)
    : file_(std::move(file)), version_(version) {
    std::error_code error;
    if (file_.empty() || !std::filesystem::is_regular_file(file_, error))
        return;
    std::string text;
    try {
        text = read_file(file_, 2 * kMostBytes);
    } catch (const Error&) {
        return;
    }
    Hash sum = 0;
    if (text.size() < version_.size() + sizeof sum || !text.starts_with(version_))
        return;
    std::string_view rest(text);
    std::memcpy(&sum, text.data() + text.size() - sizeof sum, sizeof sum);
    rest.remove_suffix(sizeof sum);
    if (hash_of_text(rest) != sum)
        return;
    rest.remove_prefix(version_.size());
    while (rest.size() >= sizeof(FindingHead)) {
        FindingHead head;
        std::memcpy(&head, rest.data(), sizeof head);
        rest.remove_prefix(sizeof head);
        if (head.size > rest.size())
            return;
        kept_[head.key] = {std::string(rest.substr(0, head.size)), head.age, false};
        rest.remove_prefix(head.size);
    }
}

std::optional<std::string> FindingsFile::find(Hash key) {
    const std::lock_guard lock(mutex_);
    const auto at = kept_.find(key);
    if (at == kept_.end())
        return {};
    at->second.used = true;
    return at->second.bytes;
}

void FindingsFile::add(Hash key, std::string bytes) {
    const std::lock_guard lock(mutex_);
    kept_[key] = {std::move(bytes), 0, true};
    changed_ = true;
}

void FindingsFile::save() {
    const std::lock_guard lock(mutex_);
    if (file_.empty() || !changed_)
        return;
    std::vector<std::tuple<uint32_t, Hash, const KeptFinding*>> order;  // the youngest first
    for (const auto& [key, finding] : kept_) {
        const uint32_t age = finding.used ? 0 : finding.age + 1;
        if (age <= kMostAge)
            order.emplace_back(age, key, &finding);
    }
    std::sort(order.begin(), order.end());
    std::string text(version_);
    for (const auto& [age, key, finding] : order) {
        if (text.size() + sizeof(FindingHead) + finding->bytes.size() > kMostBytes)
            break;
        const FindingHead head{key, age, static_cast<uint32_t>(finding->bytes.size())};
        text.append(reinterpret_cast<const char*>(&head), sizeof head);
        text += finding->bytes;
    }
    const Hash sum = hash_of_text(text);
    text.append(reinterpret_cast<const char*>(&sum), sizeof sum);
    std::error_code error;
    std::filesystem::create_directories(file_.parent_path(), error);
    try {
        write_file(file_, text);
    } catch (const Error&) {
        return;  // the next picture finds it again
    }
    changed_ = false;
}

}  // namespace lodestone
