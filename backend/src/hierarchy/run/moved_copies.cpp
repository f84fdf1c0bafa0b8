// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/run/moved_copies.h"

#include "measure/visible/surface_inertia.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace lodestone::hierarchy {
namespace {

// The largest distance of parts that are at the same place, over the radius.
// Taste: far below all that a pixel shows; a larger value takes groups for equal that differ.
constexpr double kSamePlace = 1e-4;

const std::vector<Placement>& placed_in(const Model& model, ObjectIndex group) {
    return model.objects[group].representations[0].assembly().placements;
}

/// The hash of all but where things are: groups with different hashes are different.
Hash kind_of(const Model& model, ObjectIndex group, const StandInSurroundings& around) {
    const Object& object = model.objects[group];
    Hasher hasher;
    hasher.value(object.role).value(object.made_of_parts).value(object.demand);
    hasher.value(around.uses[group]).value(around.environment[group]).value(around.hidden[group]);
    hasher.value(around.layers[group]).value(around.marked[group]).value(around.ground[group]);
    for (const Placement& at : placed_in(model, group))
        hasher.value(at.object)
            .value(at.hidden)
            .value(at.importance)
            .value(at.coarsest)
            .value(at.finest);
    return hasher.result();
}

Affine turned_about_z(double angle) {
    Affine out;
    out.linear[0] = {std::cos(angle), std::sin(angle), 0};
    out.linear[1] = {-std::sin(angle), std::cos(angle), 0};
    return out;
}

/// How far apart two places of one thing are.
double distance_between(const Affine& a, const Affine& b, const Bound& bound) {
    double square = 0;
    for (int column = 0; column < 3; ++column) {
        const glm::dvec3 off = a.linear[column] - b.linear[column];
        square += glm::dot(off, off);
    }
    return glm::length(a(bound.center) - b(bound.center)) + std::sqrt(square) * bound.radius;
}

/// How `group` is the original, moved, if `off` is small.
MovedCopy moved_from(const Model& model, ObjectIndex group, ObjectIndex original) {
    const std::vector<Placement>& own = placed_in(model, group);
    const std::vector<Placement>& others = placed_in(model, original);
    const auto bound_of = [&](size_t i) -> const Bound& {
        return model.objects[own[i].object].bound();
    };
    MovedCopy out{group, original, {}, 0};
    const glm::dmat3 turn = own[0].transform.linear * glm::inverse(others[0].transform.linear);
    out.place = turned_about_z(std::atan2(turn[0].y, turn[0].x));
    const glm::dvec3& center = bound_of(0).center;
    out.place.offset = own[0].transform(center) - out.place(others[0].transform(center));
    for (size_t i = 0; i < own.size(); ++i) {
        const double off =
            distance_between(own[i].transform, out.place * others[i].transform, bound_of(i));
        if (!std::isfinite(off)) {  // as where there is no inverse
            out.off = kInfinity;
            break;
        }
        out.off = std::max(out.off, off);
    }
    return out;
}

Payload moved_payload(const Representation& from, const Affine& place, const MeshSource& source) {
    const Kind kind = from.summary.kind;
    return moved(kind, kind == Kind::Mesh ? Payload(source(from)) : from.payload, place);
}

}  // namespace

std::vector<MovedCopy> moved_groups(const Model& model, const std::vector<ObjectIndex>& order,
                                    const StandInSurroundings& surroundings) {
    // The most groups that place the same things, each in its own way, that others are compared
    // with.
    // Taste: a larger number finds more copies, in time in proportion.
    constexpr size_t kMostKinds = 64;
    std::vector<MovedCopy> out;
    std::map<Hash, std::vector<ObjectIndex>> originals;
    for (const ObjectIndex group : order) {
        const Object& object = model.objects[group];
        if (!object.group() || placed_in(model, group).empty())
            continue;
        std::vector<ObjectIndex>& alike = originals[kind_of(model, group, surroundings)];
        const size_t before = out.size();
        for (size_t i = 0; i < alike.size() && out.size() == before; ++i) {
            const MovedCopy moved = moved_from(model, group, alike[i]);
            if (moved.off <= kSamePlace * object.bound().radius)
                out.push_back(moved);
        }
        if (out.size() == before && alike.size() < kMostKinds)
            alike.push_back(group);
    }
    return out;
}

void add_moved_copy(Model& model, const MovedCopy& moved, const MeshSource& source) {
    const Object& from = model.objects[moved.original];
    Object& to = model.objects[moved.index];
    if (from.attributes)
        to.attributes = measure::transformed(*from.attributes, moved.place);
    to.sources = from.sources;
    for (size_t i = 1; i < from.representations.size(); ++i) {
        Representation level = from.representations[i];
        level.payload = moved_payload(level, moved.place, source);
        level.summary.error += moved.off;
        level.summary.max_error += moved.off;
        summarize(level, model);
        to.representations.push_back(std::move(level));
    }
}

}  // namespace lodestone::hierarchy
