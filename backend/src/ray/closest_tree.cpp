// SPDX-License-Identifier: GPL-3.0-or-later
#include "ray/closest_tree.h"

#include "base/maths.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::ray {
namespace {

/// Bins in which a split is looked for.
/// Taste: a larger value finds slightly better trees in more time.
constexpr int kBins = 16;
/// Uneven splits after which nodes are split in the middle: the depth is bounded.
/// Taste: a larger value needs a larger kStack.
constexpr int kMostUneven = 40;
/// Nodes that wait to be visited.
/// Law: three a level, and fewer levels than kMostUneven / 2 + 16 at four children a node.
constexpr size_t kStack = 256;
/// Triangles that wait to be decided in double precision.
/// Taste: a larger value decides fewer triangles in crowds, for more memory on the stack.
constexpr size_t kCandidates = 32;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
// A distance in single precision is off by less than this share of itself and of the longest edge,
// but for needles.
// Taste: a larger value is safer than rounding asks for (6e-8 times the terms of a needle) and
// decides more triangles in double precision.
constexpr float kOff = 4e-4f;
/// Triangles with a smaller square of height over length are needles: the inside is not to be
/// relied on, but no farther from an edge than half of the height.
/// Taste: a larger value takes more triangles for needles.
constexpr float kNeedle = 1e-3f;
/// The same share for needles, whose edges are right to a few times as much.
/// Taste: as kOff.
constexpr float kOffNeedle = 4 * kOff;

template <typename Four>
Four lower(Four a, Four b) {
    return a < b ? a : b;
}

template <typename Four>
Four higher(Four a, Four b) {
    return a > b ? a : b;
}

/// A box around nothing yet.
template <typename Four>
struct GrowingBox {
    Four low = Four{} + kInfinity;
    Four high = Four{} - kInfinity;
    size_t count = 0;

    void add(Four other_low, Four other_high, size_t more) {
        low = lower(low, other_low);
        high = higher(high, other_high);
        count += more;
    }
    float half_area() const {
        const Four size = high - low;
        return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
    }
};

/// The axes that most of the surface is square to, when boxes along them are much smaller than
/// those along x, y, z: of things modelled straight and placed askew. Otherwise none.
std::optional<glm::dmat3> better_axes(const std::vector<glm::vec3>& positions,
                                      const std::vector<Triangle>& triangles) {
    // Boxes along the axes must be smaller by this factor.
    // Taste: a larger value turns the tree, which costs a copy of the positions, for less gain.
    constexpr double kWorthIt = 0.8;
    // Triangles, evenly chosen, that tell.
    // Taste: a larger value takes longer and tells the same of most meshes.
    constexpr size_t kMostTriangles = 4096;
    const size_t step = triangles.size() / kMostTriangles + 1;
    const auto each = [&](const auto& visit) {
        for (size_t i = 0; i < triangles.size(); i += step) {
            const Triangle& t = triangles[i];
            if (finite(positions[t.x]) && finite(positions[t.y]) && finite(positions[t.z]))
                visit(glm::dvec3(positions[t.x]), glm::dvec3(positions[t.y]),
                      glm::dvec3(positions[t.z]));
        }
    };
    glm::dmat3 normals(0.0);
    each([&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        const glm::dvec3 area = glm::cross(b - a, c - a);
        const double length = glm::length(area);
        if (length > 0)
            normals += glm::outerProduct(area, area / length);
    });
    const glm::dmat3 axes = glm::transpose(eigen_symmetric(normals).axes);
    const auto surface = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        const glm::dvec3 size = glm::max(glm::max(a, b), c) - glm::min(glm::min(a, b), c);
        return size.x * size.y + size.y * size.z + size.z * size.x;
    };
    double along = 0;
    double plain = 0;
    each([&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        plain += surface(a, b, c);
        along += surface(axes * a, axes * b, axes * c);
    });
    return along < kWorthIt * plain ? std::optional(axes) : std::nullopt;
}

}  // namespace

