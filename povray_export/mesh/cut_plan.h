// SPDX-License-Identifier: GPL-3.0-or-later
// Cut plan: which triangles of a mesh show masks, and by which outlines these are cut out.
#pragma once

#include "povray_export/mesh/mesh_cutting.h"

#include <map>
#include <span>

namespace lodestone::povray {

/// The triangles of a slot that are seen about as finely, and how they are cut.
struct CutBand {
    std::vector<uint32_t> triangles;
    double tolerance = 0;     // in texels; below 1 counts as 1
    double pictures = 0;      // that the triangles together show
    size_t most = 0;          // triangles that it may become
    size_t expected = 0;      // triangles that it becomes, about
    size_t hull_corners = 0;  // corners of what it may be trimmed by
    MaskOutlinePtr outline;
    bool opaque = false;  // what is left has no alpha
    double joined = 0;    // texels: of a triangle that is no wider one piece is left
};

/// How a slot's mask is cut.
struct CutSlot {
    const Material* material = nullptr;
    size_t all = 0;                   // triangles, those that are not shown too
    std::vector<uint32_t> triangles;  // that are shown
    std::vector<uint32_t> doubles;    // the other sides of some of them, which are left out
    image::SeenTexels seen;           // by all of them
    std::optional<double> cutoff;
    bool crowd = false;    // of leaves, none of which matters
    bool full = false;     // nothing of it is clear: it is opaque without any cut
    bool painted = false;  // colors of vertices make some of it clear
    double pictures = 0;   // that all triangles together show
    std::vector<CutBand> bands;
};

/// The slots of a mesh whose masks may be cut, by the number of the slot.
class CutPlan {
public:
    CutPlan(const Model& model, const Representation& representation,
            const RepresentationOptions& options, MaskOutlines& outlines, const Job& job)
        : model_(model),
          representation_(representation),
          options_(options),
          mesh_(representation.mesh()),
          outlines_(outlines),
          job_(job) {}

    /// Finds slots without their outlines. Throws Error(InvalidArgument) for a material out of
    /// range.
    void find_slots();
    /// Finds the outlines, and leaves out slots of which nothing is to be cut. Throws
    /// Error(BadFile), Error(Cancelled).
    void find_outlines();
    std::map<uint16_t, CutSlot>& slots() { return slots_; }

    /// Whether no mask is outlined more coarsely than by its texels, nor would be in a crowd.
    bool by_texel();
    /// The corners of a triangle in the picture; false where one is beyond all sense.
    bool place(const Texture& texture, uint32_t triangle, glm::dvec2 (&at)[3]) const;
    /// Gives a band of a crowd an outline of fewer corners. False: there is none.
    bool coarsen(const CutSlot& slot, CutBand& band) const;

private:
    const Material* material_of(uint16_t slot) const;
    void collect_slots();
    std::vector<CutBand> bands_of(const CutSlot& slot) const;
    double tolerance_of(const Material& material, uint32_t triangle) const;
    bool painted_clear(const CutSlot& slot) const;
    bool may_be_crowd(const CutSlot& slot) const;
    MaskOutlinePtr outline_that_fits(const ShownMask& mask, bool crowd) const;
    bool find_outlines_of(CutSlot& slot) const;
    void find_outline(const CutSlot& slot, bool mask, CutBand& band) const;

    const Model& model_;
    const Representation& representation_;
    const RepresentationOptions& options_;
    const Mesh& mesh_;
    MaskOutlines& outlines_;
    const Job& job_;
    std::map<uint16_t, CutSlot> slots_;
    double layers_ = 0;
};

}  // namespace lodestone::povray
