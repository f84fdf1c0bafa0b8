// SPDX-License-Identifier: GPL-3.0-or-later
// What crowds cost from afar: `cmake --build build/release --target bench_crowds`, then
// build/release/tests/bench_crowds [--store FOLDER] [--pictures FOLDER] [--houses NUMBER]. Houses
// of twelve boxes stand 14 m apart in blocks of 8 x 8, the blocks in towns of 8 x 8, and so on; 16
// of them differ. Two of the cities are one mesh a material, as exporters join houses. Each city is
// built (all of its levels, into the store), then looked at from an oblique angle in which it is
// 1,000, 100 and 30 pixels wide. What a picture uses should be bounded by its pixels:
// (occurrences + solids + triangles / 100) a covered pixel at most 2, and hardly
// more for ten times as many houses. Pictures of the cut and of full detail (crowd_pictures.h) are
// compared: their SSIM, and by how much the cut is brighter on covered pixels. With --houses only
// cities of so many are looked at, with --pictures the pictures are kept.
#include "base/clock.h"
#include "base/random.h"
#include "base/text.h"
#include "bench/speed/crowd_pictures.h"
#include "choose/criterion.h"
#include "choose/cut.h"
#include "group/loose_parts.h"
#include "hierarchy/hierarchy_build.h"
#include "image/compare_images.h"
#include "ray/mesh_scene.h"
#include "scenes/small_models.h"
#include "segment/store.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>

using namespace lodestone;

