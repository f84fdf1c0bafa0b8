// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/mesh_cutting.h"

#include "povray_export/mesh/cut_plan.h"
#include "povray_export/mesh/leaf_normals.h"
#include "povray_export/mesh/triangle_cutter.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

namespace lodestone::povray {
namespace {

/// The most pieces of a triangle that become one.
/// Law: so many corners has no outline.
constexpr size_t kMostPieces = 4 * MaskOutlines::kMostCorners;

class MeshCutter {
public:
    MeshCutter(const Model& model, const Representation& representation,
               const RepresentationOptions& options, MaskOutlines& outlines, const Job& job)
        : mesh_(representation.mesh()),
          shown_(options.shown),
          outlines_(outlines),
          job_(job),
          plan_(model, representation, options, outlines, job) {}

    CutForecast forecast() {
        CutForecast out;
        plan_.find_slots();
        plan_.find_outlines();
        begin();
        for (auto& [number, slot] : plan_.slots()) {
            for (CutBand& band : slot.bands) {
                if (slot.crowd && band.opaque && band.outline)
                    try_crowd(slot, band);
                out.by_outline = out.by_outline || (band.opaque && band.outline);
                out.triangles += band.expected;
            }
        }
        return out;
    }

    CutMesh run() {
        plan_.find_slots();
        plan_.find_outlines();
        if (plan_.slots().empty() && !shown_)
            return {};
        begin();
        out_.any = shown_ != nullptr;
        for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
            if (!plan_.slots().contains(mesh_.slot(i)) && (!shown_ || shown_->shown.at(i) != 0))
                keep(i);
        }
        for (auto& [number, slot] : plan_.slots())
            cut(number, slot);
        if (!out_.any)
            return {};
        return std::move(out_);
    }

private:
    void begin() {
        out_.mesh.positions = mesh_.positions;
        out_.mesh.normals = mesh_.normals;
        out_.mesh.uvs = mesh_.uvs;
        out_.mesh.colors = mesh_.colors;
    }

    void keep(size_t triangle) {
        out_.mesh.triangles.push_back(mesh_.triangles[triangle]);
        out_.mesh.slots.push_back(mesh_.slot(triangle));
        out_.sources.push_back(static_cast<uint32_t>(triangle));
    }

    void cut(uint16_t number, CutSlot& slot) {
        if (slot.full) {
            keep_all(slot.triangles);
            keep_all(slot.doubles);
            out_.any = true;
        }
        const size_t before = out_.mesh.triangles.size();
        const size_t vertices = out_.mesh.positions.size();
        bool opaque = slot.full || cut_bands(slot);
        if (!opaque && join_nothing(slot)) {
            shrink(before, vertices);
            opaque = cut_bands(slot);
        }
        if (out_.opaque.size() <= number)
            out_.opaque.resize(size_t{number} + 1, 0);
        out_.opaque[number] = opaque ? 1 : 0;
    }

    /// Whether what is left has no alpha.
    bool cut_bands(CutSlot& slot) {
        bool opaque = true;
        for (CutBand& band : slot.bands)
            opaque = cut_band(slot, band) && opaque;
        return opaque;
    }

    /// Forbids pieces to be joined: they would lie where the alpha that the slot keeps is clear.
    /// False: none were.
    static bool join_nothing(CutSlot& slot) {
        bool any = false;
        for (CutBand& band : slot.bands) {
            any = any || band.joined > 0;
            band.joined = 0;
        }
        return any;
    }

    /// The same of one band.
    bool cut_band(const CutSlot& slot, CutBand& band) {
        const size_t before = out_.mesh.triangles.size();
        const size_t vertices = out_.mesh.positions.size();
        if (!band.outline) {
            keep_all(band.triangles);
            return false;
        }
        while (!cut_all(slot, band, before)) {
            shrink(before, vertices);
            if (!plan_.coarsen(slot, band)) {
                trim(slot, band, before, vertices);
                return false;
            }
        }
        out_.any = true;
        return band.opaque;
    }

    void keep_all(std::span<const uint32_t> triangles) {
        for (const uint32_t whole : triangles)
            keep(whole);
    }

    /// False: these are more triangles than the band may become.
    bool cut_all(const CutSlot& slot, const CutBand& band, size_t before) {
        TriangleCutter cutter(*band.outline, slot.material->alpha_texture, job_);
        return std::all_of(band.triangles.begin(), band.triangles.end(), [&](uint32_t triangle) {
            return cut_one(cutter, triangle, slot, band.joined, before + band.most);
        });
    }

    /// Finds the outline by which a crowd does not become too many triangles; none: it has no such.
    void try_crowd(const CutSlot& slot, CutBand& band) {
        const size_t vertices = out_.mesh.positions.size();
        bool fits = cut_all(slot, band, 0);
        while (!fits && plan_.coarsen(slot, band)) {
            shrink(0, vertices);
            fits = cut_all(slot, band, 0);
        }
        band.expected = out_.mesh.triangles.size();
        if (!fits)
            band.outline = nullptr;
        shrink(0, vertices);
    }

    /// Cuts off what is clear of a band that became too many triangles, or keeps it. It has alpha.
    void trim(const CutSlot& slot, const CutBand& band, size_t before, size_t vertices) {
        CutBand hull = band;
        hull.joined = 0;
        hull.outline = band.opaque
                           ? outlines_.hull(slot.material->alpha_texture, band.hull_corners, job_)
                           : nullptr;
        if (hull.outline && cut_all(slot, hull, before)) {
            out_.any = true;
            return;
        }
        shrink(before, vertices);
        keep_all(band.triangles);
    }

