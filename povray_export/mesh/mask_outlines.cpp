// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/mask_outlines.h"

#include "base/error.h"
#include "geometry/ring_simplification.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace lodestone::povray {
namespace {

/// The part of the tolerance that leaving out corners may move an outline by, where it is that of
/// the texels themselves; interpolating between them takes the rest.
/// Taste: a larger value draws fewer corners, and leaves of some texels as triangles.
constexpr double kOfTexel = 0.75;
/// The part of a larger texel, the mean of several, by which its outline is off.
/// Law: half of it.
constexpr double kOfMean = 0.5;
/// The least part of a texel, and the step of such parts, by which corners are left out.
/// Taste: a smaller value finds more outlines, each with some corners fewer than the next.
constexpr double kPart = 0.25;
/// The least side of a picture in texels that is still outlined.
/// Taste: a larger value keeps the outlines of things far away finer than needed.
constexpr int kLeastSide = 4;
/// Pictures of more texels are halved before they are outlined.
/// Taste: a larger value outlines larger pictures texel by texel, for 32 bytes a texel meanwhile.
constexpr size_t kMostTexels = size_t{1} << 22u;
/// The squares on each side of a texel that is not interpolated, so that its corners stay.
/// Taste: a larger value rounds their corners less.
constexpr int kSquares = 4;
/// The share of the area by which an outline may miss it: a tenth is what an alpha of 0.9 misses.
/// Taste: a larger value cuts out what is no longer a mask when it is made smaller.
constexpr double kMostMissed = 0.1;

/// The hash of what a texture's alpha is, wherever it lies.
Hash content_of(const Texture& texture) {
    return Hasher()
        .value(texture.picture->hash)
        .value(texture.channel)
        .value(texture.scale.x)
        .value(texture.offset.x)
        .result();
}

bool closest(const Texture& texture) {
    return texture.interpolation == TextureInterpolation::Closest;
}

/// The fewest halvings of a picture that is outlined.
int least_halvings(const Picture& picture) {
    const size_t texels = static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height);
    int halvings = 0;
    while ((texels >> (2 * static_cast<unsigned>(halvings))) > kMostTexels)
        ++halvings;
    return halvings;
}

int halvings_of(const Picture& picture, double tolerance) {
    const int side = std::min(picture.width, picture.height);
    int halvings = least_halvings(picture);
    while ((side >> (halvings + 1)) >= kLeastSide &&
           (kOfMean + kPart) * std::ldexp(1.0, halvings + 1) <= tolerance)
        ++halvings;
    return halvings;
}

/// The texels, of those that are left, by which leaving out corners may move an outline.
double part_of(double tolerance, int halvings) {
    const double texels = std::ldexp(std::clamp(tolerance, 1.0, 1e9), -halvings);
    const double part = halvings == 0 ? kOfTexel * texels : texels - kOfMean;
    return kPart * std::floor(std::clamp(part, kPart, 1.0) / kPart);
}

/// Every texel as kSquares x kSquares.
image::MaskNumbers squares(const image::MaskNumbers& from) {
    image::MaskNumbers to;
    to.width = kSquares * from.width;
    to.height = kSquares * from.height;
    to.alpha.resize(static_cast<size_t>(to.width) * static_cast<size_t>(to.height));
    for (int y = 0; y < to.height; ++y) {
        for (int x = 0; x < to.width; ++x)
            to.alpha[static_cast<size_t>(y) * static_cast<size_t>(to.width) +
                     static_cast<size_t>(x)] =
                from.alpha[static_cast<size_t>(y / kSquares) * static_cast<size_t>(from.width) +
                           static_cast<size_t>(x / kSquares)];
    }
    return to;
}

