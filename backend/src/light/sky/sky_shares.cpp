// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/sky/sky_shares.h"

#include "base/maths.h"

#include <algorithm>
#include <cmath>
#include <cstring>

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

}  // namespace

uint8_t share_byte(double share) {
    return static_cast<uint8_t>(std::lround(kShareSteps * std::sqrt(limited(share, 0, 1))));
}

double share_of_byte(uint8_t byte) {
    const double root = static_cast<double>(byte) / kShareSteps;
    return root * root;
}

std::string SkyShares::bytes() const {
    std::string out;
    append_bytes(out, mean);
    append_bytes(out, static_cast<uint32_t>(splits.size()));
    for (const std::vector<geometry::WeldedEdge>& edges : splits) {
        append_bytes(out, static_cast<uint32_t>(edges.size()));
        for (const geometry::WeldedEdge edge : edges)
            append_bytes(out, edge);
    }
    out.append(reinterpret_cast<const char*>(corners.data()), corners.size());
    return out;
}

std::optional<SkyShares> SkyShares::of_bytes(std::string_view bytes, size_t triangles) {
    ByteReader reader(bytes);
    SkyShares out;
    uint32_t rounds = 0;
    if (!reader.take(out.mean) || !(out.mean >= 0 && out.mean <= 1) || !reader.take(rounds) ||
        rounds > 2 * kSplitRounds)
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
    const std::string_view rest = reader.rest();
    if (rest.size() % 3 != 0 || rest.size() / 3 < triangles ||
        (rounds == 0 && rest.size() / 3 != triangles))
        return {};
    out.corners.resize(rest.size());
    std::memcpy(out.corners.data(), rest.data(), rest.size());
    return out;
}

bool whole(const Mesh& mesh, const SkyShares& shares) {
    return shares.splits.empty() && shares.corners.size() == 3 * mesh.triangles.size();
}

std::optional<Mesh> split_for_sky(const Mesh& mesh, const SkyShares& shares) {
    const size_t most = shares.corners.size() / 3;
    if (mesh.triangles.size() > most)
        return {};
    geometry::EdgeSplitMesh split(mesh);
    for (const std::vector<geometry::WeldedEdge>& edges : shares.splits) {
        if (split.triangles_after(edges) > most)
            return {};
        split.split(edges);
    }
    if (split.mesh().triangles.size() != most)
        return {};
    return split.take();
}

}  // namespace lodestone::light