ClosestTree::ClosestTree(const std::vector<glm::vec3>& positions,
                         const std::vector<Triangle>& triangles, bool unlike)
    : axes_(better_axes(positions, triangles)) {
    if (!axes_) {
        make({positions, positions, triangles, unlike});
        return;
    }
    std::vector<glm::vec3> turned;
    turned.reserve(positions.size());
    for (const glm::vec3& position : positions)
        turned.emplace_back(*axes_ * glm::dvec3(position));
    make({positions, turned, triangles, unlike});
}

void ClosestTree::make(const TreeGeometry& given) {
    const std::vector<glm::vec3>& positions = given.turned;
    const std::vector<Triangle>& triangles = given.triangles;
    std::vector<TriangleReference> references;
    references.reserve(triangles.size());
    for (uint32_t i = 0; i < triangles.size(); ++i) {
        const glm::vec3& a = positions[triangles[i].x];
        const glm::vec3& b = positions[triangles[i].y];
        const glm::vec3& c = positions[triangles[i].z];
        if (!finite(a) || !finite(b) || !finite(c))
            continue;
        const auto four = [](const glm::vec3& v) { return Four{v.x, v.y, v.z, 0}; };
        references.push_back({lower(lower(four(a), four(b)), four(c)),
                              higher(higher(four(a), four(b)), four(c)), i});
    }
    empty_ = references.empty();
    if (empty_)
        return;
    leaves_.reserve(references.size() / 2 + 1);
    nodes_.reserve(references.size() / 4 + 1);
    root_ = add(given, references, {0, references.size(), 0});
}

int32_t ClosestTree::add(const TreeGeometry& given, std::vector<TriangleReference>& references,
                         ReferenceRange range) {
    if (range.end - range.begin <= kWidth)
        return add_leaf(given, references, range);
    std::array<ReferenceRange, kWidth> parts{range};
    int count = 1;
    while (count < kWidth) {
        const auto largest = std::max_element(parts.begin(), parts.begin() + count,
                                              [](const ReferenceRange& a, const ReferenceRange& b) {
                                                  return a.end - a.begin < b.end - b.begin;
                                              });
        if (largest->end - largest->begin <= kWidth)
            break;
        const std::optional<size_t> found = split(references, *largest);
        if (!found && !given.unlike) {
            largest->end = end_of_distinct(given, references, *largest);
            if (largest->end - largest->begin <= kWidth)
                continue;
        }
        const size_t middle = found.value_or(largest->begin + (largest->end - largest->begin) / 2);
        const int depth = largest->depth + 1;
        parts[static_cast<size_t>(count)] = {middle, largest->end, depth};
        *largest = {largest->begin, middle, depth};
        ++count;
    }
    const auto index = static_cast<int32_t>(nodes_.size());
    nodes_.emplace_back();
    WideNode node;
    for (int i = 0; i < kWidth; ++i) {
        GrowingBox<Four> box;
        int32_t child = 0;
        if (i < count) {
            const ReferenceRange& part = parts[static_cast<size_t>(i)];
            for (size_t k = part.begin; k < part.end; ++k)
                box.add(references[k].low, references[k].high, 1);
            child = add(given, references, part);
        }
        for (int axis = 0; axis < 3; ++axis) {
            node.low[static_cast<size_t>(axis)][i] = box.low[axis];
            node.high[static_cast<size_t>(axis)][i] = box.high[axis];
        }
        node.children[static_cast<size_t>(i)] = child;
    }
    nodes_[static_cast<size_t>(index)] = node;
    return index;
}

