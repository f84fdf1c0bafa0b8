// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/sky/sky_shares.h"

#include "base/maths.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace lodestone::light {
namespace {

/// Appends a number as its bytes.
template <typename Number>
void append_bytes(std::string& out, Number number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    out.append(bytes, sizeof number);
}

/// Takes numbers from the beginning of some bytes.
class ByteReader {
public:
    explicit ByteReader(std::string_view bytes) : rest_(bytes) {}
    template <typename Number>
    bool take(Number& number) {
        if (rest_.size() < sizeof number)
            return false;
        std::memcpy(&number, rest_.data(), sizeof number);
        rest_.remove_prefix(sizeof number);
        return true;
    }
    std::string_view rest() const { return rest_; }

private:
    std::string_view rest_;
};

// The byte of the size of a pixel.
// Law: about the middle of the bytes.
constexpr double kOnePixel = 128;
// The octaves of a size by which what was found for a smaller thing still does.
// Taste: a larger value finds less anew as a camera comes nearer, with up to twice the noise.
constexpr int kOctavesAlike = 2;
// The octaves of a size from which on nothing has more rays, even where it is split.
// Taste: a larger value finds more anew as a camera comes nearer.
constexpr int kLargestOctaves = 12;

/// Whether rays for one size are enough for another.
bool enough(uint8_t found, uint8_t wanted) {
    if (found == kSeenOfAnySize || wanted == kSeenOfAnySize || found == 0)
        return found == kSeenOfAnySize;
    return found + kOctavesAlike >= std::min<double>(wanted, kOnePixel + kLargestOctaves);
}

}  // namespace

uint8_t share_byte(double share) {
    return static_cast<uint8_t>(std::lround(kShareSteps * std::sqrt(limited(share, 0, 1))));
}

double share_of_byte(uint8_t byte) {
    const double root = static_cast<double>(byte) / kShareSteps;
    return root * root;
}

uint8_t tint_byte(double part, double luminance) {
    constexpr double kNone = 128;  // Law: the middle of a byte
    if (!(luminance > 0) || !std::isfinite(part / luminance))
        return static_cast<uint8_t>(kNone);
    const double octaves = part > 0 ? std::log2(part / luminance) : -kInfinity;
    return static_cast<uint8_t>(std::lround(limited(kNone + kTintSteps * octaves, 0, kShareSteps)));
}

double octaves_of_tint(uint8_t byte) {
    return (static_cast<double>(byte) - 128) / kTintSteps;
}

uint8_t size_byte(double pixels) {
    const double octaves = pixels > 0 ? std::log2(pixels) : -kInfinity;
    return static_cast<uint8_t>(std::lround(limited(kOnePixel + octaves, kSeenOfAnySize + 1, 255)));
}

double pixels_of_size(uint8_t byte) {
    return std::exp2(byte - kOnePixel);
}

std::string SkyShares::bytes() const {
    std::string out;
    append_bytes(out, mean);
    append_bytes(out, rays);
    append_bytes(out, static_cast<uint32_t>(tints.size()));
    for (const std::vector<uint8_t>* one : {&seen, &behind}) {
        append_bytes(out, static_cast<uint32_t>(one->size()));
        out.append(reinterpret_cast<const char*>(one->data()), one->size());
    }
    append_bytes(out, static_cast<uint32_t>(splits.size()));
    append_bytes(out, long_rounds);
    for (const std::vector<geometry::WeldedEdge>& edges : splits) {
        append_bytes(out, static_cast<uint32_t>(edges.size()));
        for (const geometry::WeldedEdge edge : edges)
            append_bytes(out, edge);
    }
    out.append(reinterpret_cast<const char*>(tints.data()), tints.size());
    out.append(reinterpret_cast<const char*>(corners.data()), corners.size());
    return out;
}