namespace {

constexpr int kHouses = 16;
constexpr size_t kAlong = 8;  // things along a side of a block
constexpr double kStep = 14;

constexpr size_t kMostPictured = 10000;  // houses of a city whose pictures are taken

struct CrowdOptions {
    std::string store;
    std::string pictures;  // empty: they are not kept
    size_t houses = 0;     // 0: all cities
};

struct CityKind {
    size_t houses;
    int materials;
    double gap;           // metres between the walls of mean houses
    bool meshes = false;  // one mesh a material, as exporters join them, not an object a house
};

Mesh house(PcgRandom& random, double width, int materials) {
    const auto between = [&](double low, double high) {
        return low + (high - low) * random.uniform();
    };
    const glm::dvec3 size(width * between(0.9, 1), width * between(0.9, 1), between(7, 14));
    Mesh out = shapes::box({0, 0, 0}, size);
    for (int part = 1; part < 12; ++part) {
        const glm::dvec3 low(size.x * between(0, 0.7), size.y * between(0, 0.7),
                             size.z * between(0.2, 0.95));
        const glm::dvec3 part_size(0.3 * size.x, 0.3 * size.y, size.z * between(0.1, 0.3));
        append(out, shapes::box(low, low + part_size), {}, static_cast<uint16_t>(part % materials));
    }
    return out;
}

Model city(const CityKind& kind) {
    Model model;
    model.costs = povray::povray_costs();
    PcgRandom random(1, 1);
    std::vector<uint32_t> materials;
    for (int i = 0; i < kind.materials; ++i) {
        const auto channel = [&] { return 0.1 + 0.7 * random.uniform(); };
        materials.push_back(static_cast<uint32_t>(model.materials.size()));
        model.materials.push_back(
            models::colored("wall " + std::to_string(i), {channel(), channel(), channel()}));
    }
    std::vector<ObjectIndex> houses;
    for (int i = 0; i < kHouses; ++i) {
        const ObjectIndex one = models::add_leaf(model, "house " + std::to_string(i),
                                                 house(random, kStep - kind.gap, kind.materials));
        model.materials.pop_back();
        Representation& finest = model.objects[one].representations[0];
        finest.materials = materials;
        summarize(finest, model);
        houses.push_back(one);
    }
    // Every block is one of its own: nothing is shared but houses.
    const auto block = [&](double step, size_t most, const auto& thing) {
        std::vector<Placement> placements;
        for (size_t i = 0; i < std::min<size_t>(most, kAlong * kAlong); ++i) {
            const size_t line = i / kAlong;
            const auto x = static_cast<double>(i % kAlong);
            const auto y = static_cast<double>(line);
            placements.push_back(
                {thing(), models::moved(step * x, step * y, 0), "thing " + std::to_string(i)});
        }
        return models::add_group(model, "block " + std::to_string(model.objects.size()),
                                 std::move(placements));
    };
    std::vector<ObjectIndex> row;
    for (size_t made = 0; made < kind.houses; made += kAlong * kAlong)
        row.push_back(block(kStep, kind.houses - made,
                            [&] { return houses[random.next() % houses.size()]; }));
    for (double step = kStep * static_cast<double>(kAlong); row.size() > 1;
         step *= static_cast<double>(kAlong)) {
        std::vector<ObjectIndex> above;
        for (size_t at = 0; at < row.size();)
            above.push_back(block(step, row.size() - at, [&] { return row[at++]; }));
        row = std::move(above);
    }
    model.root = row[0];
    summarize_assemblies(model, bottom_up(model));
    return model;
}

/// The same city as one mesh a material, taken apart as a build does.
Model joined(const Model& objects) {
    Model model;
    model.costs = objects.costs;
    std::map<uint32_t, Mesh> meshes;  // by material
    for_each_occurrence(objects, [&](const Occurrence& one) {
        const Representation& finest = objects.objects[one.object].representations[0];
        const Mesh& house = finest.mesh();
        for (uint32_t slot = 0; slot < finest.materials.size(); ++slot) {
            std::vector<uint8_t> own(house.triangles.size());
            for (size_t i = 0; i < own.size(); ++i)
                own[i] = house.slot(i) == slot ? 1 : 0;
            Mesh part = subset(house, own);
            part.slots.clear();
            if (!part.empty())
                append(meshes[finest.materials[slot]], part, one.world);
        }
    });
    std::vector<Placement> placements;
    for (auto& [material, mesh] : meshes) {
        mesh.slots.clear();
        const std::string name = objects.materials[material].name;
        const ObjectIndex leaf =
            models::add_leaf(model, name, std::move(mesh), objects.materials[material]);
        placements.push_back({leaf, Affine{}, name});
    }
    model.root = models::add_group(model, "city", std::move(placements));
    group::split_loose_parts(model, group::leaves_of(model), {}, {});
    summarize_assemblies(model, bottom_up(model));
    return model;
}

/// An orthographic camera, as the pictures', that shows the model so many pixels wide, from 27
/// degrees above.
View view_of(const Bound& bound, double pixels) {
    const glm::dvec3 towards = glm::normalize(glm::dvec3(0.5, -1, 0.56));
    View view;
    Camera& camera = view.camera;
    camera.orthographic = true;
    camera.position = bound.center + 3 * bound.radius * towards;
    camera.direction = -towards;
    camera.right = 2 * bound.radius * glm::normalize(glm::cross(-towards, glm::dvec3(0, 0, 1)));
    camera.up = glm::cross(camera.right, -towards);
    view.width = view.height = static_cast<int>(pixels);
    return view;
}

/// The pixels of a picture that boxes around the houses cover.
size_t covered_pixels(const Model& model, double pixels) {
    Mesh boxes;
    for_each_occurrence(model, [&](const Occurrence& one) {
        const Box3 box = model.objects[one.object].bound().box;
        append(boxes, shapes::box(box.low, box.high), one.world);
    });
    const Bound& bound = model.objects[model.root].bound();
    const View view = view_of(bound, pixels);
    const ray::MeshScene scene(boxes);
    const auto side = static_cast<int>(pixels);
    const double pixel = 2 * bound.radius / pixels;
    const glm::dvec3 right = glm::normalize(view.camera.right);
    const glm::dvec3 up = glm::normalize(view.camera.up);
    size_t covered = 0;
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            const glm::dvec3 at = bound.center + (column + 0.5 - pixels / 2) * pixel * right +
                                  (row + 0.5 - pixels / 2) * pixel * up;
            covered +=
                scene.occluded(at - 3 * bound.radius * view.camera.direction, view.camera.direction)
                    ? 1
                    : 0;
        }
    }
    return covered;
}

