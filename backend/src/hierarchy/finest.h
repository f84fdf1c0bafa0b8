// SPDX-License-Identifier: GPL-3.0-or-later
// MeasuredFinest: what is known of the original that stand-ins are compared with, measured once.
#pragma once

#include "hierarchy/build_settings.h"
#include "measure/deviation/distinct_looks.h"
#include "measure/deviation/surface_deviation.h"
#include "measure/pictures/patch_light.h"
#include "measure/pictures/patch_shading.h"
#include "measure/pictures/view_distances.h"
#include "measure/visible/visible_attributes.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace lodestone::hierarchy {

/// The facts about the original that rays do not tell.
struct FinestOptions {
    uint64_t seed = 1;
    bool environment = false;
    /// It lies in thin layers (flat_layers.h): where it is flat its errors count as environment's.
    bool in_layers = false;
    /// It is a flattened group: rays say which of its triangles can be seen, and errors of meshes
    /// are those of half of the points, for they are far off beside those of a leaf.
    bool group = false;
    /// By how much the mesh itself is off, metres.
    double child_error = 0;
};

/// Made by measure_finest(), and the same ever after but for `looks`. All that proposers and
/// evaluators ask of the original is here.
struct MeasuredFinest {
    const Mesh& mesh;  // must last
    image::TexelCache& texels;
    FinestOptions options;
    uint64_t rays;                         // that measure its attributes: fewer of few triangles
    double size;                           // the radius of its bound, metres
    std::vector<Material> materials = {};  // by slot
    ray::SkinPtr skin = {};                // of these, which levels share
    /// The numbers of its looks. Evaluators of distance add those of candidates, which changes no
    /// number that is there.
    std::unique_ptr<measure::LookPalette> looks = {};
    std::unique_ptr<const measure::DeviationReference> reference = {};
    std::vector<measure::CastPoints> cast = {};  // what the first rays of the sampler found
    Attributes attributes = {};
    double opacity = 0;                                 // the mean
    bool glows = false;                                 // some of it is a lamp
    bool layered = false;                               // it is flat and lies in thin layers
    std::optional<measure::LightPatches> patches = {};  // none of environment
    std::unique_ptr<const measure::ShadedPatches> shading = {};  // none of a group
    std::unique_ptr<const measure::ViewDistances> views = {};

    /// Whether something solid may stand for it.
    bool solid() const;
    /// Whether some of it bends light: nothing but its own surface shows that.
    bool refracts() const { return skin->transmits(); }
    const ray::MeshScene& scene() const { return reference->scene(); }
    const measure::VisibleSampler& sampler() const { return reference->sampler(); }
    /// By triangle, 1 where it can be seen; empty for a leaf, or where it refracts.
    const std::vector<uint8_t>& seen_triangles() const { return reference->seen_triangles(); }

    /// Whether a mesh, which is the finest or what of it can be seen, is all of it.
    bool is_whole(const Mesh& seen) const { return seen.triangles.size() == scene().triangles(); }
    ray::SkinPtr skin_of(std::span<const Material> own) const;
    measure::VisibleOptions visible_options(uint64_t rays_of_it) const;

    /// The error of a stand-in that is off by that distance.
    double error_at(double distance) const;
    /// The largest distance of a stand-in whose error is at most that.
    double distance_for(double error) const;
};

/// Measures an original by rays. `mesh` and `texels` must last as long as the result.
MeasuredFinest measure_finest(const Mesh& mesh, std::span<const Material> materials,
                              image::TexelCache& texels, const BuildSettings& settings,
                              const FinestOptions& options, const Job& job);

}  // namespace lodestone::hierarchy
