// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/mesh_cutting.h"

#include "base/error.h"
#include "base/hash.h"
#include "light/clear_materials.h"
#include "povray_export/mesh/clear_layers.h"
#include "povray_export/mesh/doubled_triangles.h"
#include "povray_export/mesh/triangle_cutter.h"
#include "povray_export/mesh/uv_extent.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

namespace lodestone::povray {
namespace {

/// The triangles that one triangle of a slot may become on average. POV-Ray parses that many in a
/// sixth of a millisecond and keeps them in 8 kB; a hole that a ray meets takes it some
/// microseconds, each time, for every sample of a light.
/// Taste: a larger value cuts finer nets, for memory and parsing.
constexpr size_t kMostEach = 32;
/// The same in a crowd, whose outlines are coarser than asked for.
/// Taste: a larger value cuts branches more finely, for memory and parsing.
constexpr size_t kMostInCrowd = 64;
/// The same where only what is clear is cut off, which saves most of the holes.
/// Taste: a larger value leaves fewer of them.
constexpr size_t kMostTrimmed = 24;
/// The triangles that any slot may become: 8 MB, as an image of 1600 x 1600 takes, and a sixth of a
/// second to parse.
/// Taste: a larger value cuts single cards, and trees of a few of them, with more on them.
constexpr size_t kMostOfFew = size_t{1} << 15u;
/// The triangles that a slot may become at most, however many it has.
/// Taste: a larger value cuts larger meshes, for up to 64 MB each.
constexpr size_t kMostOfMany = size_t{1} << 18u;

/// How a slot's mask is cut.
struct CutSlot {
    const Material* material = nullptr;
    std::vector<uint32_t> triangles;
    std::vector<uint32_t> doubles;  // the other sides of some of them, which are left out
    image::SeenTexels seen;         // by all of them
    double tolerance = 1;           // in texels
    std::optional<double> cutoff;
    bool crowd = false;       // of leaves, none of which matters
    size_t most = 0;          // triangles that it may become
    size_t expected = 0;      // triangles that it becomes, about
    size_t hull_corners = 0;  // corners of what it may be trimmed by
    MaskOutlinePtr outline;
    bool full = false;     // nothing of it is clear: it is opaque without any cut
    bool opaque = false;   // what is left has no alpha
    bool painted = false;  // colors of vertices make some of it clear
};

class MeshCutter {
public:
    MeshCutter(const Model& model, const Representation& representation,
               const RepresentationOptions& options, MaskOutlines& outlines, const Job& job)
        : model_(model),
          representation_(representation),
          options_(options),
          mesh_(representation.mesh()),
          outlines_(outlines),
          job_(job) {}

    CutForecast forecast() {
        CutForecast out;
        Hasher outlines;
        find_slots();
        begin();
        for (auto& [number, slot] : slots_) {
            if (!find_outline(slot))
                continue;
            if (slot.crowd && slot.opaque && slot.outline)
                try_crowd(slot);
            out.by_outline = out.by_outline || (slot.opaque && slot.outline);
            out.triangles += slot.expected;
            outlines.value(number).value(slot.opaque);
            if (slot.outline)
                outlines.array(std::span<const glm::dvec2>(slot.outline->inside.points));
        }
        out.outlines = outlines.result();
        return out;
    }

    bool by_texel() {
        collect_slots();
        return std::all_of(slots_.begin(), slots_.end(),
                           [&](const auto& slot) { return tolerance_of(slot.second) <= 1; });
    }

    CutMesh run() {
        find_slots();
        bool any = false;
        for (auto at = slots_.begin(); at != slots_.end();) {
            job_.check();
            if (find_outline(at->second)) {
                any = true;
                ++at;
            } else {
                at = slots_.erase(at);
            }
        }
        if (!any)
            return {};
        begin();
        for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
            if (!slots_.contains(mesh_.slot(i)))
                keep(i);
        }
        for (auto& [number, slot] : slots_)
            cut(number, slot);
        if (!out_.any)
            return {};
        return std::move(out_);
    }

private:
    const Material* material_of(uint16_t slot) const {
        if (slot >= representation_.materials.size())
            return nullptr;
        const uint32_t index = representation_.materials[slot];
        if (index >= model_.materials.size())
            fail(Status::InvalidArgument, "a representation uses material ", index, " of ",
                 model_.materials.size());
        return &model_.materials[index];
    }

