// SPDX-License-Identifier: GPL-3.0-or-later
// Every kind of stand-in of one painted mesh, its color and brightness found again by 16 times the
// rays. For tests and for tests/bench/sheets/replace_shapes.cpp.
#pragma once

#include "hierarchy/evaluators/brightness_match.h"
#include "hierarchy/evaluators/patch_error.h"
#include "hierarchy/finest.h"
#include "measure/pictures/picture_agreement.h"
#include "measure/visible/visible_attributes.h"
#include "simplify/simplify.h"
#include "solids/composite_replacement.h"
#include "solids/solid_replacement.h"
#include "solids/stand_in_material.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>

namespace lodestone {

/// How far off, in 255ths of display-encoded values, the worst channel.
struct Rematched {
    std::string kind;
    double color = 0;       // the mean color that it was made from
    double brightness = 0;  // all light it sends, beside the color of the whole
};

/// A color for each quarter, by slots.
inline std::vector<Material> paint(Mesh& mesh) {
    const glm::dvec3 middle = bound_of(mesh.positions).box.center();
    mesh.slots.clear();
    for (const Triangle& t : mesh.triangles) {
        const glm::dvec3 at = (glm::dvec3(mesh.positions[t.x]) + glm::dvec3(mesh.positions[t.y]) +
                               glm::dvec3(mesh.positions[t.z])) /
                              3.0;
        mesh.slots.push_back(
            static_cast<uint16_t>((at.x > middle.x ? 1 : 0) + (at.z > middle.z ? 2 : 0)));
    }
    std::vector<Material> out(4);
    const glm::dvec3 colors[] = {
        {0.5, 0.2, 0.1}, {0.15, 0.35, 0.1}, {0.7, 0.65, 0.5}, {0.1, 0.15, 0.4}};
    for (size_t i = 0; i < out.size(); ++i)
        out[i].base_color = colors[i];
    return out;
}

/// `mesh` is painted. `coarse`: by pictures as a build takes them of what is far from the finest
/// anyway, a quarter of the samples. Composites have at most `most_solids`. All are matched for
/// that error, over the radius.
inline std::vector<Rematched> rematched(Mesh mesh, bool coarse, size_t most_solids = 32,
                                        double error = 0) {
    const std::vector<Material> materials = paint(mesh);
    image::TexelCache texels;
    hierarchy::BuildSettings settings;
    const hierarchy::MeasuredFinest finest =
        hierarchy::measure_finest(mesh, materials, texels, settings, {settings.seed}, {});
    hierarchy::FinestPictures taken(finest);
    taken.take(
        mesh,
        coarse ? measure::AgreementReference::kCoarseSide : measure::AgreementReference::kSide, {});
    const Attributes wanted = finest.attributes;
    const Bound bound = bound_of(mesh.positions);
    const auto skin_of = [&](const std::vector<Material>& own) {
        return std::make_shared<const ray::MeshSkin>(own, texels);
    };
    const ray::SkinPtr skin = skin_of(materials);

    measure::VisibleOptions many;
    many.rays = 16 * settings.rays;
    many.seed = 77;
    const Attributes truth =
        measure::measure_visible(mesh, ray::MeshScene(mesh, skin), skin, many).attributes;
    std::deque<measure::AgreementReference> pictures;  // they stay where they are made
    for (const uint64_t seed : {101, 102, 103, 104})   // four times the samples each
        pictures.emplace_back(mesh, skin, seed, measure::AgreementReference::kSide);
    const auto off = [](const glm::dvec3& a, const glm::dvec3& b) {
        const glm::dvec3 miss =
            glm::abs(measure::LookPalette::encoded(a) - measure::LookPalette::encoded(b));
        return 255 * std::max({miss.x, miss.y, miss.z});
    };

    std::vector<Rematched> out;
    const auto add = [&](const std::string& name, hierarchy::StandInCandidate candidate,
                         Mesh drawn) {
        candidate.error = error * bound.radius;
        match_brightness(candidate, finest, taken, std::numeric_limits<double>::infinity(), {});
        glm::dvec3 light(0.0);
        for (const measure::AgreementReference& picture : pictures)
            light += picture.of(drawn, skin_of(candidate.materials)).light /
                     static_cast<double>(pictures.size());
        out.push_back(
            {name, off(wanted.color, truth.color), off(truth.color, truth.color / light)});
    };
    const auto add_solid = [&](const std::string& name, Kind kind, const Primitive& primitive,
                               double opacity) {
        hierarchy::StandInCandidate candidate;
        candidate.kind = kind;
        candidate.payload = primitive;
        candidate.materials = {solids::clear_material(solids::mean_material(wanted), opacity)};
        add(name, candidate,
            kind == Kind::Box ? tessellate_box(primitive) : tessellate_ellipsoid(primitive, 4));
    };
    if (const auto box = solids::fit_box(wanted, bound))
        add_solid("box", Kind::Box, *box, 1);
    if (const auto ellipsoid = solids::fit_ellipsoid(wanted, bound))
        add_solid("ellipsoid", Kind::Ellipsoid, *ellipsoid, 1);
    if (const auto box = solids::fit_clear_box(wanted, bound))
        add_solid("clear box", Kind::Box, box->primitive, box->opacity);
    if (const auto ellipsoid = solids::fit_clear_ellipsoid(wanted, bound))
        add_solid("clear ellipsoid", Kind::Ellipsoid, ellipsoid->primitive, ellipsoid->opacity);
    const auto add_composites = [&](const std::string& name,
                                    const std::vector<solids::ClusteredComposite>& levels) {
        for (const solids::ClusteredComposite& level : levels) {
            if (level.composite.solids.size() > most_solids)
                break;
            hierarchy::StandInCandidate candidate;
            candidate.kind = Kind::Composite;
            candidate.payload = std::make_shared<const Composite>(level.composite);
            for (size_t i = 0; i < level.attributes.size(); ++i)
                candidate.materials.push_back(solids::clear_material(
                    solids::mean_material(level.attributes[i]), level.opacities[i]));
            add(name + " " + std::to_string(level.composite.solids.size()), candidate,
                tessellate(level.composite, 3));
        }
    };
    add_composites("composite", solids::composites(mesh, skin, wanted, {settings.seed}));
    if (!solids::boxlike(wanted))
        add_composites("clear composite",
                       solids::clear_composites(mesh, skin, {}, wanted, {settings.seed}));
    hierarchy::StandInCandidate collapsed;
    collapsed.payload = std::make_shared<const Mesh>(
        simplify::simplify_mesh(mesh, std::max<size_t>(8, mesh.triangles.size() / 10)));
    collapsed.materials = materials;
    if (shows_as_much(collapsed.mesh(), finest, {}))  // else it is none
        add("collapsed", collapsed, collapsed.mesh());
    return out;
}

}  // namespace lodestone
