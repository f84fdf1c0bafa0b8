// SPDX-License-Identifier: GPL-3.0-or-later
// Scene writer: a fixed cut as a folder that POV-Ray 3.7 renders.
#pragma once

#include "base/job.h"
#include "choose/ray_class/ray_cut.h"
#include "model/model.h"
#include "povray_export/scene/shading.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>

namespace lodestone::povray {

/// The choices of an export.
struct ExportOptions {
    std::filesystem::path folder;  // made when missing; its path may hold any characters
    Antialiasing antialiasing = Antialiasing::Final;
    Shading shading;
    bool false_color = false;  // flat colors by kind and LOD number (color_of), no lights
    /// The linear color of each chosen occurrence instead, in the order of cut.chosen; empty:
    /// color_of().
    std::vector<glm::dvec3> colors{};
    // The scene has no Environment objects (nor all below them, nor stand-ins for groups that hold
    // them), lights and world, and a transparent film: the picture's alpha says which pixels are
    // covered.
    bool covered_only = false;
    /// Whether it is a picture alone: what moves in an animation is lit by the sky as what rests, and
    /// what is opaque on the side that is seen.
    bool still = false;
    /// The error up to which lights are approximated, in pixels, in place of the view's Pixel
    /// Error; 0: all lights as they are.
    std::optional<double> light_error;
    /// The representations that classes of rays meet in place of parts of the cut, by its nodes;
    /// not in false colors, nor where only covered pixels count.
    std::span<const choose::RayCut> rays{};
    /// The folder that keeps what was found of the sky's light; empty: `folder`.
    std::filesystem::path bakes{};
    /// Makes the finest level of everything resident, where the sky's light must be found.
    std::function<void()> load_finest{};
    /// The bytes of POV-Ray's memory that were asked for; 0: no limit. The cut is within them, and
    /// so are the masks that are cut out, but for an eighth.
    uint64_t budget = 0;
    /// The pixels that are drawn around a border, for a filter that looks beyond it.
    int margin = 0;
    /// Texture coordinates are written where a texture uses them; false: textures are their means.
    bool uvs = true;
};

/// The result of an export.
struct ExportReport {
    uint64_t bytes = 0;       // bytes of all files of this scene
    uint64_t text_bytes = 0;  // of these, those of texts: meshes and scene.pov
    uint64_t texels = 0;      // of all its pictures
    double covered = 1;       // the share of the picture where anything is seen, about
    uint64_t files = 0;       // files of this scene, found again or written
    uint64_t written = 0;     // files not found again
    uint64_t representations = 0;
    uint64_t occurrences = 0;     // objects in the scene
    uint64_t left_out = 0;        // chosen things that the picture neither shows nor has shadows of
    uint64_t left_out_bytes = 0;  // of the cut's in POV-Ray, for these and for parts of others
    uint64_t unseen = 0;          // objects that the camera does not see, but some other rays
    uint64_t lamps = 0;           // lights but suns
    double lights_each = 0;   // lamps, and lights for several, that light a seen point, in the mean
    double shadow_rays = 0;   // to suns and lamps from a seen point, in the mean, about
    double lamp_rays = 0;     // of these, those to lamps
    uint64_t sky_lights = 0;  // of these, one each to the lights that stand for the sky's image
    uint64_t soft_lamps = 0;  // lamps, and lights for several, whose shadows are soft anywhere
    uint64_t sky_copies = 0;  // representations more, for copies under other parts of the sky
    uint64_t cut_triangles = 0;  // about what masks that are cut out become
    double cpu_s = 0;            // of the whole process while it was written
};

/// Writes scene.pov, scene.ini, r/<16 hex>.inc, one for every distinct representation, and the
/// pictures they show as i/<16 hex>.png or .jpg; files that are there already are used as they are,
/// for their name is their content. The same input gives the same bytes. Occurrences that cannot be
/// drawn (flattened to a line, too small, not finite) are left out with a problem each; those
/// flattened to a sheet get a thickness of 1/100000. `view` may be another one than the cut was
/// made for: an overview of the parts that another camera's picture uses. Throws
/// Error(InvalidArgument) for a view that cannot be a picture, or colors that are not as many as
/// the chosen occurrences, Error(Io) naming the file, Error(Cancelled). cost: 0.1-0.2 s CPU a
/// million triangles written.
ExportReport export_scene(const Model& model, const choose::Cut& cut, const View& view,
                          const ExportOptions& options, Problems& problems, const Job& job = {});

}  // namespace lodestone::povray
