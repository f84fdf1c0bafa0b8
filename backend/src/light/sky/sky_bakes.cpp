// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/sky/sky_bakes.h"

#include "base/error.h"
#include "base/files.h"

#include <algorithm>
#include <cstring>
#include <tuple>
#include <vector>

namespace lodestone::light {
namespace {

/// The beginning of the file.
/// Law: another one is another version.
constexpr std::string_view kMagic = "LDSSKY01";

struct BakeHead {
    Hash key = 0;
    uint32_t age = 0;
    uint32_t size = 0;
};

Hash hash_of_text(std::string_view text) {
    return Hasher().text(text).result();
}

}  // namespace

SkyBakes::SkyBakes(std::filesystem::path file) : file_(std::move(file)) {
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
    if (text.size() < kMagic.size() + sizeof sum || !text.starts_with(kMagic))
        return;
    std::string_view rest(text);
    std::memcpy(&sum, text.data() + text.size() - sizeof sum, sizeof sum);
    rest.remove_suffix(sizeof sum);
    if (hash_of_text(rest) != sum)
        return;
    rest.remove_prefix(kMagic.size());
    while (rest.size() >= sizeof(BakeHead)) {
        BakeHead head;
        std::memcpy(&head, rest.data(), sizeof head);
        rest.remove_prefix(sizeof head);
        if (head.size > rest.size())
            return;
        kept_[head.key] = {std::string(rest.substr(0, head.size)), head.age, false};
        rest.remove_prefix(head.size);
    }
}

std::optional<std::string_view> SkyBakes::find(Hash key) {
    const auto at = kept_.find(key);
    if (at == kept_.end())
        return {};
    at->second.used = true;
    return at->second.bytes;
}

void SkyBakes::add(Hash key, std::string bytes) {
    kept_[key] = {std::move(bytes), 0, true};
    changed_ = true;
}

void SkyBakes::save() const {
    if (file_.empty() || !changed_)
        return;
    std::vector<std::tuple<uint32_t, Hash, const KeptBake*>> order;  // the youngest first
    for (const auto& [key, bake] : kept_) {
        const uint32_t age = bake.used ? 0 : bake.age + 1;
        if (age <= kMostAge)
            order.emplace_back(age, key, &bake);
    }
    std::sort(order.begin(), order.end());
    std::string text(kMagic);
    for (const auto& [age, key, bake] : order) {
        if (text.size() + sizeof(BakeHead) + bake->bytes.size() > kMostBytes)
            break;
        const BakeHead head{key, age, static_cast<uint32_t>(bake->bytes.size())};
        text.append(reinterpret_cast<const char*>(&head), sizeof head);
        text += bake->bytes;
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
}

}  // namespace lodestone::light
