// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/cut_plan.h"

#include "base/error.h"
#include "base/maths.h"
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
#include <numbers>
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
/// The triangles of a crowd of leaves.
/// Taste: a larger value leaves the shapes of smaller bushes, for time.
constexpr size_t kCrowd = 64;
/// The factor on the tolerance in a crowd: most of an outline lies before or behind other leaves.
/// Taste: beside 1 a picture of trees is as near to full detail (SSIM less by 0.001 to 0.003); a
/// larger value makes their outer branches blocky.
constexpr double kOfCrowd = 2;
/// The width of a triangle in a crowd, in its tolerances, up to which its pieces become one.
/// Taste: triangles of four pixels at Pixel Error 1; a larger value makes leaves blocky.
constexpr double kJoined = 2;
/// The octaves of tolerances that are told apart.
/// Law: a picture has no more texels along a side.
constexpr int kMostOctaves = 16;

}  // namespace

const Material* CutPlan::material_of(uint16_t slot) const {
    if (slot >= representation_.materials.size())
        return nullptr;
    const uint32_t index = representation_.materials[slot];
    if (index >= model_.materials.size())
        fail(Status::InvalidArgument, "a representation uses material ", index, " of ",
             model_.materials.size());
    return &model_.materials[index];
}

/// Collects the slots whose materials may be masks.
void CutPlan::collect_slots() {
    if (!options_.textures || !options_.uvs || mesh_.uvs.empty())
        return;
    for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
        const uint16_t number = mesh_.slot(i);
        auto found = slots_.find(number);
        if (found == slots_.end()) {
            const Material* material = material_of(number);
            if (material == nullptr || !may_be_mask(*material))
                continue;
            found = slots_.try_emplace(number).first;
            found->second.material = material;
        }
        ++found->second.all;
        if (!options_.shown || options_.shown->shown.at(i) != 0)
            found->second.triangles.push_back(static_cast<uint32_t>(i));
    }
    std::erase_if(slots_, [](const auto& slot) { return slot.second.triangles.empty(); });
}

/// The triangles of a slot by how finely they are seen, and how stretched the picture lies on them.
std::vector<CutBand> CutPlan::bands_of(const CutSlot& slot) const {
    // The first band is of those that are cut by texels.
    std::vector<CutBand> all(kMostOctaves + 2);
    for (const uint32_t triangle : slot.triangles) {
        if (!(glm::length(area_vector(mesh_, triangle)) > 0))
            continue;  // it shows nothing
        const double tolerance = tolerance_of(*slot.material, triangle);
        const int octave = std::ilogb(limited(tolerance, 1, std::exp2(kMostOctaves)));
        CutBand& band = all[tolerance >= 1 ? static_cast<size_t>(octave) + 1 : 0];
        band.tolerance = band.triangles.empty() ? tolerance : std::min(band.tolerance, tolerance);
        band.triangles.push_back(triangle);
    }
    std::erase_if(all, [](const CutBand& band) { return band.triangles.empty(); });
    return all;
}

/// The texels by which the outline of a triangle's mask may be off; of one that shows a line of the
/// picture, or a place, none.
double CutPlan::tolerance_of(const Material& material, uint32_t triangle) const {
    if (!options_.outline)
        return 0;  // by texels
    double times = 1;
    if (options_.bands) {
        Box3 box;
        for (int corner = 0; corner < 3; ++corner)
            box.add(glm::dvec3(mesh_.positions[mesh_.triangles[triangle][corner]]));
        times = std::exp2(options_.bands->octaves(box));
    }
    const Texture& texture = material.alpha_texture;
    const std::array<double, 6>& m = texture.to_picture;
    const double uv = times * outline_error(*options_.outline) / metres_of_uv(mesh_, triangle);
    return uv * std::min(std::hypot(m[0], m[1]) * texture.picture->width,
                         std::hypot(m[3], m[4]) * texture.picture->height);
}

/// Finds the slots that may be cut, and how finely each is seen.
void CutPlan::find_slots() {
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
        slot.bands = bands_of(slot);
    }
}