/// The texels of a picture made smaller that are not clear all over, with those around them: what
/// is outlined there has nothing outside within a texel.
std::vector<float> surroundings(const image::MaskTexels& texels, int width, int height) {
    std::vector<uint8_t> shown(static_cast<size_t>(width) * static_cast<size_t>(height), 0);
    const auto wrapped = [](int at, int count) { return (at + count) % count; };
    const auto index = [&](int x, int y) {
        return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
    };
    // Between texels the alpha reaches to the next ones: the column (row) of each texel, with one
    // more before the first and behind the last.
    const auto blocks = [&](int count, int small) {
        std::vector<int> block;
        for (int i = -1; i <= count; ++i)
            block.push_back(
                static_cast<int>(static_cast<int64_t>(wrapped(i, count)) * small / count));
        return block;
    };
    const std::vector<int> columns = blocks(texels.width, width);
    const std::vector<int> rows = blocks(texels.height, height);
    for (int y = 0; y < texels.height; ++y) {
        const uint8_t* row =
            texels.alpha.data() + static_cast<size_t>(y) * static_cast<size_t>(texels.width);
        const int* v = rows.data() + y;
        for (int x = 0; x < texels.width; ++x) {
            if (row[x] == 0)
                continue;
            const int* u = columns.data() + x;
            shown[index(u[1], v[1])] = 1;
            if (u[0] == u[2] && v[0] == v[2])
                continue;
            for (int i = 0; i < 9; ++i)
                shown[index(u[i % 3], v[i / 3])] = 1;
        }
    }
    std::vector<float> out(shown.size(), 0.0f);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (int dy = -1; dy <= 1 && shown[index(x, y)] != 0; ++dy) {
                for (int dx = -1; dx <= 1; ++dx)
                    out[index(wrapped(x + dx, width), wrapped(y + dy, height))] = 1;
            }
        }
    }
    return out;
}

/// A picture's alpha as it is outlined.
struct OutlinedPicture {
    LevelGrid grid;
    bool sure = false;  // the alpha itself, not means of several texels
};

OutlinedPicture outlined(const ShownMask& mask, const image::MaskTexels& texels, int halvings) {
    const bool binary = mask.cutoff && halvings > 0;
    image::MaskNumbers numbers =
        image::halved(texels, halvings, binary ? mask.cutoff : std::nullopt);
    const bool fine = closest(mask.texture) && halvings == 0 &&
                      texels.size() * kSquares * kSquares <= kMostTexels;
    if (fine)
        numbers = squares(numbers);
    return {LevelGrid(numbers.width, numbers.height, numbers.alpha,
                      mask.texture.extension == TextureExtension::Repeat && !closest(mask.texture)),
            halvings == 0};
}

/// The level between two steps of the alpha that is nearest: no texel is exactly there.
double between_steps(double level) {
    return (std::floor(255 * level) + 0.5) / 255;
}

/// The share of what is seen that is there.
double share_of(const ShownMask& mask, const image::MaskTexels& texels) {
    if (!mask.cutoff)
        return image::count(texels, mask.seen).mean;
    image::MaskTexels binary{texels.width, texels.height, texels.alpha};
    for (uint8_t& alpha : binary.alpha)
        alpha = alpha >= 255 * *mask.cutoff ? 255 : 0;
    return image::count(binary, mask.seen).mean;
}

/// The level at which the area that is seen is the mask's; below 0: there is none.
double level_of(const ShownMask& mask, const image::MaskTexels& texels, int halvings) {
    if (mask.cutoff && halvings == 0)
        return (std::ceil(255 * *mask.cutoff) - 0.5) / 255;
    const OutlinedPicture picture = outlined(mask, texels, halvings);
    const std::vector<uint8_t> seen =
        image::seen_of(mask.seen, texels, picture.grid.width(), picture.grid.height());
    const auto whole = static_cast<double>(std::count(seen.begin(), seen.end(), uint8_t{1}));
    const double wanted = whole * share_of(mask, texels);
    double level = between_steps(picture.grid.level_of(wanted, seen));
    if (picture.sure)
        level = std::clamp(level, between_steps(0.1), between_steps(0.9));
    const double missed = std::abs(picture.grid.area(level, seen) - wanted);
    return missed <= kMostMissed * wanted + 0.5 ? level : -1;
}