std::optional<SkyShares> SkyShares::of_bytes(std::string_view bytes, size_t triangles) {
    ByteReader reader(bytes);
    SkyShares out;
    uint32_t rounds = 0;
    uint32_t tinted = 0;
    if (!reader.take(out.mean) || !(out.mean >= 0 && out.mean <= 1) || !reader.take(out.rays) ||
        !reader.take(tinted))
        return {};
    for (std::vector<uint8_t>* one : {&out.seen, &out.behind}) {
        uint32_t told = 0;
        if (!reader.take(told) || (told != 0 && told != triangles) || told > reader.rest().size())
            return {};
        one->resize(told);
        for (uint8_t& byte : *one)
            reader.take(byte);
    }
    if (!reader.take(rounds) || rounds > kMostSplitRounds || !reader.take(out.long_rounds) ||
        out.long_rounds > rounds)
        return {};
    for (uint32_t round = 0; round < rounds; ++round) {
        uint32_t count = 0;
        if (!reader.take(count) || count > reader.rest().size() / sizeof(geometry::WeldedEdge))
            return {};
        std::vector<geometry::WeldedEdge>& edges = out.splits.emplace_back(count);
        for (geometry::WeldedEdge& edge : edges)
            reader.take(edge);
        if (!std::is_sorted(edges.begin(), edges.end()))
            return {};
    }
    if (tinted > reader.rest().size())
        return {};
    out.tints.resize(tinted);
    for (uint8_t& one : out.tints)
        reader.take(one);
    const std::string_view rest = reader.rest();
    if (tinted != 0 && tinted != 2 * rest.size())
        return {};
    if (rest.size() % 3 != 0 || rest.size() / 3 < triangles ||
        (rounds == 0 && rest.size() / 3 != triangles))
        return {};
    out.corners.resize(rest.size());
    std::memcpy(out.corners.data(), rest.data(), rest.size());
    return out;
}

bool covers(const SkyShares& shares, std::span<const uint8_t> seen,
            std::span<const uint8_t> behind) {
    const std::span<const uint8_t> all[] = {seen, shares.seen, behind, shares.behind};
    size_t count = 0;
    for (const std::span<const uint8_t> one : all)
        count = std::max(count, one.size());
    for (const std::span<const uint8_t> one : all) {
        if (!one.empty() && one.size() != count)
            return false;  // those of another mesh
    }
    const auto size = [](std::span<const uint8_t> bytes, size_t i) {
        return bytes.empty() ? kSeenOfAnySize : bytes[i];
    };
    const auto back = [](std::span<const uint8_t> bytes, size_t i) {
        return !bytes.empty() && bytes[i] != 0;
    };
    for (size_t i = 0; i < count; ++i) {
        if (size(seen, i) == 0)
            continue;
        if (!enough(size(shares.seen, i), size(seen, i)) ||
            back(behind, i) != back(shares.behind, i))
            return false;
    }
    return true;
}

void see_all(std::span<uint8_t> seen, std::span<const uint8_t> before) {
    for (size_t i = 0; i < seen.size(); ++i)
        seen[i] = std::max({seen[i], i < before.size() ? before[i] : uint8_t{0}, size_byte(1)});
}

bool whole(const Mesh& mesh, const SkyShares& shares) {
    return shares.splits.empty() && shares.corners.size() == 3 * mesh.triangles.size();
}

std::optional<SkySplitMesh> split_for_sky(const Mesh& mesh, const SkyShares& shares) {
    const size_t most = shares.corners.size() / 3;
    if (mesh.triangles.size() > most)
        return {};
    geometry::EdgeSplitMesh split(mesh);
    std::vector<uint32_t> sources(mesh.triangles.size());
    std::iota(sources.begin(), sources.end(), 0u);
    for (const std::vector<geometry::WeldedEdge>& edges : shares.splits) {
        if (split.triangles_after(edges) > most)
            return {};
        std::vector<uint32_t> parents = split.split(edges);
        for (uint32_t& parent : parents)
            parent = sources[parent];
        sources = std::move(parents);
    }
    if (split.mesh().triangles.size() != most)
        return {};
    return SkySplitMesh{split.take(), std::move(sources)};
}

bool fits(const Mesh& mesh, const SkyShares& shares) {
    return whole(mesh, shares) || split_for_sky(mesh, shares).has_value();
}

}  // namespace lodestone::light
