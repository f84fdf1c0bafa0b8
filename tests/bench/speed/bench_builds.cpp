// SPDX-License-Identifier: GPL-3.0-or-later
// What a build does again after little has changed: `cmake --build build/release --target
// bench_builds`, then build/release/tests/bench_builds [FOLDER]. A town of unique houses of twelve
// boxes, in blocks of 8 x 8 on a terrain, is built; then one thing is changed at a time, built,
// changed back, and built again. At last a thousand small unique objects are built. What did not
// change should cost nothing: no object built and no byte written.
#include "base/clock.h"
#include "base/random.h"
#include "hierarchy/hierarchy_build.h"
#include "ray/mesh_scene.h"
#include "scenes/small_models.h"
#include "segment/store.h"

#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>

using namespace lodestone;
namespace fs = std::filesystem;

namespace {

constexpr size_t kAlong = 8;  // houses along a side of a block
constexpr size_t kBlocks = 4;
constexpr size_t kTerrainSide = 160;  // grid cells along a side
constexpr size_t kSmallObjects = 1000;
constexpr double kStep = 14;  // metres from house to house

Mesh house(PcgRandom& random) {
    const auto between = [&](double low, double high) {
        return low + (high - low) * random.uniform();
    };
    const glm::dvec3 size(between(8, 12), between(8, 12), between(7, 14));
    Mesh out = shapes::box({0, 0, 0}, size);
    for (int part = 1; part < 12; ++part) {
        const glm::dvec3 low(size.x * between(0, 0.7), size.y * between(0, 0.7),
                             size.z * between(0.2, 0.95));
        const glm::dvec3 part_size(0.3 * size.x, 0.3 * size.y, size.z * between(0.1, 0.3));
        append(out, shapes::box(low, low + part_size), {}, static_cast<uint16_t>(part % 2));
    }
    return out;
}

/// Houses of two materials each: "wall", which all share, and a color of four.
ObjectIndex add_house(Model& model, PcgRandom& random, size_t number) {
    const ObjectIndex index =
        models::add_leaf(model, "house " + std::to_string(number), house(random));
    model.materials.pop_back();
    Representation& finest = model.objects[index].representations[0];
    finest.materials = {0, static_cast<uint32_t>(1 + number % 4)};
    summarize(finest, model);
    return index;
}

Model painted() {
    Model model;
    model.materials.push_back(models::colored("wall", {0.7, 0.7, 0.65}, 0.8));
    model.materials.push_back(models::colored("red", {0.6, 0.2, 0.1}, 0.6));
    model.materials.push_back(models::colored("green", {0.2, 0.5, 0.2}, 0.6));
    model.materials.push_back(models::colored("blue", {0.1, 0.2, 0.6}, 0.6));
    model.materials.push_back(models::colored("ochre", {0.6, 0.4, 0.1}, 0.6));
    return model;
}

Model town() {
    Model model = painted();
    PcgRandom random(1, 1);
    std::vector<Placement> blocks;
    for (size_t block = 0; block < kBlocks; ++block) {
        std::vector<Placement> houses;
        for (size_t i = 0; i < kAlong * kAlong; ++i) {
            const size_t row = i / kAlong;
            const size_t number = block * kAlong * kAlong + i;
            houses.push_back({add_house(model, random, number),
                              models::moved(kStep * static_cast<double>(i % kAlong),
                                            kStep * static_cast<double>(row), 0),
                              "house " + std::to_string(number)});
        }
        const double apart = kStep * static_cast<double>(kAlong * block);
        blocks.push_back({models::add_group(model, "block " + std::to_string(block), houses),
                          models::moved(apart, 0, 0), "block " + std::to_string(block)});
    }
    const ObjectIndex land = models::add_leaf(model, "terrain", shapes::terrain(kTerrainSide),
                                              models::colored("earth", {0.3, 0.25, 0.1}, 0.9));
    Placement under{land, models::moved(0, -1000, 0), "terrain"};
    under.transform.linear *= 500.0;
    blocks.push_back(under);
    model.root = models::add_group(model, "town", blocks);
    model.cameras.emplace_back();
    model.cameras.back().name = "Camera";
    return model;
}

Model small_objects() {
    Model model = painted();
    PcgRandom random(2, 1);
    std::vector<Placement> houses;
    for (size_t i = 0; i < kSmallObjects; ++i)
        houses.push_back({add_house(model, random, i),
                          models::moved(kStep * static_cast<double>(i), 0, 0),
                          "house " + std::to_string(i)});
    model.root = models::add_group(model, "row", houses);
    return model;
}

hierarchy::BuildReport told(const char* what, Model model, const fs::path& folder,
                            bool of_one_frame = false) {
    Problems problems;
    hierarchy::BuildSettings settings;
    settings.of_one_frame = of_one_frame;
    const double cpu = cpu_seconds();
    const hierarchy::BuildReport report =
        hierarchy::build_hierarchy(model, segment::Store(folder), settings, problems, {});
    std::printf("| %s | %.3f | %llu | %.1f |\n", what, cpu_seconds() - cpu,
                static_cast<unsigned long long>(report.built),
                static_cast<double>(report.bytes_written) / 1e3);
    std::fflush(stdout);
    return report;
}

using Change = std::function<void(Model&)>;

void change_and_undo(const char* what, const Model& model, const Change& change,
                     const fs::path& folder) {
    Model changed = model;
    change(changed);
    told(what, changed, folder);
    told((std::string(what) + ", undone").c_str(), model, folder);
}

Assembly& assembly_of(Model& model, ObjectIndex group, std::shared_ptr<Assembly>& own) {
    Representation& finest = model.objects[group].representations[0];
    own = std::make_shared<Assembly>(finest.assembly());
    finest.payload = std::shared_ptr<const Assembly>(own);
    return *own;
}

void move_one(Model& model) {
    for (ObjectIndex i = 0; i < model.objects.size(); ++i) {
        if (model.objects[i].name != "block 1")
            continue;
        std::shared_ptr<Assembly> own;
        assembly_of(model, i, own).placements[9].transform.offset.x += 1;
    }
}

void move_a_vertex(Model& model) {
    Representation& finest = model.objects[7].representations[0];
    auto mesh = std::make_shared<Mesh>(finest.mesh());
    mesh->positions[0].x += 0.25f;
    finest.payload = std::shared_ptr<const Mesh>(mesh);
    summarize(finest, model);
}

void roughen(Model& model, const std::string& name) {
    for (Material& material : model.materials) {
        if (material.name == name)
            material.roughness = 0.35;
    }
    for (Object& object : model.objects) {
        if (!object.group())
            summarize(object.representations[0], model);
    }
}

uint64_t files_in(const fs::path& folder) {
    uint64_t count = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
        count += entry.is_regular_file() ? 1 : 0;
    return count;
}

}  // namespace

