// SPDX-License-Identifier: GPL-3.0-or-later
// How alike the outlines of shapes and of their replacements are: replace_shapes FILE.ply...
// Prints JSON: for each shape and replacement the mean intersection over union of 20 silhouettes,
// how far off area, centroid and tensor of solids and composites are, in percent, by a million
// other rays from the thing as drawn, and color and brightness, in 255ths, by 16 times the rays.
#include "base/files.h"
#include "format/ply.h"
#include "hierarchy/build_settings.h"
#include "measure/deviation/surface_deviation.h"
#include "measure/visible/visible_attributes.h"
#include "model/representation.h"
#include "povray_export/scene/povray_costs.h"
#include "scenes/rematched_stand_ins.h"
#include "simplify/simplify.h"
#include "solids/composite_replacement.h"
#include "solids/keep_on_floor.h"
#include "solids/solid_replacement.h"
#include "solids/stand_in_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>

using namespace lodestone;

namespace {

constexpr int kViews = 20;
constexpr int kPixels = 96;
constexpr uint64_t kRays = uint64_t{1} << 20u;  // of what is measured again
constexpr int kSubdivisions = 5;                // of an ellipsoid measured again

/// Points spread over the sphere by the golden angle.
glm::dvec3 direction(int number) {
    const double z = 1 - 2 * (number + 0.5) / kViews;
    const double turn = 2.399963229728653 * number;
    const double radius = std::sqrt(1 - z * z);
    return {radius * std::cos(turn), radius * std::sin(turn), z};
}

/// One bit a pixel of all views of a square around the bound.
std::vector<bool> silhouettes(const Mesh& mesh, const Bound& bound) {
    const ray::MeshScene scene(mesh);
    std::vector<bool> out;
    for (int view = 0; view < kViews; ++view) {
        const glm::dvec3 back = direction(view);
        const glm::dvec3 right = glm::normalize(
            glm::cross(std::abs(back.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0), back));
        const glm::dvec3 up = glm::cross(back, right);
        for (int y = 0; y < kPixels; ++y) {
            for (int x = 0; x < kPixels; ++x) {
                const double across = 1.5 * bound.radius * (2 * (x + 0.5) / kPixels - 1);
                const double along = 1.5 * bound.radius * (2 * (y + 0.5) / kPixels - 1);
                out.push_back(scene.occluded(
                    bound.center + across * right + along * up + 8 * bound.radius * back, -back));
            }
        }
    }
    return out;
}

/// Mean over the views.
double overlap(const std::vector<bool>& a, const std::vector<bool>& b) {
    double sum = 0;
    constexpr size_t kView = static_cast<size_t>(kPixels) * kPixels;
    for (size_t view = 0; view < kViews; ++view) {
        double both = 0;
        double either = 0;
        for (size_t i = view * kView; i < (view + 1) * kView; ++i) {
            both += a[i] && b[i] ? 1 : 0;
            either += a[i] || b[i] ? 1 : 0;
        }
        sum += either > 0 ? both / either : 1;
    }
    return sum / kViews;
}

Primitive bounding(const Mesh& mesh, const glm::dmat3& axes) {
    Box3 box;
    for (const Triangle& t : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner)
            box.add(glm::transpose(axes) * glm::dvec3(mesh.positions[t[corner]]));
    }
    return {axes * box.center(), axes, glm::max(0.5 * box.size(), glm::dvec3(1e-6))};
}

/// Bytes of the cheapest level of a mesh whose error is at most this.
double mesh_bytes_within(const std::vector<Mesh>& levels, const std::vector<double>& errors,
                         double error) {
    double best = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < levels.size(); ++i) {
        if (errors[i] <= error)
            best = std::min(best, static_cast<double>(levels[i].triangles.size() *
                                                      povray::povray_costs().triangle_bytes));
    }
    return best;
}

/// In percent: area, centroid over the radius of gyration, tensor over the true trace, each over
/// its own where the size is not asked for.
std::array<double, 3> misses(const Attributes& now, const Attributes& truth, bool size) {
    const auto trace = [](const glm::dmat3& m) { return m[0][0] + m[1][1] + m[2][2]; };
    const double over = trace(size ? truth.moments : now.moments);
    double square = 0;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 off = now.moments[i] / over - truth.moments[i] / trace(truth.moments);
        square += glm::dot(off, off);
    }
    return {100 * std::abs(now.visible_area / truth.visible_area - 1),
            100 * glm::length(now.centroid - truth.centroid) / truth.radius_of_gyration(),
            100 * std::sqrt(square)};
}