/// The corners of rings that are too many.
/// Law: no rings have as many.
constexpr uint64_t kTooMany = ~uint64_t{0};

/// The beginning of the file that keeps outlines: raised whenever what is found of a mask changes.
/// Law: another one is another version.
constexpr std::string_view kVersion = "LDSMSK01";

template <typename Value>
requires std::is_trivially_copyable_v<Value> std::string bytes_of(const Value& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

template <typename Value>
requires std::is_trivially_copyable_v<Value>
bool take(std::string_view bytes, Value& value) {
    if (bytes.size() != sizeof value)
        return false;
    std::memcpy(&value, bytes.data(), sizeof value);
    return true;
}

bool take(std::string_view bytes, image::MaskCount& count) {
    if (!take<image::MaskCount>(bytes, count))
        return false;
    const auto share = [](double value) { return value >= 0 && value <= 1; };
    return count.sure <= count.seen && count.clear <= count.sure &&
           count.edge <= count.seen - count.sure && share(count.mean) && share(count.clear_mean) &&
           share(count.full_mean) && std::isfinite(count.spread);
}

bool take(std::string_view bytes, double& value) {
    return take<double>(bytes, value) && std::isfinite(value);
}

/// Law: an outline's numbers of points and of triangles, before them.
struct OutlineHead {
    uint64_t points = 0;
    uint64_t triangles = 0;
};

/// "": there is none.
std::string bytes_of(const MaskOutlinePtr& outline) {
    if (!outline)
        return "";
    const PlaneTriangles& inside = outline->inside;
    std::string out = bytes_of(OutlineHead{inside.points.size(), inside.triangles.size()});
    out.append(reinterpret_cast<const char*>(inside.points.data()),
               inside.points.size() * sizeof(glm::dvec2));
    out.append(reinterpret_cast<const char*>(inside.triangles.data()),
               inside.triangles.size() * sizeof(glm::uvec3));
    return out;
}

bool take(std::string_view bytes, MaskOutlinePtr& outline) {
    // The farthest corner of an outline, in pictures.
    // Law: those of pictures that repeat lie half a texel outside at most.
    constexpr double kFarthest = 2;
    outline = nullptr;
    if (bytes.empty())
        return true;
    OutlineHead head;
    if (bytes.size() < sizeof head)
        return false;
    std::memcpy(&head, bytes.data(), sizeof head);
    bytes.remove_prefix(sizeof head);
    if (head.points > bytes.size() / sizeof(glm::dvec2) ||
        head.triangles > bytes.size() / sizeof(glm::uvec3) ||
        bytes.size() != head.points * sizeof(glm::dvec2) + head.triangles * sizeof(glm::uvec3))
        return false;
    auto out = std::make_shared<MaskOutline>();
    out->inside.points.resize(head.points);
    out->inside.triangles.resize(head.triangles);
    std::memcpy(out->inside.points.data(), bytes.data(), head.points * sizeof(glm::dvec2));
    bytes.remove_prefix(head.points * sizeof(glm::dvec2));
    std::memcpy(out->inside.triangles.data(), bytes.data(), head.triangles * sizeof(glm::uvec3));
    for (const glm::dvec2& point : out->inside.points) {
        if (!(std::abs(point.x) <= kFarthest && std::abs(point.y) <= kFarthest))
            return false;
    }
    for (const glm::uvec3& triangle : out->inside.triangles) {
        if (std::max({triangle.x, triangle.y, triangle.z}) >= head.points)
            return false;
    }
    outline = out;
    return true;
}

}  // namespace

template <typename Value>
const Value& MaskOutlines::SharedValues<Value>::of(Hash key, const std::function<Value()>& make) {
    std::shared_ptr<SharedValue> entry;
    {
        const std::lock_guard lock(mutex);
        std::shared_ptr<SharedValue>& found = known[key];
        if (!found)
            found = std::make_shared<SharedValue>();
        entry = found;
    }
    const std::lock_guard making(entry->making);
    if (!entry->made) {
        entry->value = make();
        entry->made = true;
    }
    return entry->value;
}

