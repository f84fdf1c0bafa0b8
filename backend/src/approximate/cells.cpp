// SPDX-License-Identifier: GPL-3.0-or-later
#include "approximate/cells.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <tuple>
#include <utility>

namespace lodestone::approximate {
namespace {

// Four numbers that one instruction adds.
using Four = float __attribute__((vector_size(16)));

// A vertex may move along its surface, but not for nothing: this share of its planes' weight holds
// it in all directions. Less follows creases better, more keeps flat faces' cells regular.
constexpr float kHold = 1e-4f;
// Open borders and those between material slots are held this much of the planes' weight.
constexpr float kBorder = 0.3f;
// A vertex without area has at least some weight (in a frame of unit extent).
constexpr float kLeastWeight = 1e-20f;
constexpr size_t kManyVertices = size_t{1} << 20u;
constexpr int kDigit = 10;  // bits sorted by at a time

template <typename Code>
constexpr int kSteps = sizeof(Code) == 4 ? 10 : 20;  // bits an axis

uint32_t spread(uint32_t v) {  // two zeros behind each of ten bits
    v = (v | v << 16u) & 0x030000ffu;
    v = (v | v << 8u) & 0x0300f00fu;
    v = (v | v << 4u) & 0x030c30c3u;
    return (v | v << 2u) & 0x09249249u;
}

uint64_t spread(uint64_t v) {  // ... of twenty
    const auto low = static_cast<uint32_t>(v & 1023u);
    const auto high = static_cast<uint32_t>(v >> 10u);
    return uint64_t{spread(low)} | uint64_t{spread(high)} << 30u;
}

template <typename Code>
struct Key {
    Code code;
    uint32_t vertex;
};

/// The vertices along the curve; those of one code in their own order.
template <typename Code>
ScratchVector<Key<Code>> sorted(const ScratchVector<Four>& points) {
    constexpr auto kMost = static_cast<float>((1u << static_cast<unsigned>(kSteps<Code>)) - 1);
    constexpr size_t kDigits = 3 * kSteps<Code> / kDigit;
    constexpr size_t kValues = size_t{1} << static_cast<unsigned>(kDigit);
    ScratchVector<Key<Code>> keys(points.size());
    std::array<std::array<uint32_t, kValues>, kDigits> starts{};
    for (size_t i = 0; i < points.size(); ++i) {
        const Four at = points[i] * kMost;
        const Code code = spread(static_cast<Code>(static_cast<uint32_t>(at[0]))) |
                          spread(static_cast<Code>(static_cast<uint32_t>(at[1]))) << 1u |
                          spread(static_cast<Code>(static_cast<uint32_t>(at[2]))) << 2u;
        keys[i] = {code, static_cast<uint32_t>(i)};
        for (size_t digit = 0; digit < kDigits; ++digit)
            ++starts[digit][code >> (digit * kDigit) & (kValues - 1)];
    }
    ScratchVector<Key<Code>> other(points.size());
    for (size_t digit = 0; digit < kDigits; ++digit) {
        uint32_t sum = 0;
        for (uint32_t& start : starts[digit])
            start = std::exchange(sum, sum + start);
        for (const Key<Code>& key : keys)
            other[starts[digit][key.code >> (digit * kDigit) & (kValues - 1)]++] = key;
        keys.swap(other);
    }
    return keys;
}

bool same(const Four& a, const Four& b) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/// Of each vertex the first at its position; empty when all stand apart.
template <typename Code>
ScratchVector<uint32_t> find_twins(const ScratchVector<Four>& points,
                                   const ScratchVector<Key<Code>>& keys) {
    ScratchVector<uint32_t> twins;
    ScratchVector<uint32_t> run;
    for (size_t begin = 0; begin < keys.size();) {
        size_t end = begin + 1;
        while (end < keys.size() && keys[end].code == keys[begin].code)
            ++end;
        if (end - begin > 1) {
            run.clear();
            for (size_t i = begin; i < end; ++i)
                run.push_back(keys[i].vertex);
            const auto place = [&](uint32_t v) {
                return std::tuple(points[v][0], points[v][1], points[v][2], v);
            };
            std::sort(run.begin(), run.end(),
                      [&](uint32_t a, uint32_t b) { return place(a) < place(b); });
            for (size_t i = 1, first = 0; i < run.size(); ++i) {
                if (!same(points[run[i]], points[run[first]])) {
                    first = i;
                    continue;
                }
                if (twins.empty()) {
                    twins.resize(points.size());
                    for (uint32_t v = 0; v < twins.size(); ++v)
                        twins[v] = v;
                }
                twins[run[i]] = run[first];
            }
        }
        begin = end;
    }
    return twins;
}

/// What the triangles around a vertex add up to.
struct Sums {
    Four planes_a;  // xx xy xz yy
    Four planes_b;  // yz zz - -
    Four open;      // from the first neighbor to the last: nothing where the fan closes
};

/// Neighboring slots count differently in `open`, so that their border does not close.
float side_of(uint16_t slot) {
    return 1 + 0.37f * static_cast<float>(slot % 7u);
}

ScratchVector<Sums> sums_of(const Mesh& mesh, const ScratchVector<Four>& points,
                            const ScratchVector<uint32_t>& twins, const Job& job) {
    ScratchVector<Sums> sums(points.size(), Sums{});
    constexpr size_t kAhead = 12;  // triangles whose vertices are asked for
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if ((i & 0xffffu) == 0)
            job.check();
        if (i + kAhead < mesh.triangles.size()) {
            const Triangle& coming = mesh.triangles[i + kAhead];
            for (const uint32_t v : {coming.x, coming.y, coming.z}) {
                __builtin_prefetch(&points[v]);
                __builtin_prefetch(&sums[v], 1);
            }
        }
        Triangle t = mesh.triangles[i];
        if (!twins.empty())
            t = {twins[t.x], twins[t.y], twins[t.z]};
        const Four a = points[t.x];
        const Four b = points[t.y];
        const Four c = points[t.z];
        const Four u = b - a;
        const Four v = c - a;
        const float nx = u[1] * v[2] - u[2] * v[1];
        const float ny = u[2] * v[0] - u[0] * v[2];
        const float nz = u[0] * v[1] - u[1] * v[0];
        const float square = nx * nx + ny * ny + nz * nz;
        if (!(square > 0))
            continue;
        const float weight = 1 / std::sqrt(square);
        const Four planes_a = Four{nx * nx, nx * ny, nx * nz, ny * ny} * weight;
        const Four planes_b = Four{ny * nz, nz * nz, 0, 0} * weight;
        const float side = mesh.slots.empty() ? 1.0f : side_of(mesh.slots[i]);
        const auto add = [&](uint32_t vertex, const Four& across) {
            Sums& sum = sums[vertex];
            sum.planes_a += planes_a;
            sum.planes_b += planes_b;
            sum.open += across * side;
        };
        add(t.x, c - b);
        add(t.y, a - c);
        add(t.z, b - a);
    }
    return sums;
}

/// The planes a vertex is held by: its triangles', its border's, and a little of all.
[[gnu::always_inline]] inline PlaneSum planes_of(const Sums& sum) {
    PlaneSum p{sum.planes_a[0], sum.planes_a[1], sum.planes_a[2],
               sum.planes_a[3], sum.planes_b[0], sum.planes_b[1]};
    const float weight = p.xx + p.yy + p.zz + kLeastWeight;
    float all = kHold * weight;
    const Four& open = sum.open;
    const float square = open[0] * open[0] + open[1] * open[1] + open[2] * open[2];
    if (square > 1e-4f * weight) {
        // The line along the border: everything but what lies in its direction.
        all += kBorder * weight;
        const float along = kBorder * weight / square;
        p.xx -= along * open[0] * open[0];
        p.xy -= along * open[0] * open[1];
        p.xz -= along * open[0] * open[2];
        p.yy -= along * open[1] * open[1];
        p.yz -= along * open[1] * open[2];
        p.zz -= along * open[2] * open[2];
    }
    p.xx += all;
    p.yy += all;
    p.zz += all;
    return p;
}

/// How many of the lowest bits of the codes can go while `least` cells are left.
template <typename Code>
int spare_bits(const ScratchVector<Key<Code>>& keys, size_t least) {
    std::array<size_t, 65> splits{};
    for (size_t i = 1; i < keys.size(); ++i)
        ++splits[static_cast<size_t>(std::bit_width(keys[i].code ^ keys[i - 1].code))];
    size_t cells = 1;
    for (int bits = 3 * kSteps<Code>; bits > 0; --bits) {
        cells += splits[static_cast<size_t>(bits)];
        if (cells >= least)
            return bits - 1;
    }
    return 0;
}

template <typename Code>
void fill(Cells& cells, const Mesh& mesh, const ScratchVector<Four>& points, size_t least,
          const Job& job) {
    const ScratchVector<Key<Code>> keys = sorted<Code>(points);
    job.check();
    cells.twins = find_twins(points, keys);
    const int spare = spare_bits(keys, least);
    cells.step = std::ldexp(1.0f, (spare + 2) / 3 - kSteps<Code>);
    cells.cell.resize(points.size());
    cells.quadrics.reserve(std::min(keys.size(), 2 * least));
    cells.split.reserve(std::min(keys.size(), 2 * least));
    // Last, so that its memory can be used again.
    const ScratchVector<Sums> sums = sums_of(mesh, points, cells.twins, job);
    constexpr size_t kAhead = 16;
    for (size_t i = 0; i < keys.size(); ++i) {
        if (i + kAhead < keys.size()) {
            __builtin_prefetch(&points[keys[i + kAhead].vertex]);
            __builtin_prefetch(&sums[keys[i + kAhead].vertex]);
        }
        const uint32_t vertex = keys[i].vertex;
        const Four& p = points[vertex];
        const glm::vec3 point(p[0], p[1], p[2]);
        const int differs =
            i == 0 ? 64 : static_cast<int>(std::bit_width(keys[i].code ^ keys[i - 1].code));
        if (differs > spare) {
            if (i > 0)
                cells.split.push_back(static_cast<uint8_t>(differs));
            cells.quadrics.emplace_back();
            cells.quadrics.back().origin = point;
        }
        cells.cell[vertex] = static_cast<uint32_t>(cells.quadrics.size() - 1);
        if (cells.twins.empty() || cells.twins[vertex] == vertex)
            cells.quadrics.back().add(planes_of(sums[vertex]), point);
    }
    cells.split.push_back(64);
}

}  // namespace

