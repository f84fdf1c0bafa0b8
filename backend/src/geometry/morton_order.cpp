// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/morton_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace lodestone::geometry {
namespace {

// The bits of a coordinate; also those that one pass sorts by.
// Taste: more make finer cells and larger tables; three axes must fit into 32 bits.
constexpr unsigned kBits = 10;
// Law: the values of kBits bits.
constexpr uint32_t kValues = 1u << kBits;

struct MortonKey {
    uint32_t code, point;
};

uint32_t spread(uint32_t v) {  // puts two zeros behind each of ten bits
    v = (v | v << 16u) & 0x030000ffu;
    v = (v | v << 8u) & 0x0300f00fu;
    v = (v | v << 4u) & 0x030c30c3u;
    return (v | v << 2u) & 0x09249249u;
}

}  // namespace

std::vector<uint32_t> morton_order(const std::vector<glm::vec3>& points,
                                   std::vector<uint32_t>& first) {
    Box3 box;
    for (const glm::vec3& point : points) {
        if (finite(point))
            box.add(glm::dvec3(point));
    }
    first.resize(points.size());
    std::vector<uint32_t> order;
    if (box.empty()) {
        for (uint32_t i = 0; i < first.size(); ++i)
            first[i] = i;
        return order;
    }
    const glm::dvec3 size = box.size();
    const double reach = std::max({size.x, size.y, size.z});
    const double scale = reach > 0 ? (kValues - 1) / reach : 0;
    std::vector<MortonKey> keys;
    keys.reserve(points.size());
    std::array<std::array<uint32_t, kValues>, 3> starts{};
    for (uint32_t i = 0; i < points.size(); ++i) {
        first[i] = i;
        if (!finite(points[i]))
            continue;
        const glm::dvec3 at = (glm::dvec3(points[i]) - box.low) * scale;
        const uint32_t code = spread(static_cast<uint32_t>(at.x)) |
                              spread(static_cast<uint32_t>(at.y)) << 1u |
                              spread(static_cast<uint32_t>(at.z)) << 2u;
        keys.push_back({code, i});
        for (unsigned digit = 0; digit < 3; ++digit)
            ++starts[digit][code >> (digit * kBits) & (kValues - 1)];
    }
    std::vector<MortonKey> other(keys.size());
    for (unsigned digit = 0; digit < 3; ++digit) {
        uint32_t sum = 0;
        for (uint32_t& start : starts[digit])
            start = std::exchange(sum, sum + start);
        for (const MortonKey& key : keys)
            other[starts[digit][key.code >> (digit * kBits) & (kValues - 1)]++] = key;
        keys.swap(other);
    }
    order.reserve(keys.size());
    const auto place = [&](const MortonKey& key) {
        const glm::vec3& p = points[key.point];
        return std::tuple(p.x, p.y, p.z, key.point);
    };
    for (size_t begin = 0, end = 0; begin < keys.size(); begin = end) {
        while (end < keys.size() && keys[end].code == keys[begin].code)
            ++end;
        if (end - begin > 1)
            std::sort(keys.begin() + static_cast<std::ptrdiff_t>(begin),
                      keys.begin() + static_cast<std::ptrdiff_t>(end),
                      [&](const MortonKey& a, const MortonKey& b) { return place(a) < place(b); });
        for (size_t i = begin; i < end; ++i) {
            const uint32_t point = keys[i].point;
            if (i > begin && points[point] == points[order.back()])
                first[point] = order.back();
            else
                order.push_back(point);
        }
    }
    return order;
}

}  // namespace lodestone::geometry
