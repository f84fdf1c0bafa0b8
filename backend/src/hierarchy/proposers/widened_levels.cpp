// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/widened_levels.h"

#include "group/loose_surfaces.h"
#include "hierarchy/evaluators/brightness_match.h"
#include "hierarchy/lamp_materials.h"
#include "measure/pictures/picture_agreement.h"
#include "measure/visible/visible_attributes.h"
#include "solids/stand_in_material.h"
#include "solids/widened_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace lodestone::hierarchy {
namespace {

// A thing that is mostly thin shows less than this share of its bound's surface.
// Taste: a larger value tries more things, in vain.
constexpr double kSparsest = 0.08;
// It shows at least this share of its area in thin parts.
// Taste: a larger value tries fewer things.
constexpr double kMostlyThin = 0.25;
// The most thin parts; each is a box in every level.
// Taste: a larger number makes levels of more boxes, which cost more.
constexpr size_t kMostThin = 16;
// The largest width of a box, over the radius.
// Taste: wider ones are crossed by too many rays.
constexpr double kWidest = 0.3;
// The width of a box over that in the level before.
// Taste: a larger value makes fewer levels.
constexpr double kRatio = 1.6;
// The most widths that one level is tried with.
// Taste: a larger number makes more levels, for pictures each.
constexpr int kMostWidths = 8;
// The error of a level over that of the level before, at least.
// Taste: a larger value leaves out levels that differ little.
constexpr double kNext = 1.01;
// The rays that measure a thin part.
// Taste: more know its area and color better, in time in proportion.
constexpr uint64_t kRaysOfPart = 4096;

/// The thin parts of a mesh.
struct ThinParts {
    std::vector<solids::ThinPart> parts;
    std::vector<Attributes> attributes;
    std::vector<uint8_t> is_thin;  // by triangle
    double thickness = 0;          // the largest
};

bool is_plain(const Mesh& mesh, size_t triangle, const std::vector<Material>& materials) {
    const uint16_t slot = mesh.slot(triangle);
    if (slot >= materials.size())
        return true;
    const Material& material = materials[slot];
    return material.alpha_mode == AlphaMode::Opaque && !(material.transmission > 0) &&
           !material.other && !emits(material);
}

/// Tells by part whether it may be thin, which takes no rays.
std::vector<uint8_t> perhaps_thin(const Mesh& mesh, const std::vector<uint32_t>& part_of,
                                  const std::vector<Material>& materials) {
    // The most area of a thin part, over the square of its diagonal.
    // Taste: a box that is twelve times longer than thick has a third; a larger value measures more
    // parts in vain.
    constexpr double kMostArea = 0.5;
    struct PartBounds {
        glm::dvec3 low{std::numeric_limits<double>::infinity()};
        glm::dvec3 high{-std::numeric_limits<double>::infinity()};
        double area = 0;
        bool plain = true;
    };
    std::vector<PartBounds> parts;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (part_of[i] >= parts.size())
            parts.resize(part_of[i] + size_t{1});
        PartBounds& part = parts[part_of[i]];
        const Triangle& t = mesh.triangles[i];
        for (const uint32_t corner : {t.x, t.y, t.z}) {
            part.low = glm::min(part.low, glm::dvec3(mesh.positions[corner]));
            part.high = glm::max(part.high, glm::dvec3(mesh.positions[corner]));
        }
        part.area += 0.5 * glm::length(area_vector(mesh, static_cast<uint32_t>(i)));
        part.plain = part.plain && is_plain(mesh, i, materials);
    }
    std::vector<uint8_t> out;
    for (const PartBounds& part : parts) {
        const glm::dvec3 diagonal = part.high - part.low;
        out.push_back(part.plain && part.area > 0 &&
                              part.area < kMostArea * glm::dot(diagonal, diagonal)
                          ? 1
                          : 0);
    }
    return out;
}

ThinParts thin_parts(const MeasuredFinest& finest, double enough, const Job& job) {
    ThinParts out;
    const Mesh& mesh = finest.mesh;
    const std::vector<uint32_t> part_of = group::loose_parts(mesh);
    const std::vector<uint8_t> perhaps = perhaps_thin(mesh, part_of, finest.materials);
    if (static_cast<size_t>(std::count(perhaps.begin(), perhaps.end(), 1)) > kMostThin)
        return out;
    out.is_thin.assign(mesh.triangles.size(), 0);
    double area = 0;
    for (uint32_t number = 0; number < perhaps.size(); ++number) {
        if (perhaps[number] == 0)
            continue;
        std::vector<uint8_t> keep(part_of.size());
        for (size_t i = 0; i < keep.size(); ++i)
            keep[i] = part_of[i] == number ? 1 : 0;
        const Mesh part = subset(mesh, keep);
        const Attributes attributes =
            measure::measure_visible(part, ray::MeshScene(part, finest.skin), finest.skin,
                                     finest.visible_options(kRaysOfPart), {}, job)
                .attributes;
        const std::optional<solids::ThinPart> thin =
            attributes.empty() ? std::nullopt : solids::find_thin_part(part, attributes);
        if (!thin)
            continue;
        out.parts.push_back(*thin);
        out.attributes.push_back(attributes);
        out.thickness = std::max(out.thickness, thin->thickness());
        area += attributes.visible_area;
        for (size_t i = 0; i < keep.size(); ++i)
            out.is_thin[i] = out.is_thin[i] != 0 || keep[i] != 0 ? 1 : 0;
    }
    if (!(area >= enough))
        out.parts.clear();
    return out;
}

std::vector<uint8_t> not_of(std::vector<uint8_t> marks) {
    for (uint8_t& mark : marks)
        mark = mark != 0 ? 0 : 1;
    return marks;
}

