// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/visible/surface_inertia.h"

#include <cmath>

namespace lodestone::measure {

glm::dmat3 SurfaceInertia::inertia() const {
    return glm::dmat3(trace(moments)) - moments;
}

SurfaceInertia inertia_of_mesh(const Mesh& mesh, bool both_sides_of_open) {
    SurfaceInertia out;
    if (mesh.empty())
        return out;
    // Coordinates are about a vertex of the mesh, so that a mesh far from the origin keeps its
    // digits.
    const glm::dvec3 origin(mesh.positions[mesh.triangles[0].x]);
    glm::dvec3 first(0.0);
    glm::dmat3 second(0.0);
    for (const Triangle& t : mesh.triangles) {
        const glm::dvec3 a = glm::dvec3(mesh.positions[t.x]) - origin;
        const glm::dvec3 b = glm::dvec3(mesh.positions[t.y]) - origin;
        const glm::dvec3 c = glm::dvec3(mesh.positions[t.z]) - origin;
        const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
        if (!(area > 0) || !std::isfinite(area))
            continue;
        const glm::dvec3 middle = (a + b + c) / 3.0;
        out.area += area;
        first += area * middle;
        second +=
            area / 12 *
                (glm::outerProduct(a, a) + glm::outerProduct(b, b) + glm::outerProduct(c, c)) +
            0.75 * area * glm::outerProduct(middle, middle);
    }
    if (out.empty())
        return out;
    const glm::dvec3 mean = first / out.area;
    out.center = origin + mean;
    out.moments = second - out.area * glm::outerProduct(mean, mean);
    if (both_sides_of_open && !closed(mesh)) {
        out.area *= 2;
        out.moments *= 2.0;
    }
    return out;
}

SurfaceInertia combined(const SurfaceInertia& a, const SurfaceInertia& b) {
    if (a.empty())
        return b;
    if (b.empty())
        return a;
    SurfaceInertia out;
    out.area = a.area + b.area;
    const glm::dvec3 arm = b.center - a.center;
    out.center = a.center + (b.area / out.area) * arm;
    out.moments =
        a.moments + b.moments + (a.area * b.area / out.area) * glm::outerProduct(arm, arm);
    return out;
}

namespace {

/// The square of the transform's scale. Throws as transformed() does.
double square_scale(const Affine& similarity) {
    const glm::dmat3& linear = similarity.linear;
    const glm::dmat3 square = glm::transpose(linear) * linear;
    const double scale = trace(square) / 3;  // s^2
    bool similar = similarity.finite() && scale > 0;
    for (int i = 0; i < 3 && similar; ++i) {
        for (int j = 0; j < 3; ++j)
            similar = similar && std::abs(square[i][j] - (i == j ? scale : 0)) <= 1e-6 * scale;
    }
    if (!similar)
        fail(Status::InvalidArgument,
             "surface inertia does not follow a transform that is not a rotation, a uniform scale "
             "and a translation");
    return scale;
}

}  // namespace

SurfaceInertia transformed(const SurfaceInertia& inertia, const Affine& similarity) {
    const double scale = square_scale(similarity);
    const glm::dmat3& linear = similarity.linear;
    SurfaceInertia out;
    out.area = inertia.area * scale;
    out.center = similarity(inertia.center);
    out.moments = scale * (linear * inertia.moments * glm::transpose(linear));
    return out;
}

Attributes transformed(const Attributes& attributes, const Affine& similarity) {
    const double scale = square_scale(similarity);
    const glm::dmat3& linear = similarity.linear;
    Attributes out = attributes;
    out.visible_area *= scale;
    out.surface_area *= scale;
    out.centroid = similarity(attributes.centroid);
    out.moments = scale * (linear * attributes.moments * glm::transpose(linear));
    out.axes = (1 / std::sqrt(scale)) * (linear * attributes.axes);
    if (glm::determinant(out.axes) < 0)
        out.axes[2] = -out.axes[2];
    return out;
}

SymmetricEigen principal_variances(const SurfaceInertia& inertia) {
    SymmetricEigen out;
    const double size = trace(inertia.moments);
    if (inertia.empty() || !(size > 0))
        return out;
    // Moments are normalized first: fourth powers of tiny lengths would vanish in the solver's
    // squares.
    out = eigen_symmetric(inertia.moments / size);
    out.values = glm::max(out.values, glm::dvec3(0.0)) * (size / inertia.area);
    return out;
}

}  // namespace lodestone::measure
