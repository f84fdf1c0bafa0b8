// SPDX-License-Identifier: GPL-3.0-or-later
// Part pruning: the many small, similar parts of a mesh (leaves, pickets, people), and the order in
// which they are kept.
#pragma once

#include "model/mesh.h"

#include <span>
#include <vector>

namespace lodestone::prune {

inline constexpr uint32_t kNoPart = ~uint32_t{0};

/// The parts that come first when only some of them are kept.
enum class PruneOrder {
    Random,   // fixed by the parts and the seed, spread evenly over space
    Largest,  // by area
};

/// The parts of a mesh by kind. Parts of one kind show the same material slot first, and none is
/// more than eight times as large as their median. A kind of connected parts has at least 32 of
/// them and a quarter of the area, a kind of given parts 8. Triangles in no kind (a trunk,
/// branches) are the rest. Kept parts are nested: those at a smaller count are among those at any
/// larger one.
struct Crowd {
    struct CrowdPart {
        uint32_t kind = 0;
        double area = 0;
        glm::dvec3 center{0.0};
        glm::dmat3 axes{1.0};  // the axes of its vertices, longest first
        bool slender = false;  // longer than three times its width: only its width grows
        Hash hash = 0;         // the hash of its shape and its place
    };
    std::vector<uint32_t> part_of;  // by triangle; kNoPart: the rest
    std::vector<CrowdPart> parts;
    std::vector<uint16_t> slots;  // the slots of the kinds
    size_t triangles = 0;         // those of all parts

    bool empty() const { return parts.empty(); }
    /// Whether sizes differ so much that keeping the largest is worth a try.
    bool sizes_differ() const;
};

/// The connected parts (by edges; a welded corner connects nothing), or those `given`: one number
/// for each triangle. Empty when there are fewer than 32. Triangles that are not finite belong to
/// the rest.
Crowd find_crowd(const Mesh& mesh, std::span<const uint32_t> given = {});

/// All parts in the order in which they are kept.
std::vector<uint32_t> prune_order(const Crowd& crowd, PruneOrder order, uint64_t seed);

/// A crowd with only some of its parts.
struct PrunedMesh {
    Mesh mesh;                      // without the rest
    std::vector<uint32_t> kind_of;  // by triangle
    /// The variance of the light of a pixel that shows many parts, over that of the whole crowd.
    double variance = 1;
};

/// The parts that come first, as many as `keep` (at least one of each kind), enlarged so that their
/// area is `growth` times their own, one number for each kind. Colors by vertex keep the contrast
/// of a pixel that shows many parts: fewer and larger parts vary more, so their colors are drawn
/// towards their mean. source: Cook, Halstead, Planck, Ryu 2007; differs: slender parts grow in
/// width only, the order is stratified.
PrunedMesh prune_crowd(const Mesh& mesh, const Crowd& crowd, std::span<const uint32_t> order,
                       size_t keep, std::span<const double> growth);

/// The color by which parts with this variance are shown beside their mean (linear light).
glm::dvec3 with_contrast(const glm::dvec3& color, const glm::dvec3& mean, double variance);

}  // namespace lodestone::prune