    /// Collects the slots whose materials may be masks.
    void collect_slots() {
        if (!options_.textures || !options_.uvs || mesh_.uvs.empty())
            return;
        for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
            const uint16_t number = mesh_.slot(i);
            const auto found = slots_.find(number);
            if (found != slots_.end()) {
                found->second.triangles.push_back(static_cast<uint32_t>(i));
                continue;
            }
            const Material* material = material_of(number);
            if (material == nullptr || !may_be_mask(*material))
                continue;
            slots_[number].material = material;
            slots_[number].triangles.push_back(static_cast<uint32_t>(i));
        }
    }

    /// The texels by which the outline of a slot's mask may be off.
    double tolerance_of(const CutSlot& slot) const {
        // The share of the area that may see its outline less finely than asked.
        // Taste: a larger value cuts more coarsely for single stretched triangles.
        constexpr double kSpared = 0.001;
        if (!options_.outline)
            return 1;
        const Texture& texture = slot.material->alpha_texture;
        const std::array<double, 6>& m = texture.to_picture;
        const double uv =
            outline_error(*options_.outline) / metres_of_uv(mesh_, slot.triangles, kSpared);
        return uv * std::min(std::hypot(m[0], m[1]) * texture.picture->width,
                             std::hypot(m[3], m[4]) * texture.picture->height);
    }

    /// Finds the slots that may be cut, and how finely each is seen.
    void find_slots() {
        collect_slots();
        if (slots_.empty())
            return;
        layers_ = clear_layers(mesh_, [&](size_t i) {
            const Material* material = material_of(mesh_.slot(i));
            return material != nullptr && light::lets_light_through(*material);
        });
        for (auto at = slots_.begin(); at != slots_.end();) {
            auto doubles = take_doubles(mesh_, at->second.triangles);
            if (doubles)
                at->second.doubles = std::move(*doubles);
            at = doubles ? std::next(at) : slots_.erase(at);
        }
        for (auto& [number, slot] : slots_) {
            slot.painted = painted_clear(slot);
            slot.tolerance = tolerance_of(slot);
        }
    }

    /// Whether colors of vertices make some of a slot clear.
    bool painted_clear(const CutSlot& slot) const {
        if (!slot.material->vertex_colors || mesh_.colors.empty())
            return false;
        // The least alpha that counts as full.
        // Law: half a step of 8 bits.
        constexpr float kFull = 1 - 0.5f / 255;
        return std::any_of(slot.triangles.begin(), slot.triangles.end(), [&](uint32_t i) {
            const Triangle& t = mesh_.triangles[i];
            return !(mesh_.colors[t.x].w >= kFull && mesh_.colors[t.y].w >= kFull &&
                     mesh_.colors[t.z].w >= kFull);
        });
    }

    /// The corners of a triangle in the picture; false where one is beyond all sense.
    bool place(const Texture& texture, uint32_t triangle, glm::dvec2 (&at)[3]) const {
        // Law: texels beyond cannot be told apart, and tiles must fit an integer.
        constexpr double kFarthest = 1e6;
        for (int k = 0; k < 3; ++k) {
            at[k] = to_picture(texture, glm::dvec2(mesh_.uvs[mesh_.triangles[triangle][k]]));
            if (!(std::abs(at[k].x) < kFarthest && std::abs(at[k].y) < kFarthest))
                return false;
        }
        return true;
    }

    /// The outline of a mask as finely as it is seen. Of a crowd of leaves it is coarser where it
    /// would have too many corners: rays take ten times as long through masks as past what is cut
    /// out of them.
    MaskOutlinePtr outline_that_fits(const ShownMask& mask, const image::MaskTexels& texels,
                                     bool crowd) const {
        // The factor on the tolerance up to which it is coarser.
        // Taste: leaves in a crowd keep their area; a larger value shows corners of single leaves.
        constexpr double kCoarser = 16;
        // The same as a part of the picture's side.
        // Taste: branches of a picture across are told apart; a larger value makes them blobs.
        constexpr double kOfSide = 1.0 / 16;
        const double finest = std::max(1.0, mask.tolerance);
        const double most =
            std::min(kCoarser * finest, kOfSide * std::min(texels.width, texels.height));
        ShownMask shown = mask;
        MaskOutlinePtr found = outlines_.outline(shown, job_);
        for (double tolerance = finest; crowd && !found && tolerance < most;) {
            // Law: half of a halving.
            tolerance = std::min(tolerance * std::numbers::sqrt2, most);
            shown.tolerance = tolerance;
            found = outlines_.outline(shown, job_);
        }
        return found;
    }