/// What stands for a shape, and what of it can be seen.
using Found = std::map<std::string, double>;

void measure_again(Found& found, const std::string& name, const Mesh& drawn, double opacity,
                   const Attributes& truth) {
    measure::VisibleOptions options;
    options.rays = kRays;
    options.seed = 99;
    const bool clear = opacity < 1;
    const std::vector<Material> materials{solids::clear_material({}, opacity)};
    image::TexelCache texels;
    const auto skin = std::make_shared<const ray::MeshSkin>(materials, texels);
    const ray::MeshScene scene(drawn, skin);
    // Of a flock one in twenty lines finds anything, and all that leave its surface. But what hides
    // nothing of itself would be measured without rays.
    if (measure::VisibleSampler(drawn, scene, options.seed).shows_all())
        options.casting = measure::CastMethod::FromBound;
    const std::array<double, 3> off =
        misses(measure::measure_visible(drawn, scene, skin, options).attributes, truth, clear);
    found[name + " area off"] = off[0];
    found[name + " centroid off"] = off[1];
    found[name + " tensor off"] = off[2];
}

/// Single solids, of the attributes that a build finds: as they are matched, and as they stand.
void measure_solids(Found& found, const Mesh& mesh, const Bound& bound, const Attributes& truth) {
    const hierarchy::BuildSettings settings;
    measure::VisibleOptions options;
    options.rays = settings.rays;
    options.seed = settings.seed;
    const Attributes wanted = measure::measure_visible(mesh, {}, options).attributes;
    const auto surely = [&](uint64_t more, double settled) {
        measure::VisibleOptions many = options;
        many.rays *= more;
        many.settled = settled;
        return measure::measure_visible(mesh, {}, many).attributes;
    };
    const Attributes sure = surely(solids::kRaysOfSolid, solids::kSettled);
    const Attributes surer = surely(solids::kRaysOfClear, 0);
    const auto add = [&](const std::string& name, bool box, const Primitive& primitive,
                         double opacity) {
        const auto drawn = [&](const Primitive& one) {
            return tessellate(Composite{{{box, one, 0}}}, kSubdivisions);
        };
        measure_again(found, name, drawn(primitive), opacity, truth);
        measure_again(found, name + ", standing",
                      drawn(solids::kept_above(primitive, box, bound.box.low.z)), opacity, truth);
    };
    const auto solid = [&](const std::string& name, bool box, const Primitive& fitted) {
        add(name, box, solids::settled(fitted, wanted, sure), 1);
    };
    const auto clear = [&](const std::string& name, bool box, const solids::ClearSolid& fitted) {
        const solids::ClearSolid now = solids::settled(fitted, wanted, surer);
        add(name, box, now.primitive, now.opacity);
    };
    const double radius = std::sqrt(wanted.visible_area / (4 * std::numbers::pi));
    solid("sphere", false, {wanted.centroid, glm::dmat3(1.0), glm::dvec3(radius)});
    if (const auto box = solids::fit_box(wanted, bound))
        solid("box", true, *box);
    if (const auto ellipsoid = solids::fit_ellipsoid(wanted, bound))
        solid("ellipsoid", false, *ellipsoid);
    if (const auto box = solids::fit_clear_box(wanted, bound))
        clear("clear box", true, *box);
    if (const auto ellipsoid = solids::fit_clear_ellipsoid(wanted, bound))
        clear("clear ellipsoid", false, *ellipsoid);
}