void measure_city(const CityKind& kind, const CrowdOptions& options) {
    const segment::Store store(options.store);
    Model model = kind.meshes ? joined(city(kind)) : city(kind);
    Problems problems;
    hierarchy::BuildSettings settings;
    settings.rebuild = true;
    const double start = cpu_seconds();
    hierarchy::build_hierarchy(model, store, settings, problems, {});
    const double built = cpu_seconds() - start;
    for (const double pixels : {1000.0, 100.0, 30.0}) {
        const Bound& bound = model.objects[model.root].bound();
        const choose::Cut cut = choose::choose_cut(model, view_of(bound, pixels));
        size_t solids = 0;
        for (const uint32_t index : cut.chosen) {
            const choose::CutNode& node = cut.nodes[index];
            const Representation& drawn = model.objects[node.object].representations[node.lod];
            if (drawn.summary.kind == Kind::Composite)
                solids += drawn.composite().solids.size();
            else if (drawn.summary.kind != Kind::Mesh)
                ++solids;
        }
        const size_t covered = covered_pixels(model, pixels);
        std::string looks = "- | -";
        if (kind.houses <= kMostPictured) {
            View fine = view_of(bound, pixels);
            fine.pixel_error = 0;
            const auto side = static_cast<int>(pixels);
            const auto picture = [&](const choose::Cut& of) {
                return bench::picture_of(bench::drawn_mesh(model, of, store), bound, fine.camera,
                                         side);
            };
            const image::Image full = picture(choose::choose_cut(model, fine));
            const image::Image ours = picture(cut);
            std::array<char, 64> numbers{};
            std::snprintf(numbers.data(), numbers.size(), "%.3f | %+.1f",
                          image::compare(full, ours).ssim,
                          bench::mean_shown(ours, full) - bench::mean_shown(full, full));
            looks = numbers.data();
            if (!options.pictures.empty()) {
                const std::string name =
                    text(options.pictures, "/", kind.houses, kind.meshes ? "m_" : "_",
                         kind.materials, "_", static_cast<int>(kind.gap), "_", side);
                image::write_png(name + "_full.png", full);
                image::write_png(name + "_cut.png", ours);
            }
        }
        const double used = static_cast<double>(cut.chosen.size() + solids) +
                            static_cast<double>(cut.triangles) / 100;
        std::printf("| %zu | %s | %d | %.0f | %.1f | %.0f | %zu | %zu | %zu | %zu | %.2f | %s |\n",
                    kind.houses, kind.meshes ? "meshes" : "objects", kind.materials, kind.gap,
                    built, pixels, covered, cut.chosen.size(), solids,
                    static_cast<size_t>(cut.triangles),
                    used / static_cast<double>(std::max<size_t>(1, covered)), looks.c_str());
        std::fflush(stdout);
    }
}

}  // namespace

int main(int count, char** arguments) {
    CrowdOptions options;
    for (int i = 1; i + 1 < count; i += 2) {
        const std::string name = arguments[i];
        if (name == "--store")
            options.store = arguments[i + 1];
        else if (name == "--pictures")
            options.pictures = arguments[i + 1];
        else if (name == "--houses")
            options.houses = std::strtoul(arguments[i + 1], nullptr, 10);
    }
    const bool own = options.store.empty();
    if (own)
        options.store =
            (std::filesystem::temp_directory_path() / "lodestone_bench_crowds").string();
    std::printf(
        "| houses | made of | materials | gap, m | build, CPU s | pixels wide | covered | "
        "occurrences | solids | triangles | used a covered pixel (<= 2) | SSIM | light, 255ths |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    try {
        for (const CityKind& kind :
             {CityKind{1000, 8, 4}, CityKind{10000, 8, 4}, CityKind{10000, 1, 4},
              CityKind{10000, 8, 0}, CityKind{100000, 8, 4}, CityKind{1000, 8, 4, true},
              CityKind{10000, 8, 4, true}}) {
            if (options.houses == 0 || options.houses == kind.houses)
                measure_city(kind, options);
        }
        if (own)
            std::filesystem::remove_all(options.store);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