MaskOutlines::MaskOutlines(const std::filesystem::path& file)
    : findings_(file, kVersion), keeps_(!file.empty()) {}

template <typename Value>
Value MaskOutlines::kept_or(std::string_view purpose, Hash key,
                            const std::function<Value()>& make) {
    if (!keeps_)
        return make();
    const Hash own = Hasher().text(purpose).value(key).result();
    const std::optional<std::string> kept = findings_.find(own);
    Value value{};
    if (kept && take(*kept, value))
        return value;
    value = make();
    findings_.add(own, bytes_of(value));
    return value;
}

MaskTexelsPtr MaskOutlines::texels(const Texture& texture) {
    return texels_.of(content_of(texture), [&]() -> MaskTexelsPtr {
        auto found = std::make_shared<const image::MaskTexels>(image::mask_texels(texture));
        const Picture& picture = *texture.picture;
        if (found->width != picture.width || found->height != picture.height)
            fail(Status::BadFile, "'", picture.name, "' is ", found->width, " x ", found->height,
                 " texels, not ", picture.width, " x ", picture.height);
        return found;
    });
}

image::MaskCount MaskOutlines::count(const Texture& texture, const image::SeenTexels& seen) {
    const Hash key =
        Hasher().value(content_of(texture)).array(std::span<const uint8_t>(seen.blocks)).result();
    return counts_.of(key, [&] {
        return kept_or<image::MaskCount>("count", key,
                                         [&] { return image::count(*texels(texture), seen); });
    });
}

MaskOutlines::OutlineRingsPtr MaskOutlines::rings(const ShownMask& mask, int halvings, double level,
                                                  double tolerance, Hash key) {
    return rings_.of(key, [&]() -> OutlineRingsPtr {
        const OutlinedPicture picture = outlined(mask, *texels(mask.texture), halvings);
        auto out = std::make_shared<OutlineRings>();
        out->size = {picture.grid.width(), picture.grid.height()};
        bool too_many = false;
        // Law: leaving out corners by less than a texel leaves one of some crossings.
        constexpr size_t kMostCrossings = 16 * kMostCorners;
        const std::vector<Ring> rings = picture.grid.rings(level, kMostCrossings, too_many);
        if (too_many)
            return nullptr;
        for (const Ring& ring : rings) {
            out->area += signed_area(ring);
            out->simple.push_back(simplified(ring, tolerance, {out->size.x, out->size.y}));
            out->corners += out->simple.back().size();
        }
        return out->corners <= kMostCorners ? out : nullptr;
    });
}

MaskOutlinePtr MaskOutlines::outline_at(const ShownMask& mask, int halvings, double level, Hash key,
                                        const Job& job) {
    // Outlines that are nearer to each other than the tolerance may cross: then it is made smaller.
    const double part = part_of(mask.tolerance, halvings);
    for (int halving = 0; halving < 4; ++halving) {
        const double tolerance = std::ldexp(part, -halving);
        const Hash own = Hasher().value(key).value(tolerance).result();
        const auto made = [&] { return rings(mask, halvings, level, tolerance, own); };
        const uint64_t corners = corners_.of(own, [&] {
            return kept_or<uint64_t>("corners", own, [&]() -> uint64_t {
                const OutlineRingsPtr found = made();
                return found ? found->corners : kTooMany;
            });
        });
        if (corners > kMostCorners || corners > mask.most_corners)
            return nullptr;
        MaskOutlinePtr found = outlines_.of(own, [&] {
            return kept_or<MaskOutlinePtr>("outline", own, [&]() -> MaskOutlinePtr {
                const OutlineRingsPtr rings = made();
                if (!rings)
                    return nullptr;
                auto out = std::make_shared<MaskOutline>();
                out->inside = triangulated(rings->simple, job);
                // The area of triangles that are missing or lie one on the other.
                // Taste: half a texel of a hundred is not seen; a larger value lets them cross
                // more.
                if (std::abs(out->inside.area() - rings->area) > 0.005 * rings->area + 0.5)
                    return nullptr;
                for (glm::dvec2& point : out->inside.points)
                    point /= rings->size;
                return out;
            });
        });
        if (found)
            return found;
    }
    return nullptr;
}