int32_t ClosestTree::add_leaf(const TreeGeometry& given,
                              const std::vector<TriangleReference>& references,
                              ReferenceRange range) {
    const std::vector<glm::vec3>& positions = given.turned;
    const std::vector<Triangle>& triangles = given.triangles;
    TriangleLeaf leaf;
    for (int i = 0; i < kWidth; ++i) {
        // A leaf with room shows its last triangle again.
        const size_t at = std::min(range.begin + static_cast<size_t>(i), range.end - 1);
        const uint32_t triangle = references[at].triangle;
        const glm::vec3& a = positions[triangles[triangle].x];
        const glm::vec3 ab = positions[triangles[triangle].y] - a;
        const glm::vec3 ac = positions[triangles[triangle].z] - a;
        const float square =
            std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(ac - ab, ac - ab)});
        const float length = std::sqrt(square);
        const float area = glm::length(glm::cross(ab, ac));  // twice
        const bool needle = !(area * area > kNeedle * square * square);
        const float height = length > 0 ? area / length : 0;
        for (int axis = 0; axis < 3; ++axis) {
            leaf.a[static_cast<size_t>(axis)][i] = a[axis];
            leaf.ab[static_cast<size_t>(axis)][i] = ab[axis];
            leaf.ac[static_cast<size_t>(axis)][i] = ac[axis];
        }
        leaf.slack[i] = needle ? kOffNeedle * length + 0.5f * height : kOff * length;
        leaf.triangles[static_cast<size_t>(i)] = triangle;
    }
    leaves_.push_back(leaf);
    return ~static_cast<int32_t>(leaves_.size() - 1);
}

/// Puts the references whose corners no lower triangle has to the front of the range, and returns
/// their end.
size_t ClosestTree::end_of_distinct(const TreeGeometry& given,
                                    std::vector<TriangleReference>& references,
                                    ReferenceRange range) {
    const auto corners = [&](const TriangleReference& reference) {
        const Triangle& t = given.triangles[reference.triangle];
        std::array<float, 9> out;
        for (int i = 0; i < 9; ++i)
            out[static_cast<size_t>(i)] = given.positions[t[i / 3]][i % 3];
        return out;
    };
    const auto begin = references.begin() + static_cast<ptrdiff_t>(range.begin);
    const auto end = references.begin() + static_cast<ptrdiff_t>(range.end);
    std::sort(begin, end, [&](const TriangleReference& a, const TriangleReference& b) {
        const std::array<float, 9> of_a = corners(a);
        const std::array<float, 9> of_b = corners(b);
        return of_a != of_b ? of_a < of_b : a.triangle < b.triangle;
    });
    const auto distinct =
        std::unique(begin, end, [&](const TriangleReference& a, const TriangleReference& b) {
            return corners(a) == corners(b);
        });
    return static_cast<size_t>(distinct - references.begin());
}

