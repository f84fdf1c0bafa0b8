// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh cutting: triangles whose alpha is a mask become what of them is inside the mask.
#pragma once

#include "base/job.h"
#include "model/model.h"
#include "povray_export/mesh/mask_outlines.h"
#include "povray_export/scene/representation_writer.h"

#include <vector>

namespace lodestone::povray {

/// A mesh with cut-out masks, as far as it is shown. What is not cut keeps its order and its
/// vertices.
struct CutMesh {
    bool any = false;  // false: nothing was cut or left out, and the rest is empty
    Mesh mesh;
    std::vector<uint32_t> sources;  // the triangle that each triangle is of
    std::vector<uint8_t> opaque;    // by slot, 1: what is left has no alpha
};

/// The mesh of a representation, as far as it is `shown`, with the masks among its materials cut
/// out: those whose alpha is a mask where the mesh shows it (MaskCount::is_mask()), those that are
/// clipped by a cutoff, and blends of which a ray meets more than POV-Ray bears. Positions, normals,
/// texture coordinates and colors of new corners are interpolated. Normals of what is cut that are
/// bent by their neighbors differ from the face's by 15 degrees at most: POV-Ray lights a leaf that
/// is seen flatter than that from its other side. Where they are no mask, painted clear, or would
/// become more triangles than pay, slots keep their texture and lose what is clear around it. They
/// stay as they are where they refract, are mixed, or show what lies beside a picture that ends
/// there.
/// Throws Error(InvalidArgument) for a material out of range, Error(BadFile), Error(Cancelled).
CutMesh cut_masks(const Model& model, const Representation& representation,
                  const RepresentationOptions& options, MaskOutlines& outlines, const Job& job);

/// The size of the result of cut_masks(), as far as it can be told before cutting.
struct CutForecast {
    bool by_outline = false;  // `outline` of the options matters: some mask is cut by it
    uint64_t triangles = 0;   // about what all masks become, or are trimmed to
};
/// Throws as cut_masks().
CutForecast cut_forecast(const Model& model, const Representation& representation,
                         const RepresentationOptions& options, MaskOutlines& outlines,
                         const Job& job);

/// Whether no mask is outlined more coarsely than by its texels: then a smaller `outline` of the
/// options changes nothing.
bool outlined_by_texel(const Model& model, const Representation& representation,
                       const RepresentationOptions& options, MaskOutlines& outlines,
                       const Job& job);

/// Whether a material's alpha may be a mask, by its fields alone.
bool may_be_mask(const Material& material);

}  // namespace lodestone::povray
