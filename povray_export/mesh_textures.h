// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh textures: which texture every corner of a mesh's triangles shows.
#pragma once

#include "base/job.h"
#include "model/model.h"
#include "povray_export/texture_writer.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace lodestone::povray {

/// Materials of slots, times the colors of vertices where a material uses them: a texture for every
/// distinct color. More than kMost colors are rounded, in display encoding, as little as it takes;
/// rounding by 2/255 keeps a difference nobody sees.
class MeshTextures {
public:
    static constexpr size_t kMost = 4096;

    /// Equal looks share one text. Throws Error(InvalidArgument) for a material out of range.
    MeshTextures(const Model& model, const Representation& representation, bool uvs,
                 PictureWriter& pictures, const Job& job);

    const std::vector<std::string>& texts() const { return texts_; }
    bool uses_uvs() const { return uses_uvs_; }
    /// Of what light goes through (the largest of the slots'); 0: nothing.
    double refraction() const { return refraction_; }

    bool per_corner() const { return !corners_.empty(); }
    size_t of(size_t triangle, int corner) const;

private:
    struct Slot {
        Material material;
        Surface surface;
        bool colored = false;
        size_t text = 0;  // where it is not colored
    };

    void find_slots(const Model& model, const Representation& representation, bool uvs);
    void find_ranges();
    void color_corners(PictureWriter& pictures);
    size_t add(const Slot& slot, PictureWriter& pictures);
    void breathe(size_t i) const;

    const Mesh& mesh_;
    const Job& job_;
    std::vector<Slot> slots_;
    std::vector<uint16_t> slot_at_;  // by slot of the mesh: where in slots_
    std::unordered_map<std::string, size_t> known_;
    std::vector<std::string> texts_;
    std::vector<uint32_t> corners_;  // 3 a triangle
    bool uses_uvs_ = false;
    double refraction_ = 0;
};

}  // namespace lodestone::povray
