// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/proposers/painted_boxes.h"

#include "solids/composite_replacement.h"
#include "solids/keep_on_floor.h"
#include "solids/stand_in_material.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::hierarchy {
namespace {

// The steps of a channel's square root that colors are rounded to.
// Taste: more are nearer to the finest, and more colors, which the renderer keeps one by one.
constexpr double kColorSteps = 24;
// Law: a box has six sides of two triangles.
constexpr size_t kTrianglesOfBox = 12;
// Law: tessellate_box() gives each side four vertices of its own.
constexpr uint32_t kVerticesOfSide = 4;

/// The mesh of solids, and for each of its triangles the number of its side.
struct SidedMesh {
    Mesh mesh;
    std::vector<uint32_t> side_of;
    size_t sides = 0;
};

SidedMesh sided(const Composite& composite) {
    // A cluster that is no box is a ball of 20 triangles.
    // Taste: one more is four times the triangles.
    constexpr int kSubdivisions = 0;
    SidedMesh out;
    for (const Solid& solid : composite.solids) {
        const Mesh one = tessellate(Composite{{solid}}, kSubdivisions);
        const auto first = static_cast<uint32_t>(out.sides);
        for (const Triangle& t : one.triangles)
            out.side_of.push_back(first + (solid.box ? t.x / kVerticesOfSide : 0));
        out.sides = *std::max_element(out.side_of.begin(), out.side_of.end()) + size_t{1};
        append(out.mesh, one, {});
    }
    out.mesh.slots.clear();
    return out;
}

double rounded(double share) {
    const double step = std::round(std::sqrt(share) * kColorSteps) / kColorSteps;
    return step * step;
}

/// Whether a crowd is so wide that it stands on something, as a town does: from below nobody sees
/// it.
bool lies_flat(const Box3& box) {
    // The height over the width.
    // Taste: a larger value takes heaps for towns.
    constexpr double kFlat = 0.5;
    const glm::dvec3 size = box.size();
    return size.z <= kFlat * std::min(size.x, size.y);
}

/// Forgets the colors of sides that face down: from above they are seen edge on, and told by chance.
void forget_undersides(const SidedMesh& boxes, std::vector<glm::dvec4>& colors) {
    // The least cosine between a side's normal and straight down.
    // Taste: a larger value keeps the chance colors of tilted boxes.
    constexpr double kDown = 0.5;
    std::vector<double> down(boxes.sides, 0);
    std::vector<double> all(boxes.sides, 0);
    for (size_t i = 0; i < boxes.side_of.size(); ++i) {
        const glm::dvec3 area = area_vector(boxes.mesh, i);
        down[boxes.side_of[i]] -= area.z;
        all[boxes.side_of[i]] += glm::length(area);
    }
    for (size_t side = 0; side < boxes.sides; ++side) {
        if (down[side] > kDown * all[side])
            colors[side] = glm::dvec4(0.0);
    }
}

/// Gives all sides their colors; those that no picture shows have the mean one.
StandInCandidate painted(SidedMesh boxes, const std::vector<glm::dvec4>& colors,
                         const MeasuredFinest& finest) {
    glm::dvec3 most(0.0);
    glm::dvec4 sum(0.0);
    for (const glm::dvec4& side : colors) {
        most = glm::max(most, glm::dvec3(side));
        sum += glm::dvec4(side.w * glm::dvec3(side), side.w);
    }
    const glm::dvec3 mean = glm::dvec3(sum) / std::max(sum.w, 1e-9);
    Material material = solids::mean_material(finest.attributes);
    material.base_color = glm::min(most, glm::dvec3(1.0));
    material.vertex_colors = true;
    boxes.mesh.colors.assign(boxes.mesh.positions.size(), glm::vec4(1.0f));
    for (size_t i = 0; i < boxes.side_of.size(); ++i) {
        glm::vec4 color(1.0f);
        const glm::dvec4& shown = colors[boxes.side_of[i]];
        const glm::dvec3 side = shown.w > 0 ? glm::dvec3(shown) : mean;
        for (int k = 0; k < 3; ++k) {
            if (material.base_color[k] > 0)
                color[k] =
                    static_cast<float>(rounded(std::min(1.0, side[k] / material.base_color[k])));
        }
        for (int corner = 0; corner < 3; ++corner)
            boxes.mesh.colors[boxes.mesh.triangles[i][corner]] = color;
    }
    StandInCandidate out;
    out.payload = std::make_shared<const Mesh>(std::move(boxes.mesh));
    out.materials = {std::move(material)};
    out.means = {finest.attributes.shares};
    return out;
}

}  // namespace

void propose_painted_boxes(ProposalRound& round) {
    // Taste: more rays match the boxes better, in time in proportion.
    constexpr uint32_t kRays = 1024;
    // Taste: more samples cluster what is seen better, in time in proportion.
    constexpr uint32_t kSamples = 4096;
    // The most boxes.
    // Taste: more come nearer and take longer to fit.
    constexpr size_t kMost = 128;
    const ReplacedObject& whole = round.limits.whole;
    const MeasuredFinest& finest = round.finest;
    if (!whole.alike || whole.ground || finest.options.environment || finest.glows ||
        finest.refracts() || !finest.solid() || is_foliage(round.crowd))
        return;
    const Mesh& mesh = round.limits.mesh;
    solids::CompositeOptions options{finest.options.seed};
    options.boxes = true;
    options.shape = false;
    options.rounds = 0;
    options.rays = kRays;
    options.samples = kSamples;
    options.most =
        std::min(kMost, triangles_for(whole.most, whole.uses, whole.costs) / kTrianglesOfBox);
    std::vector<Composite> all;
    for (solids::ClusteredComposite& level :
         solids::composites(mesh, finest.skin, finest.attributes, options, round.job))
        all.push_back(std::move(level.composite));
    if (const auto box = solids::fit_box(finest.attributes, whole.bound))
        all.push_back({{{true, solids::kept_above(*box, true, whole.bound.box.low.z), 0}}});
    if (all.empty())
        return;
    using Pictures = measure::AgreementReference;
    const bool stands = lies_flat(whole.bound.box);
    const Pictures& judged = stands ? round.pictures.from_above(mesh, round.job)
                                    : round.pictures.take(mesh, Pictures::kCoarseSide, round.job);
    // Others than those that they are judged by.
    const Pictures shown(
        mesh, ray::MeshScene(mesh, finest.skin), finest.skin, finest.options.seed + 1,
        Pictures::kCoarseSide, round.job,
        stands ? measure::PictureViews::FromAbove : measure::PictureViews::AllAround);
    const ray::SkinPtr plain = finest.skin_of({});
    for (const Composite& composite : all) {
        SidedMesh boxes = sided(composite);
        std::vector<glm::dvec4> colors = shown.side_colors(
            shown.trace(boxes.mesh, plain, round.job), boxes.side_of, boxes.sides);
        if (stands)
            forget_undersides(boxes, colors);
        StandInCandidate candidate = painted(std::move(boxes), colors, finest);
        compare_pictures(candidate, finest, judged, round.job);
        round.candidates.push_back(std::move(candidate));
    }
    round.painted = true;
}

}  // namespace lodestone::hierarchy
