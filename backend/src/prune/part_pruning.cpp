// SPDX-License-Identifier: GPL-3.0-or-later
#include "prune/part_pruning.h"

#include "base/disjoint_sets.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>

namespace lodestone::prune {
namespace {

// The fewest parts of a crowd, and of a kind of connected parts.
// Taste: with fewer, the loss of each part is seen.
constexpr size_t kFewestParts = 32;
// The least share of the area of a kind of connected parts.
// Taste: a smaller share would prune branches like leaves.
constexpr double kLeastShare = 0.25;
// The fewest given parts of a kind.
// Taste: with fewer, the loss of each part is seen.
constexpr size_t kFewestOfKind = 8;
// The largest part, in medians of its kind.
// Taste: a larger one would prune trunks like leaves.
constexpr double kLargestPart = 8;
// The length over the width from which on a part is slender.
// Taste: a larger one lets pickets grow in length, too.
constexpr double kSlender = 3;
// The squared deviation of areas, over their squared mean, from which on sizes differ.
// Taste: a smaller one tries to keep the largest parts more often, for less.
constexpr double kDifferentSizes = 0.3;

bool finite_triangle(const Mesh& mesh, const Triangle& t) {
    for (int corner = 0; corner < 3; ++corner) {
        const glm::vec3& p = mesh.positions[t[corner]];
        if (!std::isfinite(p.x + p.y + p.z))
            return false;
    }
    return true;
}

/// One number for each triangle: triangles that share an edge have the same.
std::vector<uint32_t> connected(const Mesh& mesh) {
    const std::vector<uint32_t> welded = weld(mesh);
    std::vector<uint32_t> parents(mesh.triangles.size());
    std::iota(parents.begin(), parents.end(), 0u);
    struct PartEdge {
        uint32_t end;  // the higher end
        uint32_t triangle;
    };
    std::vector<size_t> first(mesh.positions.size() + 2, 0);  // by the lower end
    std::vector<PartEdge> edges(3 * mesh.triangles.size());
    const auto each = [&](const auto& visit) {
        for (uint32_t i = 0; i < parents.size(); ++i) {
            for (int corner = 0; corner < 3; ++corner) {
                const uint32_t a = welded[mesh.triangles[i][corner]];
                const uint32_t b = welded[mesh.triangles[i][(corner + 1) % 3]];
                visit(std::min(a, b), PartEdge{std::max(a, b), i});
            }
        }
    };
    each([&](uint32_t low, const PartEdge&) { ++first[low + 2]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    each([&](uint32_t low, const PartEdge& edge) { edges[first[low + 1]++] = edge; });
    for (size_t low = 0; low < mesh.positions.size(); ++low) {
        const auto begin = edges.begin() + static_cast<std::ptrdiff_t>(first[low]);
        const auto end = edges.begin() + static_cast<std::ptrdiff_t>(first[low + 1]);
        std::sort(begin, end, [](const PartEdge& a, const PartEdge& b) { return a.end < b.end; });
        for (auto at = begin; at != end; ++at) {
            if (at != begin && at->end == std::prev(at)->end)
                join(parents, at->triangle, std::prev(at)->triangle);
        }
    }
    for (uint32_t i = 0; i < parents.size(); ++i)
        parents[i] = root_of(parents, i);
    return parents;
}

/// Replaces numbers by 0, 1, ... in their order; returns how many there are.
size_t renumber(std::vector<uint32_t>& numbers) {
    std::vector<uint32_t> known = numbers;
    known.erase(std::unique(known.begin(), known.end()), known.end());
    std::sort(known.begin(), known.end());
    known.erase(std::unique(known.begin(), known.end()), known.end());
    uint32_t last = 0;  // the next number is mostly the same
    for (uint32_t& number : numbers) {
        if (known[last] != number)
            last = static_cast<uint32_t>(std::lower_bound(known.begin(), known.end(), number) -
                                         known.begin());
        number = last;
    }
    return known.size();
}

/// The sums over a part while its triangles are visited.
struct PartStatistics {
    double area = 0;
    glm::dvec3 first{0.0};  // about the middle of the mesh's bound
    glm::dmat3 second{0.0};
    bool known = false;
    uint16_t slot = 0;  // the slot of its first triangle
    Hasher hash;
};

Crowd::CrowdPart part_of(const PartStatistics& found, const glm::dvec3& origin) {
    Crowd::CrowdPart part;
    part.area = found.area;
    const glm::dvec3 mean = found.area > 0 ? found.first / found.area : glm::dvec3(0.0);
    part.center = origin + mean;
    part.hash = found.hash.result();
    if (found.area > 0) {
        const SymmetricEigen eigen =
            eigen_symmetric(found.second / found.area - glm::outerProduct(mean, mean));
        part.axes = eigen.axes;
        part.slender = eigen.values.x > kSlender * kSlender * std::max(0.0, eigen.values.y);
    }
    return part;
}

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Orders a list so that every beginning of it is spread evenly: both halves of space take turns in
/// proportion, and so do their halves.
void spread(const std::vector<Crowd::CrowdPart>& parts, std::span<uint32_t> list, uint64_t seed) {
    if (list.size() < 2)
        return;
    Box3 box;
    for (const uint32_t part : list)
        box.add(parts[part].center);
    const int axis = box.longest_axis();
    const size_t half = list.size() / 2;
    const auto before = [&](uint32_t a, uint32_t b) {
        const double left = parts[a].center[axis];
        const double right = parts[b].center[axis];
        return left != right
                   ? left < right
                   : (parts[a].hash != parts[b].hash ? parts[a].hash < parts[b].hash : a < b);
    };
    std::nth_element(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(half), list.end(),
                     before);
    const std::span<uint32_t> low = list.first(half);
    const std::span<uint32_t> high = list.subspan(half);
    spread(parts, low, seed);
    spread(parts, high, seed);
    // The k-th of n stands at (k + start) / n, with a start by chance.
    const Hash chance = Hasher()
                            .value(seed)
                            .value(parts[low[0]].hash)
                            .value(parts[high[0]].hash)
                            .value(list.size())
                            .result();
    const double starts[2] = {static_cast<double>(chance & 0xffffu) / 0x10000,
                              static_cast<double>((chance >> 16u) & 0xffffu) / 0x10000};
    std::vector<uint32_t> merged;
    merged.reserve(list.size());
    size_t i = 0;
    size_t j = 0;
    while (i < low.size() || j < high.size()) {
        const double a = (static_cast<double>(i) + starts[0]) / static_cast<double>(low.size());
        const double b = (static_cast<double>(j) + starts[1]) / static_cast<double>(high.size());
        if (j == high.size() || (i < low.size() && a <= b))
            merged.push_back(low[i++]);
        else
            merged.push_back(high[j++]);
    }
    std::copy(merged.begin(), merged.end(), list.begin());
}

/// The transform that enlarges a kept part in its place.
Affine enlargement(const Crowd::CrowdPart& part, double growth) {
    Affine out;
    const double even = std::sqrt(growth);
    const glm::dvec3 along =
        part.slender ? glm::dvec3(1, growth, growth) : glm::dvec3(even, even, even);
    const glm::dmat3 scale(part.axes[0] * along.x, part.axes[1] * along.y, part.axes[2] * along.z);
    out.linear = scale * glm::transpose(part.axes);
    out.offset = part.center - out.linear * part.center;
    return out;
}

}  // namespace

bool Crowd::sizes_differ() const {
    double sum = 0;
    double squares = 0;
    for (const CrowdPart& part : parts) {
        sum += part.area;
        squares += part.area * part.area;
    }
    const auto count = static_cast<double>(parts.size());
    return count > 0 && squares * count > (1 + kDifferentSizes) * sum * sum;
}

Crowd find_crowd(const Mesh& mesh, std::span<const uint32_t> given) {
    Crowd out;
    if (mesh.triangles.size() < kFewestParts)
        return out;
    std::vector<uint32_t> numbers =
        given.empty() ? connected(mesh) : std::vector<uint32_t>(given.begin(), given.end());
    const glm::dvec3 origin = bound_of(mesh.positions).center;
    std::vector<PartStatistics> found(renumber(numbers));
    double all = 0;
    for (size_t i = 0; i < numbers.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        PartStatistics& part = found[numbers[i]];
        if (!part.known)
            part.slot = mesh.slot(i);
        part.known = true;
        if (!finite_triangle(mesh, t))
            continue;
        const double area = 0.5 * glm::length(area_vector(mesh, i));
        glm::dvec3 middle(0.0);
        for (int corner = 0; corner < 3; ++corner) {
            const glm::vec3& position = mesh.positions[t[corner]];
            part.hash.bytes(&position, sizeof position);
            const glm::dvec3 arm = glm::dvec3(position) - origin;
            middle += arm / 3.0;
            part.second += area / 12 * glm::outerProduct(arm, arm);
        }
        part.second += 0.75 * area * glm::outerProduct(middle, middle);
        part.first += area * middle;
        part.area += area;
        all += area;
    }
    struct PartKind {
        std::vector<double> areas;
        double area = 0;
        double largest = 0;  // the largest area that still belongs to it
        size_t parts = 0;
    };
    std::map<uint16_t, PartKind> kinds;
    for (const PartStatistics& part : found)
        kinds[part.slot].areas.push_back(part.area);
    for (auto& [slot, kind] : kinds)
        kind.largest = kLargestPart * median_of(kind.areas);
    const auto belongs = [&](const PartStatistics& part) {
        return part.area > 0 && part.area <= kinds.at(part.slot).largest;
    };
    for (const PartStatistics& part : found) {
        if (!belongs(part))
            continue;
        kinds[part.slot].area += part.area;
        ++kinds[part.slot].parts;
    }
    std::map<uint16_t, uint32_t> kind_of_slot;
    for (const auto& [slot, kind] : kinds) {
        if (given.empty() ? kind.parts < kFewestParts || kind.area < kLeastShare * all
                          : kind.parts < kFewestOfKind)
            continue;
        kind_of_slot.emplace(slot, static_cast<uint32_t>(out.slots.size()));
        out.slots.push_back(slot);
    }
    std::vector<uint32_t> new_numbers(found.size(), kNoPart);
    for (size_t i = 0; i < found.size(); ++i) {
        const PartStatistics& part = found[i];
        const auto kind = kind_of_slot.find(part.slot);
        if (kind == kind_of_slot.end() || !belongs(part))
            continue;
        new_numbers[i] = static_cast<uint32_t>(out.parts.size());
        out.parts.push_back(part_of(part, origin));
        out.parts.back().kind = kind->second;
    }
    if (out.parts.size() < kFewestParts)
        return {};
    out.part_of.assign(numbers.size(), kNoPart);
    for (size_t i = 0; i < numbers.size(); ++i) {
        const uint32_t part = new_numbers[numbers[i]];
        if (part == kNoPart || !finite_triangle(mesh, mesh.triangles[i]))
            continue;
        out.part_of[i] = part;
        ++out.triangles;
    }
    return out;
}

std::vector<uint32_t> prune_order(const Crowd& crowd, PruneOrder order, uint64_t seed) {
    std::vector<uint32_t> list(crowd.parts.size());
    std::iota(list.begin(), list.end(), 0u);
    spread(crowd.parts, list, seed);
    if (order == PruneOrder::Largest) {
        std::stable_sort(list.begin(), list.end(), [&](uint32_t a, uint32_t b) {
            return crowd.parts[a].area > crowd.parts[b].area;
        });
    }
    // The first of each kind come before all others, so that no color is ever gone.
    std::vector<uint8_t> seen(crowd.slots.size(), 0);
    std::vector<uint32_t> firsts;
    std::vector<uint32_t> others;
    for (const uint32_t part : list) {
        uint8_t& mark = seen[crowd.parts[part].kind];
        (mark == 0 ? firsts : others).push_back(part);
        mark = 1;
    }
    std::copy(others.begin(), others.end(), std::copy(firsts.begin(), firsts.end(), list.begin()));
    return list;
}

glm::dvec3 with_contrast(const glm::dvec3& color, const glm::dvec3& mean, double variance) {
    const double share = variance > 1 ? 1 / std::sqrt(variance) : 1;
    return mean + share * (color - mean);
}

PrunedMesh prune_crowd(const Mesh& mesh, const Crowd& crowd, std::span<const uint32_t> order,
                       size_t keep, std::span<const double> growth) {
    PrunedMesh out;
    keep = std::min(order.size(), std::max(keep, crowd.slots.size()));
    std::vector<uint8_t> kept(crowd.parts.size(), 0);
    for (const uint32_t part : order.first(keep))
        kept[part] = 1;
    double before = 0;
    double after = 0;
    for (size_t i = 0; i < kept.size(); ++i) {
        const Crowd::CrowdPart& part = crowd.parts[i];
        before += part.area * part.area;
        const double now = kept[i] != 0 ? growth[part.kind] * part.area : 0;
        after += now * now;
    }
    out.variance = before > 0 ? after / before : 1;

    std::vector<uint8_t> chosen(mesh.triangles.size(), 0);
    std::vector<uint32_t> parts;  // those of the chosen triangles
    for (size_t i = 0; i < chosen.size(); ++i) {
        if (crowd.part_of[i] == kNoPart || kept[crowd.part_of[i]] == 0)
            continue;
        chosen[i] = 1;
        parts.push_back(crowd.part_of[i]);
    }
    out.mesh = subset(mesh, chosen);
    std::vector<Affine> places(crowd.parts.size());
    std::vector<glm::dmat3> turns(crowd.parts.size());
    for (size_t i = 0; i < places.size(); ++i) {
        places[i] = enlargement(crowd.parts[i], growth[crowd.parts[i].kind]);
        turns[i] = glm::transpose(glm::inverse(places[i].linear));
    }
    // A vertex belongs to one part, unless the input shares it between parts that only touch there.
    Mesh& level = out.mesh;
    std::vector<uint32_t> owner(level.positions.size(), kNoPart);
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> copies;
    for (size_t i = 0; i < parts.size(); ++i) {
        out.kind_of.push_back(crowd.parts[parts[i]].kind);
        for (int corner = 0; corner < 3; ++corner) {
            uint32_t& vertex = level.triangles[i][corner];
            if (owner[vertex] == kNoPart)
                owner[vertex] = parts[i];
            if (owner[vertex] == parts[i])
                continue;
            const auto [at, fresh] = copies.try_emplace(
                {vertex, parts[i]}, static_cast<uint32_t>(level.positions.size()));
            if (fresh) {
                owner.push_back(parts[i]);
                level.positions.push_back(glm::vec3(level.positions[vertex]));
                if (!level.normals.empty())
                    level.normals.push_back(glm::vec3(level.normals[vertex]));
                if (!level.uvs.empty())
                    level.uvs.push_back(glm::vec2(level.uvs[vertex]));
                if (!level.colors.empty())
                    level.colors.push_back(glm::vec4(level.colors[vertex]));
            }
            vertex = at->second;
        }
    }
    glm::dvec3 mean(0.0);
    for (const glm::vec4& color : level.colors)
        mean += glm::dvec3(color) / static_cast<double>(level.colors.size());
    for (size_t v = 0; v < owner.size(); ++v) {
        if (owner[v] == kNoPart)
            continue;
        level.positions[v] = glm::vec3(places[owner[v]](glm::dvec3(level.positions[v])));
        if (!level.normals.empty()) {
            const glm::dvec3 normal = turns[owner[v]] * glm::dvec3(level.normals[v]);
            const double length = glm::length(normal);
            if (length > 0)
                level.normals[v] = glm::vec3(normal / length);
        }
        if (!level.colors.empty()) {
            const glm::dvec3 color = with_contrast(glm::dvec3(level.colors[v]), mean, out.variance);
            level.colors[v] = glm::vec4(glm::vec3(color), level.colors[v].w);
        }
    }
    return out;
}

}  // namespace lodestone::prune
