// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/lamp_levels.h"

#include "group/loose_surfaces.h"
#include "hierarchy/lamp_materials.h"
#include "simplify/simplify.h"

#include <algorithm>

namespace lodestone::hierarchy {
namespace {

// Where a larger share of the surface glows, the mesh is no thing with lamps but a lamp itself.
// Taste: a larger value keeps glowing things as lamps that are most of what is seen.
constexpr double kMostOfArea = 0.25;
// The triangles that a lamp keeps in a level.
// Law: an octahedron, the simplest ball.
constexpr size_t kTrianglesOfLamp = 8;
// All lamps together keep at most one triangle of a level in so many, unless they are a larger
// share of the mesh.
// Taste: a larger number leaves more triangles to all else and makes lamps coarser.
constexpr size_t kShareOfLamps = 3;
// The fewest triangles of a level besides its lamps.
// Law: a tetrahedron, the simplest closed surface.
constexpr size_t kFewestOfRest = 4;

struct LampSplit {
    Mesh lamps;
    Mesh rest;
    size_t parts = 0;  // of the lamps
};

/// No parts where the mesh has no lamps, or nothing else.
LampSplit lamps_in(const Mesh& mesh, std::span<const Material> materials) {
    LampSplit out;
    std::vector<uint8_t> glows(mesh.triangles.size(), 0);
    bool any = false;
    for (size_t i = 0; i < glows.size(); ++i) {
        const uint16_t slot = mesh.slot(i);
        glows[i] = slot < materials.size() && emits(materials[slot]) ? 1 : 0;
        any = any || glows[i] != 0;
    }
    if (!any)
        return out;
    const std::vector<uint32_t> part_of = group::loose_parts(mesh);
    std::vector<uint8_t> dark;  // by part: whether any of it is
    for (size_t i = 0; i < glows.size(); ++i) {
        dark.resize(std::max<size_t>(dark.size(), part_of[i] + size_t{1}), 0);
        if (glows[i] == 0)
            dark[part_of[i]] = 1;
    }
    std::vector<uint8_t> other(glows.size(), 0);
    double glowing = 0;
    double all = 0;
    for (size_t i = 0; i < glows.size(); ++i) {
        const double area = glm::length(area_vector(mesh, i));
        glows[i] = dark[part_of[i]] == 0 ? 1 : 0;
        other[i] = 1 - glows[i];
        glowing += glows[i] != 0 ? area : 0;
        all += area;
    }
    out.parts = static_cast<size_t>(std::count(dark.begin(), dark.end(), uint8_t{0}));
    if (out.parts == 0 || !(glowing < kMostOfArea * all)) {
        out.parts = 0;
        return out;
    }
    out.lamps = subset(mesh, glows);
    out.rest = subset(mesh, other);
    return out;
}

/// At each of `counts`, which fall; what cannot get so simple stays what it is.
std::vector<Mesh> levels_of(const Mesh& mesh, const std::vector<size_t>& counts, const Job& job) {
    std::vector<size_t> targets;
    for (const size_t count : counts) {
        if (count < mesh.triangles.size() && (targets.empty() || count < targets.back()))
            targets.push_back(count);
    }
    std::vector<Mesh> levels;
    if (!targets.empty())
        levels = simplify::simplify_chain(mesh, targets, {}, job);
    std::vector<Mesh> out;
    for (const size_t count : counts) {
        const Mesh* best = &mesh;
        for (const Mesh& level : levels) {
            if (best->triangles.size() > count)
                best = &level;
        }
        out.push_back(*best);
    }
    return out;
}

}  // namespace

bool has_lamps(const Mesh& mesh, std::span<const Material> materials) {
    return lamps_in(mesh, materials).parts > 0;
}

std::vector<Mesh> simplify_with_lamps(const Mesh& mesh, std::span<const Material> materials,
                                      std::span<const size_t> targets, const Job& job) {
    const LampSplit lamps = lamps_in(mesh, materials);
    if (lamps.parts == 0)
        return simplify::simplify_chain(mesh, targets, {}, job);
    std::vector<size_t> of_lamps;
    std::vector<size_t> of_rest;
    const size_t least = lamps.parts * kTrianglesOfLamp;
    for (const size_t target : targets) {
        const size_t even = target * lamps.lamps.triangles.size() / mesh.triangles.size();
        of_lamps.push_back(std::max({even, std::min(least, target / kShareOfLamps), size_t{1}}));
        of_rest.push_back(std::max(kFewestOfRest, target - std::min(target, of_lamps.back())));
    }
    std::vector<Mesh> levels = levels_of(lamps.rest, of_rest, job);
    const std::vector<Mesh> lit = levels_of(lamps.lamps, of_lamps, job);
    std::vector<Mesh> out;
    for (size_t i = 0; i < levels.size(); ++i) {
        if (!lit[i].empty())
            append(levels[i], lit[i], {});
        if (out.empty() || levels[i].triangles.size() < out.back().triangles.size())
            out.push_back(std::move(levels[i]));
    }
    return out;
}

}  // namespace lodestone::hierarchy
