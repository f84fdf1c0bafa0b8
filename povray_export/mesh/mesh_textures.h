// SPDX-License-Identifier: GPL-3.0-or-later
// MeshTextures: the texture that every corner of a mesh's triangles shows.
#pragma once

#include "base/job.h"
#include "model/model.h"
#include "povray_export/mesh/mesh_cutting.h"
#include "povray_export/scene/representation_writer.h"
#include "povray_export/texture/texture_writer.h"

#include <string>
#include <unordered_map>
#include <vector>

namespace lodestone::povray {

/// The materials of slots, times the colors of vertices where a material uses them: a texture for
/// every distinct color. More than kMost colors are rounded, in display encoding, as little as it
/// takes; rounding by 2/255 keeps a difference nobody sees. Bumps need a texture for every plane,
/// and corners that see different shares of the sky one for every grade, and for every hue of an
/// uneven one, which are as coarse as it takes.
class MeshTextures {
public:
    /// The most textures of one mesh.
    /// Taste: a larger value rounds colors less, for memory and parsing of each texture.
    static constexpr size_t kMost = 4096;
    /// The most planes of a bumped material.
    /// Taste: a larger value shows bumps on surfaces of more faces, for a texture each.
    static constexpr size_t kMostPlanes = 64;

    /// The textures of a representation's mesh, or of what is left of it where `cut` has any.
    /// Triangles and corners are numbered as in what is left. Equal looks share one text. Throws
    /// Error(InvalidArgument) for a material out of range.
    MeshTextures(const Model& model, const Representation& representation, const CutMesh& cut,
                 const RepresentationOptions& options, PictureWriter& pictures, const Job& job);

    /// The texts of the textures, by number.
    const std::vector<std::string>& texts() const { return texts_; }
    bool uses_uvs() const { return uses_uvs_; }
    /// Whether corners' normals are seen.
    bool uses_normals() const { return uses_normals_; }
    /// The index of refraction of what light goes through (the largest of the slots'); 0: nothing.
    double refraction() const { return refraction_; }

    /// Whether the triangle refracts.
    bool is_glass(size_t triangle) const;
    /// Whether some of the mesh is transparent, but bends no light, though other triangles do.
    bool is_clear_beside_glass() const;

    /// Whether some bumps are not shown: their surface has more than kMostPlanes planes.
    bool bumps_left_out() const { return bumps_left_out_; }

    /// The number of the texture of a triangle's corner.
    size_t of(size_t triangle, int corner) const;
    /// Whether corners of one triangle may differ; false: all corners of a triangle show the same.
    bool differ_in_triangles() const { return !corners_.empty(); }
    /// Whether any triangle shows bumps.
    bool bumped() const;

private:
    struct TexturedSlot {
        Material material;
        TexturedSurface surface;
        bool colored = false;
        bool bumped = false;
        bool even_sky = false;       // true: a grade of the sky's light for each triangle
        std::vector<Affine> planes;  // to_uv of its flat parts, where it is bumped
        size_t text = 0;             // where it is neither
    };

    void find_slots(const Model& model, const Representation& representation,
                    const RepresentationOptions& options);
    void find_ranges();
    void find_texels(double metres);
    void find_planes();
    bool plane_of(size_t triangle, TexturedSlot& slot, uint8_t& plane) const;
    std::vector<uint64_t> color_keys(glm::dvec3& hue) const;
    size_t distinct_looks(const std::vector<uint64_t>& keys, uint64_t step) const;
    /// The sky's light on a corner, in the steps for which textures are written.
    struct SkyGrade {
        uint8_t share = kSkyGrades - 1;
        int8_t red = 0;   // of the tint
        int8_t blue = 0;  // of the tint
    };
    SkyGrade sky_grade(size_t triangle, int corner) const;
    void find_tint_step();
    void find_corners(PictureWriter& pictures);
    size_t add(const TexturedSlot& slot, PictureWriter& pictures);
    void check_job_sometimes(size_t i) const;

    const Mesh& mesh_;
    const CutMesh& cut_;
    const Mesh& shown_;  // what is left of it
    const Job& job_;
    SkyLightPtr sky_;
    light::LightAround around_;
    int tint_step_ = 1;  // the steps of tints that count as one
    std::vector<TexturedSlot> slots_;
    std::vector<uint16_t> slot_at_;  // place in slots_, by slot of the mesh
    std::unordered_map<std::string, size_t> known_;
    std::vector<std::string> texts_;
    // By triangle of the whole mesh, of its slot's planes; kMostPlanes: no plane.
    std::vector<uint8_t> plane_of_;
    std::vector<uint32_t> corners_;  // 3 a triangle that is left; empty: the slots' texts
    bool uses_uvs_ = false;
    bool uses_normals_ = true;
    bool bumps_left_out_ = false;
    double refraction_ = 0;
};

}  // namespace lodestone::povray