/// Whether colors of vertices make some of a slot clear.
bool CutPlan::painted_clear(const CutSlot& slot) const {
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
bool CutPlan::place(const Texture& texture, uint32_t triangle, glm::dvec2 (&at)[3]) const {
    // Law: texels beyond cannot be told apart, and tiles must fit an integer.
    constexpr double kFarthest = 1e6;
    for (int k = 0; k < 3; ++k) {
        at[k] = to_picture(texture, glm::dvec2(mesh_.uvs[mesh_.triangles[triangle][k]]));
        if (!(std::abs(at[k].x) < kFarthest && std::abs(at[k].y) < kFarthest))
            return false;
    }
    return true;
}

/// The outline of a mask as finely as it is seen. Of a crowd of leaves it is coarser, and more so
/// where it would have too many corners: rays take ten times as long through masks as past what
/// is cut out of them.
MaskOutlinePtr CutPlan::outline_that_fits(const ShownMask& mask, bool crowd) const {
    // The factor on the tolerance up to which it is coarser.
    // Taste: leaves in a crowd keep their area; a larger value shows corners of single leaves.
    constexpr double kCoarser = 16;
    // The same as a part of the picture's side.
    // Taste: branches of a picture across are told apart; a larger value makes them blobs.
    constexpr double kOfSide = 1.0 / 16;
    const double asked = std::max(1.0, mask.tolerance);
    const Picture& picture = *mask.texture.picture;
    const double most =
        std::min(kCoarser * asked, kOfSide * std::min(picture.width, picture.height));
    const double in_crowd = std::min(kOfCrowd * mask.tolerance, most);
    const double finest = crowd ? std::max(asked, in_crowd) : asked;
    ShownMask shown = mask;
    shown.tolerance = finest;
    MaskOutlinePtr found = outlines_.outline(shown, job_);
    for (double tolerance = finest; crowd && !found && tolerance < most;) {
        // Law: half of a halving.
        tolerance = std::min(tolerance * std::numbers::sqrt2, most);
        shown.tolerance = tolerance;
        found = outlines_.outline(shown, job_);
    }
    return found;
}

void CutPlan::find_outlines() {
    for (auto at = slots_.begin(); at != slots_.end();) {
        job_.check();
        at = find_outlines_of(at->second) ? std::next(at) : slots_.erase(at);
    }
}

bool CutPlan::may_be_crowd(const CutSlot& slot) const {
    return options_.coarse_crowds && slot.all >= kCrowd;
}

bool CutPlan::by_texel() {
    collect_slots();
    return std::all_of(slots_.begin(), slots_.end(), [&](const auto& slot) {
        const std::vector<CutBand> bands = bands_of(slot.second);
        const double factor = may_be_crowd(slot.second) ? kOfCrowd : 1;
        return std::all_of(bands.begin(), bands.end(),
                           [&](const CutBand& band) { return factor * band.tolerance <= 1; });
    });
}

bool CutPlan::coarsen(const CutSlot& slot, CutBand& band) const {
    if (!slot.crowd || !band.opaque)
        return false;
    const Texture& texture = slot.material->alpha_texture;
    const size_t corners = band.outline->inside.points.size() - 1;
    const MaskOutlinePtr next =
        outline_that_fits({texture, slot.cutoff, slot.seen, band.tolerance, corners}, true);
    if (next)
        band.outline = next;
    return next != nullptr;
}

/// False: there is nothing to cut.
bool CutPlan::find_outlines_of(CutSlot& slot) const {
    const Material& material = *slot.material;
    const Texture& texture = material.alpha_texture;
    slot.seen = image::unseen_texels(texture.picture->width, texture.picture->height);
    for (CutBand& band : slot.bands) {
        for (const uint32_t triangle : band.triangles) {
            glm::dvec2 at[3];
            if (!place(texture, triangle, at) || !note_seen(slot.seen, texture, at))
                return false;
            const glm::dvec2 a = at[1] - at[0];
            const glm::dvec2 b = at[2] - at[0];
            band.pictures += std::abs(a.x * b.y - a.y * b.x) / 2;
        }
        slot.pictures += band.pictures;
    }
    const image::MaskCount count = outlines_.count(texture, slot.seen);
    const bool clip = material.alpha_mode == AlphaMode::Clip;
    if (count.seen == 0)
        return false;
    // Each triangle of a crowd shows one picture at most: fences repeat theirs.
    slot.crowd = may_be_crowd(slot) && slot.pictures <= static_cast<double>(slot.triangles.size());
    // So many blends behind each other look as a mask of them does, and POV-Ray bears no more.
    const bool deep = layers_ > kMostLayers;
    const bool mask = !slot.painted && (clip || deep || count.is_mask());
    if (mask) {
        if (clip)
            slot.cutoff = limited(material.alpha_cutoff, 0, 1);
        slot.full = clip ? *slot.cutoff <= 0
                         : count.sure == count.seen && count.clear == 0 && count.mean > 0.5;
    }
    bool any = slot.full;
    for (CutBand& band : slot.bands) {
        find_outline(slot, mask, band);
        any = any || band.outline;
    }
    return any;
}

/// Finds how a band of a slot is cut; `mask`: by the outline of its mask, if that pays.
void CutPlan::find_outline(const CutSlot& slot, bool mask, CutBand& band) const {
    const Texture& texture = slot.material->alpha_texture;
    const size_t bands = slot.bands.size();
    const double own = slot.pictures > 0 ? band.pictures / slot.pictures : 1;
    const auto few = static_cast<size_t>(kMostOfFew * (own + 1.0 / static_cast<double>(bands)) / 2);
    band.most = std::clamp((slot.crowd ? kMostInCrowd : kMostEach) * band.triangles.size(),
                           std::min(few, kMostOfFew), kMostOfMany);
    if (options_.most_cut)
        band.most = std::min(band.most, (size_t{1} << *options_.most_cut) / slots_.size() / bands);
    // An outline is about as many triangles as corners, once for each picture, and the sides of
    // the mesh's triangles cut those.
    // Fitted: to pine branches of 28 to 206 triangles on 2,700: 1.3 to 1.4 times as many.
    constexpr double kMore = 1.35;
    const auto most = static_cast<size_t>(static_cast<double>(band.most) /
                                          (kMore * std::max(band.pictures, 1e-3)));
    band.hull_corners = most * kMostTrimmed / kMostEach;
    if (mask && !slot.full)
        band.outline =
            outline_that_fits({texture, slot.cutoff, slot.seen, band.tolerance, most}, slot.crowd);
    band.opaque = slot.full || band.outline;
    if (!band.opaque)
        band.outline = outlines_.hull(texture, band.hull_corners, job_);
    if (slot.crowd && band.opaque && kOfCrowd * band.tolerance > 1)
        band.joined = kJoined * kOfCrowd * band.tolerance;
    band.expected = band.triangles.size();
    if (band.outline)
        band.expected = static_cast<size_t>(std::min(
            kMore * band.pictures * static_cast<double>(band.outline->inside.points.size()),
            static_cast<double>(band.most)));
}

}  // namespace lodestone::povray