/// Splits a range; returns the first reference of the second half, or none where all have one
/// middle.
std::optional<size_t> ClosestTree::split(std::vector<TriangleReference>& references,
                                         ReferenceRange range) {
    const auto begin = references.begin() + static_cast<ptrdiff_t>(range.begin);
    const auto end = references.begin() + static_cast<ptrdiff_t>(range.end);
    const size_t half = range.begin + (range.end - range.begin) / 2;
    GrowingBox<Four> middles;  // twice as far out
    for (auto at = begin; at != end; ++at)
        middles.add(at->low + at->high, at->low + at->high, 1);
    const Four size = middles.high - middles.low;
    int axis = size[0] > size[1] ? 0 : 1;
    axis = size[2] > size[axis] ? 2 : axis;
    const float scale = kBins / size[axis];
    if (!std::isfinite(scale))  // one place but for rounding: a far outlier makes it so
        return std::nullopt;
    if (range.depth >= kMostUneven) {
        std::nth_element(begin, references.begin() + static_cast<ptrdiff_t>(half), end,
                         [axis](const TriangleReference& a, const TriangleReference& b) {
                             const float x = a.low[axis] + a.high[axis];
                             const float y = b.low[axis] + b.high[axis];
                             return x != y ? x < y : a.triangle < b.triangle;
                         });
        return half;
    }
    using Bin = GrowingBox<Four>;
    std::array<Bin, kBins> bins;
    const float low = middles.low[axis];
    const auto bin_of = [&](const TriangleReference& reference) {
        const float along = (reference.low[axis] + reference.high[axis] - low) * scale;
        return std::min(static_cast<int>(along), kBins - 1);
    };
    for (auto at = begin; at != end; ++at) {
        bins[static_cast<size_t>(bin_of(*at))].add(at->low, at->high, 1);
    }
    // The cost of a side is its surface times the leaves that it needs.
    const auto cost = [](const Bin& side) {
        const size_t leaves = (side.count + kWidth - 1) / kWidth;
        return side.half_area() * static_cast<float>(leaves);
    };
    std::array<float, kBins> above{};
    Bin side;
    for (int i = kBins - 1; i > 0; --i) {
        const Bin& bin = bins[static_cast<size_t>(i)];
        side.add(bin.low, bin.high, bin.count);
        above[static_cast<size_t>(i)] = side.count > 0 ? cost(side) : kInfinity;
    }
    side = Bin{};
    float best = kInfinity;
    int border = 0;
    for (int i = 1; i < kBins; ++i) {
        const Bin& bin = bins[static_cast<size_t>(i - 1)];
        side.add(bin.low, bin.high, bin.count);
        const float both = side.count > 0 ? cost(side) + above[static_cast<size_t>(i)] : kInfinity;
        if (both < best) {
            best = both;
            border = i;
        }
    }
    if (border == 0)
        return half;
    const auto middle = std::partition(
        begin, end, [&](const TriangleReference& reference) { return bin_of(reference) < border; });
    return range.begin + static_cast<size_t>(middle - begin);
}

