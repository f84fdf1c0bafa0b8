// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/kept_pixels.h"

#include "base/recent_values.h"

#include <memory>
#include <mutex>

namespace lodestone::image {
namespace {

using PixelCache = RecentValues<PackedImage>;

/// The process' pixels, and how many want them.
struct SharedPixels {
    std::mutex mutex;
    size_t keepers = 0;
    std::shared_ptr<PixelCache> cache;
};

SharedPixels& shared_pixels() {
    static SharedPixels all;
    return all;
}

}  // namespace

KeptPixels::KeptPixels() {
    SharedPixels& all = shared_pixels();
    const std::lock_guard lock(all.mutex);
    if (all.keepers++ == 0)
        all.cache = std::make_shared<PixelCache>(kMostBytes);
}

KeptPixels::~KeptPixels() {
    SharedPixels& all = shared_pixels();
    std::shared_ptr<PixelCache> last;  // freed without the lock
    const std::lock_guard lock(all.mutex);
    if (--all.keepers == 0)
        last = std::move(all.cache);
}

PackedPtr kept_pixels(const Picture& picture, const std::function<PackedPtr()>& decode) {
    std::shared_ptr<PixelCache> cache;
    {
        SharedPixels& all = shared_pixels();
        const std::lock_guard lock(all.mutex);
        cache = all.cache;
    }
    if (!cache)
        return decode();
    return cache->of(picture.hash, decode, [](const PackedImage& image) { return image.memory(); });
}

}  // namespace lodestone::image