    /// The longest side of a triangle in texels.
    static double longest(const Texture& texture, const glm::dvec2 (&at)[3]) {
        const glm::dvec2 size(texture.picture->width, texture.picture->height);
        return std::max({glm::length((at[1] - at[0]) * size), glm::length((at[2] - at[1]) * size),
                         glm::length((at[0] - at[2]) * size)});
    }

    /// `joined`: the longest side, in texels, of a triangle of which one piece is left. False: there
    /// are more triangles than `most`.
    bool cut_one(TriangleCutter& cutter, uint32_t triangle, const CutSlot& slot, double joined,
                 size_t most) {
        glm::dvec2 at[3];
        plan_.place(slot.material->alpha_texture, triangle, at);
        if (out_.mesh.triangles.size() >= most)
            return false;
        const bool join = longest(slot.material->alpha_texture, at) <= joined;
        const CutTriangle& cut =
            cutter.cut(at, join ? kMostPieces : most - out_.mesh.triangles.size());
        const CutTriangle& pieces = join ? cutter.join_pieces() : cut;
        switch (pieces.outcome) {
            case CutOutcome::TooMany:
                return false;
            case CutOutcome::Whole:
                keep_leaf(triangle);
                return true;
            case CutOutcome::Pieces:
                add(triangle, face_of_bent(mesh_, triangle), pieces.corners, pieces.triangles);
                return true;
        }
        return true;
    }

    /// Keeps a triangle that lies in its mask, with corners of its own where its normals are bent.
    void keep_leaf(uint32_t triangle) {
        const std::array corners{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};
        const std::array whole{glm::uvec3(0, 1, 2)};
        if (const std::optional<glm::vec3> face = face_of_bent(mesh_, triangle))
            add(triangle, face, corners, whole);
        else
            keep(triangle);
    }

    void add(uint32_t triangle, const std::optional<glm::vec3>& face,
             std::span<const glm::dvec3> corners, std::span<const glm::uvec3> pieces) {
        const auto first = static_cast<uint32_t>(out_.mesh.positions.size());
        for (const glm::dvec3& weights : corners)
            add_corner(triangle, face, weights);
        for (const glm::uvec3& piece : pieces) {
            out_.mesh.triangles.push_back(piece + first);
            out_.mesh.slots.push_back(mesh_.slot(triangle));
            out_.sources.push_back(triangle);
        }
    }

    template <typename Value>
    static Value mean(const std::vector<Value>& values, const Triangle& t, const glm::vec3& w) {
        return w.x * values[t.x] + w.y * values[t.y] + w.z * values[t.z];
    }

    /// `face`: that of a triangle whose normals are bent too far.
    void add_corner(uint32_t triangle, const std::optional<glm::vec3>& face,
                    const glm::dvec3& weights) {
        const Triangle& t = mesh_.triangles[triangle];
        const glm::vec3 w(weights);
        out_.mesh.positions.emplace_back(weights.x * glm::dvec3(mesh_.positions[t.x]) +
                                         weights.y * glm::dvec3(mesh_.positions[t.y]) +
                                         weights.z * glm::dvec3(mesh_.positions[t.z]));
        if (!mesh_.normals.empty()) {
            const glm::vec3 normal = mean(mesh_.normals, t, w);
            const float length = glm::length(normal);
            const glm::vec3 unit = length > 0 ? normal / length : mesh_.normals[t.x];
            out_.mesh.normals.push_back(face ? less_bent(unit, *face) : unit);
        }
        out_.mesh.uvs.push_back(mean(mesh_.uvs, t, w));
        if (!mesh_.colors.empty())
            out_.mesh.colors.push_back(mean(mesh_.colors, t, w));
    }

    void shrink(size_t triangles, size_t vertices) {
        out_.mesh.triangles.resize(triangles);
        out_.mesh.slots.resize(triangles);
        out_.sources.resize(triangles);
        out_.mesh.positions.resize(vertices);
        out_.mesh.uvs.resize(vertices);
        if (!mesh_.normals.empty())
            out_.mesh.normals.resize(vertices);
        if (!mesh_.colors.empty())
            out_.mesh.colors.resize(vertices);
    }

    const Mesh& mesh_;
    const ShownTrianglesPtr shown_;
    MaskOutlines& outlines_;
    const Job& job_;
    CutPlan plan_;
    CutMesh out_;
};

}  // namespace

bool may_be_mask(const Material& material) {
    const Texture& alpha = material.alpha_texture;
    return material.alpha_mode != AlphaMode::Opaque && alpha && !alpha.picture->bytes.empty() &&
           !material.other && !(material.transmission > 0);
}

CutMesh cut_masks(const Model& model, const Representation& representation,
                  const RepresentationOptions& options, MaskOutlines& outlines, const Job& job) {
    return MeshCutter(model, representation, options, outlines, job).run();
}

CutForecast cut_forecast(const Model& model, const Representation& representation,
                         const RepresentationOptions& options, MaskOutlines& outlines,
                         const Job& job) {
    return MeshCutter(model, representation, options, outlines, job).forecast();
}

bool outlined_by_texel(const Model& model, const Representation& representation,
                       const RepresentationOptions& options, MaskOutlines& outlines,
                       const Job& job) {
    return CutPlan(model, representation, options, outlines, job).by_texel();
}

}  // namespace lodestone::povray