MaskOutlinePtr MaskOutlines::outline(const ShownMask& mask, const Job& job) {
    const Picture& shown = *mask.texture.picture;
    const int least = least_halvings(shown);
    for (int halvings = halvings_of(shown, mask.tolerance); halvings >= least; --halvings) {
        Hasher picture;
        picture.value(content_of(mask.texture))
            .value(mask.texture.interpolation)
            .value(mask.texture.extension == TextureExtension::Repeat)
            .value(halvings)
            .value(mask.cutoff ? *mask.cutoff : -1.0);
        Hasher use = picture;
        use.array(std::span<const uint8_t>(mask.seen.blocks));
        const double level = levels_.of(use.result(), [&] {
            return kept_or<double>("level", use.result(),
                                   [&] { return level_of(mask, *texels(mask.texture), halvings); });
        });
        if (level >= 0 && level <= 2)
            return outline_at(mask, halvings, level, picture.value(level).result(), job);
    }
    return nullptr;
}

MaskOutlinePtr MaskOutlines::hull(const Texture& texture, size_t most_corners, const Job& job) {
    // The texels along the longer side of the picture whose texels are surrounded.
    // Taste: a larger value leaves fewer clear texels in, for more triangles.
    constexpr int kFinest = 64;
    constexpr int kCoarsest = 8;  // Taste: what is coarser is the whole picture.
    const int side = std::max(texture.picture->width, texture.picture->height);
    for (int halvings = 0; side >> halvings >= kCoarsest; ++halvings) {
        if (side >> halvings > kFinest)
            continue;
        const Hash key = Hasher()
                             .value(content_of(texture))
                             .value(texture.extension == TextureExtension::Repeat)
                             .value(halvings)
                             .result();
        MaskOutlinePtr found = hulls_.of(key, [&] {
            return kept_or<MaskOutlinePtr>("hull", key,
                                           [&] { return hull_at(texture, halvings, job); });
        });
        if (!found)
            return nullptr;
        if (found->inside.points.size() <= most_corners)
            return found;
    }
    return nullptr;
}

MaskOutlinePtr MaskOutlines::hull_at(const Texture& texture, int halvings, const Job& job) {
    // The share of a picture from which on nothing is gained by leaving out the rest.
    // Taste: a larger value leaves out less, for as many triangles.
    constexpr double kMostLeft = 0.8;
    const MaskTexelsPtr texels = this->texels(texture);
    const int width = std::max(1, texels->width >> halvings);
    const int height = std::max(1, texels->height >> halvings);
    const LevelGrid grid(width, height, surroundings(*texels, width, height),
                         texture.extension == TextureExtension::Repeat);
    bool too_many = false;
    std::vector<Ring> rings = grid.rings(0.5, kMostCorners, too_many);
    for (Ring& ring : rings)
        ring = simplified(ring, kOfTexel, {double(width), double(height)});
    auto out = std::make_shared<MaskOutline>();
    out->inside = triangulated(rings, job);
    double area = 0;
    for (const Ring& ring : rings)
        area += signed_area(ring);
    // Law: what overlaps is drawn twice, what is missing not at all.
    constexpr double kRounding = 1e-9;
    const double whole = double(width) * height;
    if (too_many || area > kMostLeft * whole ||
        std::abs(out->inside.area() - area) > kRounding * whole)
        return nullptr;
    for (glm::dvec2& point : out->inside.points)
        point /= glm::dvec2(width, height);
    return out;
}

}  // namespace lodestone::povray