    /// False: there is nothing to cut.
    bool find_outline(CutSlot& slot) const {
        const Material& material = *slot.material;
        const Texture& texture = material.alpha_texture;
        const MaskTexelsPtr texels = outlines_.texels(texture);
        slot.seen = image::unseen_texels(texels->width, texels->height);
        double pictures = 0;  // that all triangles together show
        for (const uint32_t triangle : slot.triangles) {
            glm::dvec2 at[3];
            if (!place(texture, triangle, at) || !note_seen(slot.seen, texture, at))
                return false;
            const glm::dvec2 a = at[1] - at[0];
            const glm::dvec2 b = at[2] - at[0];
            pictures += std::abs(a.x * b.y - a.y * b.x) / 2;
        }
        const image::MaskCount count = image::count(*texels, slot.seen);
        const bool clip = material.alpha_mode == AlphaMode::Clip;
        if (count.seen == 0)
            return false;
        // The triangles of a crowd, each of which shows one picture at most: fences repeat theirs.
        // Taste: a larger value leaves the shapes of smaller bushes, for time.
        constexpr size_t kCrowd = 64;
        slot.crowd = options_.coarse_crowds && slot.triangles.size() >= kCrowd &&
                     pictures <= static_cast<double>(slot.triangles.size());
        slot.most = std::clamp((slot.crowd ? kMostInCrowd : kMostEach) * slot.triangles.size(),
                               kMostOfFew, kMostOfMany);
        if (options_.most_cut)
            slot.most = std::min(slot.most, (size_t{1} << *options_.most_cut) / slots_.size());
        // An outline is about as many triangles as corners, once for each picture, and the sides of
        // the mesh's triangles cut those.
        // Fitted: to pine branches of 28 to 206 triangles on 2,700: 1.3 to 1.4 times as many.
        constexpr double kMore = 1.35;
        const auto most = static_cast<size_t>(static_cast<double>(slot.most) /
                                              (kMore * std::max(pictures, 1e-3)));
        slot.hull_corners = most * kMostTrimmed / kMostEach;
        // So many blends behind each other look as a mask of them does, and POV-Ray bears no more.
        const bool deep = layers_ > kMostLayers;
        if (!slot.painted && (clip || deep || count.is_mask())) {
            if (clip)
                slot.cutoff = limited(material.alpha_cutoff, 0, 1);
            slot.full = clip ? *slot.cutoff <= 0
                             : count.sure == count.seen && count.clear == 0 && count.mean > 0.5;
            if (!slot.full)
                slot.outline = outline_that_fits(
                    {texture, slot.cutoff, slot.seen, slot.tolerance, most}, *texels, slot.crowd);
            slot.opaque = slot.full || slot.outline;
        }
        if (!slot.opaque)
            slot.outline = outlines_.hull(texture, slot.hull_corners, job_);
        slot.expected = slot.triangles.size();
        if (slot.outline)
            slot.expected = static_cast<size_t>(
                std::min(kMore * pictures * static_cast<double>(slot.outline->inside.points.size()),
                         static_cast<double>(slot.most)));
        return slot.full || slot.outline;
    }

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
        const size_t before = out_.mesh.triangles.size();
        const size_t vertices = out_.mesh.positions.size();
        if (slot.full) {
            keep_all(slot);
        } else {
            while (!cut_all(slot, before)) {
                shrink(before, vertices);
                if (coarsen(slot))
                    continue;
                trim(slot, before, vertices);
                return;
            }
        }
        out_.any = true;
        if (out_.opaque.size() <= number)
            out_.opaque.resize(size_t{number} + 1, 0);
        out_.opaque[number] = slot.opaque ? 1 : 0;
    }

    void keep_all(const CutSlot& slot) {
        for (const uint32_t whole : slot.triangles)
            keep(whole);
        for (const uint32_t whole : slot.doubles)
            keep(whole);
    }

    /// False: these are more triangles than the slot may become.
    bool cut_all(const CutSlot& slot, size_t before) {
        TriangleCutter cutter(*slot.outline, slot.material->alpha_texture, job_);
        return std::all_of(slot.triangles.begin(), slot.triangles.end(), [&](uint32_t triangle) {
            return cut_one(cutter, triangle, slot, before + slot.most);
        });
    }

    /// Finds the outline by which a crowd does not become too many triangles; none: it has no such.
    void try_crowd(CutSlot& slot) {
        const size_t vertices = out_.mesh.positions.size();
        bool fits = cut_all(slot, 0);
        while (!fits && coarsen(slot)) {
            shrink(0, vertices);
            fits = cut_all(slot, 0);
        }
        slot.expected = out_.mesh.triangles.size();
        if (!fits)
            slot.outline = nullptr;
        shrink(0, vertices);
    }

    /// Gives a crowd an outline of fewer corners. False: there is none.
    bool coarsen(CutSlot& slot) const {
        if (!slot.crowd || !slot.opaque)
            return false;
        const Texture& texture = slot.material->alpha_texture;
        const size_t corners = slot.outline->inside.points.size() - 1;
        const MaskOutlinePtr next =
            outline_that_fits({texture, slot.cutoff, slot.seen, slot.tolerance, corners},
                              *outlines_.texels(texture), true);
        if (next)
            slot.outline = next;
        return next != nullptr;
    }

    /// Cuts off what is clear of a slot that became too many triangles, or keeps it.
    void trim(const CutSlot& slot, size_t before, size_t vertices) {
        CutSlot hull = slot;
        if (slot.opaque)
            hull.outline = outlines_.hull(slot.material->alpha_texture, slot.hull_corners, job_);
        else
            hull.outline = nullptr;
        if (hull.outline && cut_all(hull, before)) {
            out_.any = true;
            return;
        }
        shrink(before, vertices);
        keep_all(slot);
    }

    /// False: there are more triangles than `most`.
    bool cut_one(TriangleCutter& cutter, uint32_t triangle, const CutSlot& slot, size_t most) {
        glm::dvec2 at[3];
        place(slot.material->alpha_texture, triangle, at);
        if (out_.mesh.triangles.size() >= most)
            return false;
        const CutTriangle& pieces = cutter.cut(at, most - out_.mesh.triangles.size());
        switch (pieces.outcome) {
            case CutOutcome::TooMany:
                return false;
            case CutOutcome::Whole:
                keep(triangle);
                return true;
            case CutOutcome::Pieces:
                break;
        }
        const auto first = static_cast<uint32_t>(out_.mesh.positions.size());
        for (const glm::dvec3& weights : pieces.corners)
            add_corner(triangle, weights);
        for (const glm::uvec3& piece : pieces.triangles) {
            out_.mesh.triangles.push_back(piece + first);
            out_.mesh.slots.push_back(mesh_.slot(triangle));
            out_.sources.push_back(triangle);
        }
        return true;
    }

    template <typename Value>
    static Value mean(const std::vector<Value>& values, const Triangle& t, const glm::vec3& w) {
        return w.x * values[t.x] + w.y * values[t.y] + w.z * values[t.z];
    }

    void add_corner(uint32_t triangle, const glm::dvec3& weights) {
        const Triangle& t = mesh_.triangles[triangle];
        const glm::vec3 w(weights);
        out_.mesh.positions.emplace_back(weights.x * glm::dvec3(mesh_.positions[t.x]) +
                                         weights.y * glm::dvec3(mesh_.positions[t.y]) +
                                         weights.z * glm::dvec3(mesh_.positions[t.z]));
        if (!mesh_.normals.empty()) {
            const glm::vec3 normal = mean(mesh_.normals, t, w);
            const float length = glm::length(normal);
            out_.mesh.normals.push_back(length > 0 ? normal / length : mesh_.normals[t.x]);
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

    const Model& model_;
    const Representation& representation_;
    const RepresentationOptions& options_;
    const Mesh& mesh_;
    MaskOutlines& outlines_;
    const Job& job_;
    std::map<uint16_t, CutSlot> slots_;
    double layers_ = 0;
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
    return MeshCutter(model, representation, options, outlines, job).by_texel();
}

}  // namespace lodestone::povray
