// SPDX-License-Identifier: GPL-3.0-or-later
// Representation writer: one representation as the text of one include file.
#pragma once

#include "base/job.h"
#include "model/model.h"
#include "povray_export/lamp/lit_surroundings.h"
#include "povray_export/lamp/sky_occlusion.h"
#include "povray_export/mesh/detail_bands.h"
#include "povray_export/mesh/mask_outlines.h"
#include "povray_export/mesh/shown_triangles.h"
#include "povray_export/texture/picture_writer.h"

#include <optional>
#include <string>

namespace lodestone::povray {

/// The choices for an include file.
struct RepresentationOptions {
    bool textures = true;  // false: the occurrence brings its texture
    bool uvs = true;       // texture coordinates, where a texture uses them
    /// The largest size of a texel of its pictures: 2^texel metres, in the representation's own
    /// frame.
    std::optional<int> texel = {};
    /// The metres, outline_error() in that frame, by which the outline of a mask may be off where
    /// that is more than a texel.
    std::optional<int> outline = {};
    /// By how much that is more at parts of a mesh; null: the same everywhere.
    DetailBandsPtr bands = {};
    /// The triangles, 2^most_cut, that its masks may become together; none: as many as pay.
    std::optional<int> most_cut = {};
    /// Outlines of crowds of leaves may be coarser than that, where they would have too many corners.
    bool coarse_crowds = true;
    ShownTrianglesPtr shown = {};    // of a mesh; null: all of it
    SkyLightPtr sky = {};            // the sky's light on it; null: all of it
    light::LightAround around = {};  // lit surfaces around, which gloss and rough metal show
    /// True: lamps of groups light it, for which POV-Ray casts shadow rays anew for each texture that
    /// a point has. So it has one where it can: without a layer of gloss, and with one share of the
    /// sky a triangle.
    bool few_textures = false;
    /// True: nothing but shadows of it is seen. So what lets no light through has no look.
    bool only_shadows = false;
};

/// The metres of a step of `outline`: two steps are twice as many.
double outline_error(int outline);
/// The largest step that is not more than `metres`.
int outline_step(double metres);

/// A line at the beginning of the text of a mesh with bumps or normals that are not shown, because
/// they lie on more planes than textures are written for.
inline constexpr const char* kBumpsLeftOut = "// bumps left out\n";

/// The beginning of such a line that tells how many clear surfaces a ray meets in a mesh, where these
/// are many.
inline constexpr const char* kClearLayers = "// clear layers ";

/// The hash of the file's content: of what is drawn, the options and the version of this writer.
Hash file_hash(const Representation& representation, const RepresentationOptions& options);

/// The identifier of a file: "LDS_R_" and 16 hexadecimal digits.
std::string identifier_of(Hash file);

/// The text `#declare <identifier> = mesh2{...}`, `box{...}` or `sphere{...}`; "" when nothing of
/// it can be seen (no triangle with an area, a primitive without volume). Before it stand the
/// declarations of the pictures that `pictures` (a new one) is given. Throws Error(Internal) for a
/// non-finite coordinate or a picture that is not resident, Error(InvalidArgument) for a bad index.
/// Masks are cut out along `outlines`, those of the whole export. cost: 0.1-0.2 us a triangle. It
/// may be called from any thread on a const model.
std::string representation_text(const Model& model, const Representation& representation,
                                const std::string& identifier, const RepresentationOptions& options,
                                PictureWriter& pictures, MaskOutlines& outlines, const Job& job);

}  // namespace lodestone::povray