Cells divide(const Mesh& mesh, size_t least, const Job& job) {
    Cells cells;
    if (mesh.triangles.empty())
        return cells;
    glm::vec3 low = mesh.positions[0];
    glm::vec3 high = low;
    for (const glm::vec3& p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    cells.low = glm::dvec3(low);
    const glm::dvec3 size = glm::dvec3(high) - cells.low;
    cells.unit = std::max({size.x, size.y, size.z});
    const double scale = 1 / cells.unit;
    if (!std::isfinite(scale)) {
        cells.unit = 0;
        return cells;
    }
    ScratchVector<Four> points(mesh.positions.size());
    for (size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 p = (glm::dvec3(mesh.positions[i]) - cells.low) * scale;
        points[i] = Four{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    }
    job.check();
    if (points.size() > kManyVertices)
        fill<uint64_t>(cells, mesh, points, least, job);
    else
        fill<uint32_t>(cells, mesh, points, least, job);
    job.check();
    cells.triangles.resize(mesh.triangles.size());
    cells.sources.resize(mesh.triangles.size());
    size_t kept = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        const Triangle of(cells.cell[t.x], cells.cell[t.y], cells.cell[t.z]);
        // Without a branch: nobody can predict it.
        cells.triangles[kept] = of;
        cells.sources[kept] = static_cast<uint32_t>(i);
        kept += (of.x != of.y) & (of.y != of.z) & (of.z != of.x);
    }
    cells.triangles.resize(kept);
    cells.sources.resize(kept);
    return cells;
}

}  // namespace lodestone::approximate
