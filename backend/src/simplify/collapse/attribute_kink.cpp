// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapse/attribute_kink.h"

#include "simplify/collapse/edge_neighbors.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::simplify {
namespace {

/// One of the triangles on an edge: the wedges of its ends and of the corner opposite, and where
/// that corner is.
struct KinkSide {
    uint32_t at_a, at_b, opposite;  // wedges
    double along;                   // from a (0) to b (1), of the foot on the edge
    double height;                  // above it, in the mesh's units

    KinkSide(const CollapseMesh& mesh, const SharedEdge& edge, uint32_t triangle) {
        const Triangle& t = mesh.triangles[triangle];
        const Triangle& w = mesh.wedges[triangle];
        const int a = corner_of(t, edge.a);
        const int b = corner_of(t, edge.b);
        at_a = w[a];
        at_b = w[b];
        opposite = w[3 - a - b];
        const glm::dvec3 way = mesh.points[edge.b] - mesh.points[edge.a];
        const glm::dvec3 arm = mesh.points[t[3 - a - b]] - mesh.points[edge.a];
        along = glm::dot(arm, way) / glm::dot(way, way);
        height = glm::length(arm - along * way);
    }
    /// The value at the opposite corner, less that of the edge beside it.
    template <typename Value>
    Value rise(const Value& value_a, const Value& value_b, const Value& value_opposite) const {
        const auto s = static_cast<typename Value::value_type>(along);
        return value_opposite - (1 - s) * value_a - s * value_b;
    }
};

/// Whether an edge and its triangles have an extent; `least` is the lower of both heights.
bool extends(double least, double length) {
    return length > 0 && least > 1e-9 * length;
}

}  // namespace

double color_kink(const CollapseMesh& mesh, const SharedEdge& edge) {
    const KinkSide sides[2] = {{mesh, edge, edge.t0}, {mesh, edge, edge.t1}};
    bool one = true;  // in color: no kink
    for (const KinkSide& side : sides) {
        for (const uint32_t wedge : {side.at_a, side.at_b, side.opposite})
            one = one && mesh.colors[wedge] == mesh.colors[sides[0].at_a];
    }
    const double least = std::min(sides[0].height, sides[1].height);
    if (one || !extends(least, glm::distance(mesh.points[edge.a], mesh.points[edge.b])))
        return 0;
    const auto color = [&](uint32_t wedge) {
        return glm::sqrt(glm::clamp(mesh.colors[wedge], 0.0f, 1.0f));
    };
    glm::vec4 kink(0.0f);
    for (const KinkSide& side : sides)
        kink += side.rise(color(side.at_a), color(side.at_b), color(side.opposite)) *
                static_cast<float>(least / side.height);
    kink = glm::abs(kink);
    return std::min(1.0, static_cast<double>(std::max({kink.x, kink.y, kink.z, kink.w})));
}

double texture_kink(const CollapseMesh& mesh, const SharedEdge& edge) {
    const KinkSide sides[2] = {{mesh, edge, edge.t0}, {mesh, edge, edge.t1}};
    const double length = glm::distance(mesh.points[edge.a], mesh.points[edge.b]);
    if (!extends(std::min(sides[0].height, sides[1].height), length))
        return 0;
    glm::dvec2 kink(0.0);
    double fastest = 0;
    for (const KinkSide& side : sides) {
        const glm::dvec2 a(mesh.uvs[side.at_a]);
        const glm::dvec2 b(mesh.uvs[side.at_b]);
        const glm::dvec2 across =
            side.rise(a, b, glm::dvec2(mesh.uvs[side.opposite])) / side.height;
        kink += across;
        fastest = std::max({fastest, glm::length(across), glm::length(b - a) / length});
    }
    return fastest > 0 ? std::min(1.0, glm::length(kink) / fastest) : 0;
}

}  // namespace lodestone::simplify