int main(int argc, char** argv) {
    const fs::path folder = argc > 1 ? fs::path(argv[1]) : fs::temp_directory_path();
    const fs::path store = folder / "lodestone_builds_town";
    const fs::path small = folder / "lodestone_builds_small";
    fs::remove_all(store);
    fs::remove_all(small);
    std::printf("| build | CPU s | built | written, KB |\n|---|---|---|---|\n");
    const Model model = town();
    told("town, first", model, store);
    told("nothing changed", model, store);
    change_and_undo("one house moved", model, move_one, store);
    change_and_undo("one vertex of one house", model, move_a_vertex, store);
    change_and_undo(
        "roughness of one color of four", model, [](Model& m) { roughen(m, "red"); }, store);
    change_and_undo(
        "roughness of the terrain", model, [](Model& m) { roughen(m, "earth"); }, store);
    Model frame = model;
    frame.cameras[0].position.x += 1;
    told("a frame in which the camera moved", frame, store, true);
    frame.cameras[0].position.x += 1;
    told("the next such frame", frame, store, true);
    const Model many = small_objects();
    const hierarchy::BuildReport first = told("1,000 small objects, first", many, small);
    std::printf("\nA small object takes %.2f ms of CPU and %.2f files.\n",
                first.cpu_s * 1e3 / kSmallObjects,
                static_cast<double>(files_in(small)) / kSmallObjects);
    fs::remove_all(store);
    fs::remove_all(small);
    return 0;
}
