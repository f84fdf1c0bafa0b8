// SPDX-License-Identifier: GPL-3.0-or-later
// Wedge fit: normals and texture coordinates by which a simplified mesh, as a whole, looks like its
// original.
#pragma once

#include "simplify/fit/fit_samples.h"

namespace lodestone::simplify {

/// Wedges of one vertex whose normals agree better than this are one on both sides of a seam.
/// Law: 1 degree (see make_wedges), whose cosine is 0.99985.
inline constexpr float kOneWedge = 0.99985f;

/// The original's normal (unit) on the triangle that a sample was taken from, the mean of its
/// corners'; zero where it has none.
glm::vec3 normal_at(const Mesh& source, const FitSample& sample);

/// Replaces the normals of wedges that samples tell about by those whose blends over the triangles
/// have the least mean square difference from the original's (`source`). A wedge was carried as the
/// normal of one point; what lies around that point, rough or curved, is in a mean over samples.
/// Wedges of one vertex that were alike (seams of texture coordinates) stay alike. `mesh` must be
/// compact, `adjacency` its own, `samples` taken from its surface.
void fit_wedge_normals(CollapseMesh& mesh, const Mesh& source, const Adjacency& adjacency,
                       const FitSamples& samples);

/// The same for texture coordinates: a wedge carries those of where its vertex was before that was
/// fitted, and between wedges a stretched texture is not linear. Samples of other UV islands tell
/// nothing.
void fit_wedge_uvs(FitPlaces& places, const FitSamples& samples);

}  // namespace lodestone::simplify
