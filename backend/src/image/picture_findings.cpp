// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/picture_findings.h"

#include "base/findings_file.h"
#include "base/findings_folder.h"
#include "image/image.h"

#include <cmath>
#include <cstring>
#include <memory>
#include <mutex>
#include <type_traits>
#include <unordered_map>

namespace lodestone::image {
namespace {

/// The beginning of the file that keeps facts: raised whenever means are found in another way.
/// Law: another one is another version.
constexpr std::string_view kFactsVersion = "LDSPIC01";
/// The version of computed pictures: raised whenever operations or their PNG change.
/// Law: part of every key.
constexpr uint32_t kBakesVersion = 2;

static_assert(std::is_trivially_copyable_v<PictureFacts> && sizeof(PictureFacts) == 40);

std::optional<PictureFacts> facts_of_bytes(std::string_view bytes) {
    PictureFacts facts;
    if (bytes.size() != sizeof facts)
        return {};
    std::memcpy(&facts, bytes.data(), sizeof facts);
    const auto most = static_cast<int64_t>(kMostPixels);
    const bool sized = facts.width > 0 && facts.height > 0 && facts.width <= most &&
                       facts.height <= most && int64_t{facts.width} * facts.height <= most;
    for (int c = 0; c < 4; ++c) {
        if (!sized || !std::isfinite(facts.mean[c]))
            return {};
    }
    return facts;
}

/// All that is found; the process has one.
struct PictureFindings {
    std::mutex mutex;
    std::unordered_map<Hash, PictureFacts> facts;
    std::filesystem::path folder;
    std::unique_ptr<FindingsFile> file;
    std::shared_ptr<FindingsFolder> bakes;
};

PictureFindings& findings() {
    static PictureFindings all;
    return all;
}

Hash key_of_bake(Hash key) {
    return Hasher().text("bake").value(kBakesVersion).value(key).result();
}

std::shared_ptr<FindingsFolder> bakes() {
    const std::lock_guard lock(findings().mutex);
    return findings().bakes;
}

}  // namespace

std::optional<PictureFacts> known_facts(Hash picture) {
    PictureFindings& all = findings();
    const std::lock_guard lock(all.mutex);
    const auto kept = all.file ? all.file->find(picture) : std::nullopt;
    const auto read = kept ? facts_of_bytes(*kept) : std::nullopt;
    if (read)
        return read;
    const auto at = all.facts.find(picture);
    if (at == all.facts.end())
        return {};
    if (all.file)
        all.file->add(picture, {reinterpret_cast<const char*>(&at->second), sizeof at->second});
    return at->second;
}

void add_facts(Hash picture, const PictureFacts& facts) {
    PictureFindings& all = findings();
    const std::lock_guard lock(all.mutex);
    all.facts[picture] = facts;
    if (all.file)
        all.file->add(picture, {reinterpret_cast<const char*>(&facts), sizeof facts});
}

std::optional<std::string> kept_bake(Hash key) {
    const auto folder = bakes();
    return folder ? folder->find(key_of_bake(key)) : std::nullopt;
}

void keep_bake(Hash key, std::string_view png) {
    if (const auto folder = bakes())
        folder->add(key_of_bake(key), png);
}

void keep_pictures(const std::filesystem::path& folder) {
    PictureFindings& all = findings();
    const std::lock_guard lock(all.mutex);
    if (all.file)
        all.file->save();
    if (all.file && all.folder == folder)
        return;
    all.folder = folder;
    all.file = std::make_unique<FindingsFile>(folder / "pictures.bin", kFactsVersion);
    all.bakes = std::make_shared<FindingsFolder>(folder / "baked", ".png");
}

}  // namespace lodestone::image