/// All loose parts of a level but those that stand for thin ones.
Mesh rest_of(const Mesh& level, const ThinParts& thin, const MeasuredFinest& finest) {
    const std::vector<uint32_t> part_of = group::loose_parts(level);
    std::vector<double> thin_area;  // by part, less what is not
    for (size_t i = 0; i < level.triangles.size(); ++i) {
        if (part_of[i] >= thin_area.size())
            thin_area.resize(part_of[i] + size_t{1}, 0.0);
        const Triangle& t = level.triangles[i];
        const glm::dvec3 middle =
            (glm::dvec3(level.positions[t.x]) + glm::dvec3(level.positions[t.y]) +
             glm::dvec3(level.positions[t.z])) /
            3.0;
        const ray::ClosestPoint found = finest.scene().closest_point(middle);
        const double area = glm::length(area_vector(level, static_cast<uint32_t>(i)));
        if (found.triangle != ray::kNoTriangle)
            thin_area[part_of[i]] += thin.is_thin[found.triangle] != 0 ? area : -area;
    }
    std::vector<uint8_t> keep(part_of.size());
    for (size_t i = 0; i < keep.size(); ++i)
        keep[i] = thin_area[part_of[i]] > 0 ? 0 : 1;
    return subset(level, keep);
}

/// A level whose thin parts are boxes of this width, in slots of their own, beside `others`.
StandInCandidate widened_level(const StandInCandidate& level, const Mesh& others,
                               const ThinParts& thin, double width, double floor) {
    StandInCandidate out = level;
    out.state = CandidateState::Measured;
    Composite boxes;
    out.clear_area = 0;
    for (size_t i = 0; i < thin.parts.size(); ++i) {
        const solids::ClearSolid clear = solids::widened_box(thin.parts[i], width, floor);
        boxes.solids.push_back(
            {true, clear.primitive, static_cast<uint16_t>(out.materials.size())});
        out.materials.push_back(
            solids::clear_material(solids::mean_material(thin.attributes[i]), clear.opacity));
        out.means.push_back(thin.attributes[i].shares);
        out.clear_area += solids::box_shell(clear.primitive.half_size).area;
    }
    Mesh mesh = others;
    append(mesh, tessellate(boxes), Affine());
    out.payload = std::make_shared<const Mesh>(std::move(mesh));
    return out;
}

}  // namespace

void propose_widened_levels(ProposalRound& round) {
    const MeasuredFinest& finest = round.finest;
    const Job& job = round.job;
    std::vector<StandInCandidate>& kept = round.candidates;
    if (finest.options.group || finest.options.environment)
        return;
    const Mesh& mesh = finest.mesh;
    const std::vector<Material>& materials = finest.materials;
    const double visible = finest.attributes.visible_area;
    const double widest = kWidest * finest.size;
    const double floor = bound_of(mesh.positions).box.low.z;
    const auto is_level =
        [&](const StandInCandidate& candidate) {  // no pruned mesh and no painted box
            return candidate.kind == Kind::Mesh && candidate.state != CandidateState::Pictured &&
                   candidate.materials.size() == materials.size() &&
                   candidate.mesh().colors.empty() == mesh.colors.empty();
        };
    if (!(visible < kSparsest * 4 * std::numbers::pi * finest.size * finest.size) ||
        materials.size() + kMostThin > std::numeric_limits<uint16_t>::max() ||
        std::none_of(kept.begin(), kept.end(), is_level))
        return;
    const ThinParts thin = thin_parts(finest, kMostlyThin * visible, job);
    if (thin.parts.empty())
        return;
    const Mesh beside = subset(mesh, not_of(thin.is_thin));
    std::optional<measure::AgreementReference> fine;
    const auto seen_from = [&](double width) {
        if (!fine)
            fine.emplace(mesh, finest.scene(), finest.skin, finest.options.seed,
                         measure::AgreementReference::kSide, job);
        StandInCandidate exact;  // but for the boxes
        exact.materials = materials;
        exact = widened_level(exact, beside, thin, width, floor);
        return fine->of(exact.mesh(), finest.skin_of(exact.materials), job).error;
    };
    std::vector<StandInCandidate> out;
    size_t most = mesh.triangles.size();
    bool wide = false;
    for (size_t i = 0; i < kept.size(); ++i) {
        const StandInCandidate& level = kept[i];
        if (!is_level(level) || !(level.error > thin.thickness && (wide || level.error < widest))) {
            if (is_level(level))
                most = level.mesh().triangles.size();
            out.push_back(level);
            continue;
        }
        const double next =
            i + 1 < kept.size() ? kept[i + 1].error : std::numeric_limits<double>::infinity();
        const Mesh others = rest_of(level.mesh(), thin, finest);
        double error = level.error;
        bool any = false;
        double width = std::min(level.error, widest);
        for (int step = 0; step < kMostWidths && width <= widest; ++step) {
            StandInCandidate made = widened_level(level, others, thin, width, floor);
            error = std::max({error, 0.5 * width, seen_from(width)});
            if (made.mesh().triangles.size() > most || !(error < next))
                break;
            match_brightness(made, finest, round.pictures, next, job);
            made.error = error;
            made.max_error = std::max(level.max_error, error);
            out.push_back(std::move(made));
            any = true;
            error *= kNext;
            width *= kRatio;
        }
        if (any)
            most = out.back().mesh().triangles.size();
        else if (!wide)
            out.push_back(level);  // else a level that is wide already serves instead
        wide = wide || any;
    }
    kept = std::move(out);
}

}  // namespace lodestone::hierarchy
