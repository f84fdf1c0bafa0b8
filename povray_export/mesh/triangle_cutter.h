// SPDX-License-Identifier: GPL-3.0-or-later
// Triangle cutter: what of a triangle is inside an outline that its picture repeats.
#pragma once

#include "base/job.h"
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
/// all arguments must outlive it.
class TriangleCutter {
public:
    TriangleCutter(const MaskOutline& outline, const Texture& texture, const Job& job);

    /// Cuts the triangle with these picture coordinates; the pieces turn as it does. One that shows
    /// a line of the picture is cut across it, one that shows a point is there or not. The result
    /// is valid until the next call. cost: O(most + triangles of the outline), for what takes
    /// longer is TooMany. Throws Error(Cancelled).
    const CutTriangle& cut(const glm::dvec2 (&at)[3], size_t most);
    /// Makes the pieces of the last cut one triangle of their area, around their center as far as
    /// it stays inside of the triangle that was cut.
    const CutTriangle& join_pieces();

private:
    /// One repetition of the picture: a point p of it lies at origin + sign * p.
    struct PictureTile {
        glm::dvec2 origin;
        glm::dvec2 sign;
    };
    template <typename Visit>
    bool each_piece(const glm::dvec2 (&at)[3], size_t most, const Visit& visit);
    template <typename Visit>
    void each_piece_of(const PictureTile& tile, const glm::dvec2 (&at)[3], const Visit& visit);
    PictureTile tile_of(int64_t column, int64_t row) const;
    void cut_piece(uint32_t piece, const PictureTile& tile);
    void cut_line(const glm::dvec2 (&at)[3], size_t most);
    void add_strip(const glm::dvec3& along, double low, double high);
    bool inside(const glm::dvec2& at) const;
    /// The place in squares_ of a square.
    size_t square(int column, int row) const {
        return static_cast<size_t>(row) * static_cast<size_t>(side_) + static_cast<size_t>(column);
    }
    uint32_t corner(uint64_t key, const glm::dvec3& weights);

    const PlaneTriangles& inside_;
    const Texture& texture_;
    const Job& job_;
    // The triangles of the outline by the squares of a grid over the picture that they touch.
    int side_ = 1;
    std::vector<std::vector<uint32_t>> squares_;
    std::vector<uint32_t> visited_;  // by triangle: the number of the last cut that met it
    uint32_t visit_ = 0;
    size_t pieces_ = 0;  // of the outline that this triangle was cut by

    glm::dvec3 to_weights_[3];  // of the triangle that is cut, from picture coordinates
    double area_ = 0;           // of what is left, as a share
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