void compare_shape(const std::filesystem::path& path, bool last) {
    Problems problems;
    const Mesh mesh = format::read_ply(read_file(path), path.filename().string(), problems);
    const Bound bound = bound_of(mesh.positions);
    measure::VisibleOptions options;
    options.rays = 65536;
    const Attributes attributes = measure::measure_visible(mesh, {}, options).attributes;
    const auto ball = [&](double radius) {
        return tessellate_ellipsoid({attributes.centroid, glm::dmat3(1.0), glm::dvec3(radius)}, 4);
    };
    std::map<std::string, Mesh> stand_ins;
    stand_ins["sphere"] = ball(std::sqrt(attributes.visible_area / (4 * std::numbers::pi)));
    stand_ins["bounding box"] = tessellate_box(bounding(mesh, glm::dmat3(1.0)));
    stand_ins["oriented bound"] = tessellate_box(bounding(mesh, attributes.axes));
    const auto box = solids::fit_box(attributes, bound);
    const auto ellipsoid = solids::fit_ellipsoid(attributes, bound);
    if (box)
        stand_ins["box"] = tessellate_box(*box);
    if (ellipsoid)
        stand_ins["ellipsoid"] = tessellate_ellipsoid(*ellipsoid, 4);

    const std::vector<bool> truth = silhouettes(mesh, bound);
    Found found;
    for (const auto& [name, stand_in] : stand_ins)
        found[name] = overlap(truth, silhouettes(stand_in, bound));
    const measure::DeviationReference reference(mesh, {4096, 4096, 1});
    if (box && ellipsoid) {
        const double off_box = reference.of(stand_ins["box"]).error;
        const double off_ellipsoid = reference.of(stand_ins["ellipsoid"]).error;
        found["ours, by error"] = found[off_box < off_ellipsoid ? "box" : "ellipsoid"];
        found["ours, by moment"] = found[solids::boxlike(attributes) ? "box" : "ellipsoid"];
        found["oracle"] = std::max(found["box"], found["ellipsoid"]);
    } else if (box || ellipsoid) {
        const double only = found[box ? "box" : "ellipsoid"];
        found["ours, by error"] = found["ours, by moment"] = found["oracle"] = only;
    }
    std::vector<size_t> targets;
    auto target = static_cast<double>(mesh.triangles.size());
    while ((target *= 0.8) >= 4) {
        if (targets.empty() || static_cast<size_t>(target) < targets.back())
            targets.push_back(static_cast<size_t>(target));
    }
    const std::vector<Mesh> levels =
        targets.empty() ? std::vector<Mesh>{} : simplify::simplify_chain(mesh, targets);
    std::vector<double> errors;
    errors.reserve(levels.size());
    for (const Mesh& level : levels)
        errors.push_back(reference.of(level).error);
    options.rays = kRays;
    options.seed = 98;
    const Attributes known = measure::measure_visible(mesh, {}, options).attributes;
    measure_solids(found, mesh, bound, known);
    for (const solids::ClusteredComposite& level :
         solids::composites(mesh, nullptr, attributes, {})) {
        const size_t count = level.composite.solids.size();
        const Mesh solid = tessellate(level.composite, 3);
        const std::string name = "composite " + std::to_string(count);
        found[name] = overlap(truth, silhouettes(solid, bound));
        measure_again(found, name, tessellate(level.composite, kSubdivisions), 1, known);
        const double error = reference.of(solid).error;
        const auto bytes = static_cast<double>(count * povray::povray_costs().primitive_bytes);
        found[name + " error"] = error / bound.radius;
        const double other = mesh_bytes_within(levels, errors, error);
        found[name + " bytes over a mesh's"] = std::isfinite(other) ? bytes / other : 0;
    }
    for (const Rematched& again : rematched(mesh, false)) {
        found[again.kind + " color off"] = again.color;
        found[again.kind + " brightness off"] = again.brightness;
    }
    for (const Rematched& again : rematched(mesh, true))
        found[again.kind + " (coarse) brightness off"] = again.brightness;
    std::printf("%s\"%s\": {\"normal moment\": %.4f", "  ", path.stem().c_str(),
                attributes.normal_moment);
    for (const auto& [name, value] : found)
        std::printf(", \"%s\": %.4f", name.c_str(), value);
    std::printf("}%s\n", last ? "" : ",");
}

}  // namespace

int main(int count, char** arguments) {
    try {
        std::printf("{\n");
        for (int i = 1; i < count; ++i)
            compare_shape(arguments[i], i + 1 == count);
        std::printf("}\n");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "replace_shapes: %s\n", error.what());
        return 1;
    }
    return 0;
}
