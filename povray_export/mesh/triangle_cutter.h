// SPDX-License-Identifier: GPL-3.0-or-later
// Triangle cutter: what of a triangle is inside an outline that its picture repeats.
#pragma once

#include "povray_export/mesh/mask_outlines.h"

#include <glm/vec3.hpp>

#include <vector>

namespace lodestone::povray {

enum class CutOutcome : uint8_t {
    Pieces,   // these, which may be none
    Whole,    // all of it
    TooMany,  // more pieces than asked for
};

/// The pieces of a triangle that are left: corners by the weights of its three corners.
struct CutTriangle {
    CutOutcome outcome = CutOutcome::Pieces;
    std::vector<glm::dvec3> corners;
    std::vector<glm::uvec3> triangles;
};

/// Flags what a triangle, given by picture coordinates, shows of the texels of a texture. False
/// where it shows what is beside a picture that cannot be cut there.
bool note_seen(image::SeenTexels& seen, const Texture& texture, const glm::dvec2 (&at)[3]);

/// Cuts triangles, one after the other, along the outline of one mask. It serves one thread, and
/// both arguments must outlive it.
class TriangleCutter {
public:
    TriangleCutter(const MaskOutline& outline, const Texture& texture);

    /// Cuts the triangle with these picture coordinates; the pieces turn as it does. A triangle that
    /// shows a line or a point of the picture is there as a whole, or not at all. The result is
    /// valid until the next call.
    const CutTriangle& cut(const glm::dvec2 (&at)[3], size_t most);

private:
    void cut_tile(int64_t column, int64_t row);
    void cut_piece(uint32_t piece, const glm::dvec2& origin, const glm::dvec2& sign);
    bool inside(const glm::dvec2& at) const;
    uint32_t corner(uint64_t key, const glm::dvec3& weights);

    const PlaneTriangles& inside_;
    const Texture& texture_;
    // The triangles of the outline by the squares of a grid over the picture that they touch.
    int side_ = 1;
    std::vector<std::vector<uint32_t>> squares_;
    std::vector<uint32_t> visited_;  // by triangle: the number of the last cut that met it
    uint32_t visit_ = 0;

    // The triangle that is cut: from picture coordinates to weights.
    glm::dvec2 low_{0.0};
    glm::dvec2 high_{0.0};
    glm::dvec3 to_weights_[3];
    double area_ = 0;  // of what is left, as a share
    // The corners of this visit, by their keys.
    struct KnownCorner {
        uint64_t key = 0;
        uint32_t visit = 0;
        uint32_t number = 0;
    };
    std::vector<KnownCorner> known_{64};
    size_t known_count_ = 0;
    CutTriangle out_;
};

}  // namespace lodestone::povray