ClosestTree::Four ClosestTree::square_distances(const TriangleLeaf& leaf, const glm::vec3& point) {
    const Four zero{};
    const Four one = zero + 1.0f;
    const Four tiny = zero + 1e-37f;
    const auto dot = [](const std::array<Four, 3>& a, const std::array<Four, 3>& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    const auto clamped = [&](Four value) {
        value = value > zero ? value : zero;
        return value < one ? value : one;
    };
    std::array<Four, 3> ap;
    std::array<Four, 3> bc;
    for (size_t axis = 0; axis < 3; ++axis) {
        ap[axis] = point[static_cast<int>(axis)] - leaf.a[axis];
        bc[axis] = leaf.ac[axis] - leaf.ab[axis];
    }
    const Four b_b = dot(leaf.ab, leaf.ab);
    const Four b_c = dot(leaf.ab, leaf.ac);
    const Four c_c = dot(leaf.ac, leaf.ac);
    const Four b_p = dot(leaf.ab, ap);
    const Four c_p = dot(leaf.ac, ap);
    const auto square_at = [&](Four u, Four v) {
        Four sum = zero;
        for (size_t axis = 0; axis < 3; ++axis) {
            const Four arm = ap[axis] - u * leaf.ab[axis] - v * leaf.ac[axis];
            sum += arm * arm;
        }
        return sum;
    };
    const auto least = [](Four a, Four b) { return a < b ? a : b; };
    // The distances to the three edges, and to the inside.
    Four best = square_at(clamped(b_p / (b_b > tiny ? b_b : tiny)), zero);
    best = least(best, square_at(zero, clamped(c_p / (c_c > tiny ? c_c : tiny))));
    const Four e_e = b_b + c_c - 2.0f * b_c;
    const Four t = clamped((c_p - b_p + b_b - b_c) / (e_e > tiny ? e_e : tiny));
    best = least(best, square_at(one - t, t));
    const Four area = b_b * c_c - b_c * b_c;
    const Four u = (c_c * b_p - b_c * c_p) / (area > tiny ? area : tiny);
    const Four v = (b_b * c_p - b_c * b_p) / (area > tiny ? area : tiny);
    const Four inside = square_at(u, v);
    const auto in = (u >= zero) & (v >= zero) & (u + v <= one) & (inside < best);
    return in ? inside : best;
}

void ClosestTree::search(ClosestSearch& search, double radius, double enough) const {
    if (empty_)
        return;
    struct PendingNode {
        float square;
        int32_t node;
    };
    std::array<PendingNode, kStack> stack;
    size_t size = 0;
    const glm::vec3 point(axes_ ? *axes_ * search.point : search.point);
    const float rounding = search.reach(0);
    // The distance within which anything matters, and its square, both rounded up.
    float reach = 0;
    float square = 0;
    const auto set_reach = [&](float to) {
        reach = to;
        square = reach * reach * (1 + 0x1p-20f);
    };
    set_reach(search.reach(radius));
    const auto enough_here = static_cast<float>(enough);
    // Triangles that may be the nearest, to be decided when all is seen.
    struct ClosestCandidate {
        float square;
        float slack;
        uint32_t triangle;
    };
    std::array<ClosestCandidate, kCandidates> candidates;
    size_t waiting = 0;
    const auto may_be_near = [&](float off_square, float slack) {
        const float far = (reach + rounding + slack) * (1 + kOff);
        return off_square <= far * far;
    };
    const auto decide = [&] {
        // The nearest one comes first: mostly no other is left then.
        for (size_t i = 1; i < waiting; ++i) {
            if (candidates[i].square < candidates[0].square)
                std::swap(candidates[0], candidates[i]);
        }
        for (size_t i = 0; i < waiting; ++i) {
            const ClosestCandidate& next = candidates[i];
            if (may_be_near(next.square, next.slack) && search.visit(next.triangle))
                set_reach(std::min(reach, search.reach(std::sqrt(search.square))));
        }
        waiting = 0;
    };
    stack[size++] = {0, root_};
    while (size > 0) {
        const PendingNode top = stack[--size];
        if (top.square > square)
            continue;
        if (reach <= enough_here)
            break;
        if (top.node < 0) {
            const int32_t index = ~top.node;
            const TriangleLeaf& leaf = leaves_[static_cast<size_t>(index)];
            const Four distances = square_distances(leaf, point);
            for (int i = 0; i < kWidth; ++i) {
                // The nearest triangle so far, like the one that was tried first, is known exactly.
                if (leaf.triangles[static_cast<size_t>(i)] == search.triangle ||
                    !may_be_near(distances[i], leaf.slack[i]))
                    continue;
                if (waiting == kCandidates)
                    decide();
                candidates[waiting++] = {distances[i], leaf.slack[i],
                                         leaf.triangles[static_cast<size_t>(i)]};
                if (search.choosy()) {  // its nearest point may not count
                    decide();
                    continue;
                }
                const float most =
                    (std::sqrt(distances[i]) + leaf.slack[i] + rounding) * (1 + 2 * kOff);
                if (most < reach)
                    set_reach(most);
            }
            continue;
        }
        const WideNode& node = nodes_[static_cast<size_t>(top.node)];
        Four squares{};
        for (size_t axis = 0; axis < 3; ++axis) {
            const float at = point[static_cast<int>(axis)];
            const Four below = node.low[axis] - at;
            const Four above = at - node.high[axis];
            Four out = below > above ? below : above;
            out = out > 0.0f ? out : Four{};
            squares += out * out;
        }
        // The nearest child comes to lie on top.
        const size_t first = size;
        for (int i = 0; i < kWidth; ++i) {
            if (!(squares[i] <= square) || !(squares[i] < kInfinity))
                continue;
            size_t at = size++;
            for (; at > first && stack[at - 1].square < squares[i]; --at)
                stack[at] = stack[at - 1];
            stack[at] = {squares[i], node.children[static_cast<size_t>(i)]};
        }
    }
    decide();
}

}  // namespace lodestone::ray
