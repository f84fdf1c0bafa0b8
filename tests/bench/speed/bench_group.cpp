// SPDX-License-Identifier: GPL-3.0-or-later
// Compares ways to structure what stands flat in collections: by the expected cost of 4.5.3, and by
// what the cut at 1 px holds over 20 views.
//
//     cmake --build build/release --target bench_group
//     build/release/tests/bench_group [--far] [--flat N] [--group-cost C] [--similarity S] STORE...
//
// Stores are those `batch.py build` makes; groups that Lodestone made in them are taken out again.
// --flat N: of the store that follows, the N leaves nearest to its middle, in no collection. Every
// way starts from the same levels of the leaves and builds those of its own groups. "groups": made,
// and of these such as stand for what is in them in some view, near or far. "triangles" are
// those of meshes, "drawn" counts a box as 12 and an ellipsoid as 80 as well. "floor": of what is
// drawn, that of leaves that are not at their coarsest level: as much as one of them needs at that
// error, no group needs less for it; the others are free. Views are at .3 to 3 radii, with --far at
// 3 to 30. Prints a table; no number makes it fail.
#include "base/clock.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/text.h"
#include "choose/cut.h"
#include "group/group_structure.h"
#include "group/position_groups.h"
#include "hierarchy/hierarchy_build.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <unistd.h>

using namespace lodestone;

namespace {

constexpr int kViews = 20;
constexpr size_t kFewest = 8;    // groups of more children are structured
constexpr double kMerged = 0.5;  // of its parent's area: then a cluster is dissolved

/// Greedy agglomerative clustering: always the two clusters whose common bound is smallest; a
/// cluster nearly as large as the one around it is dissolved, for a binary tree has too many.
group::GroupingTree agglomerate(std::span<const group::GroupingItem> items) {
    const size_t count = items.size();
    if (count <= 2)
        return group::flat_tree(count);
    group::GroupingTree tree;
    tree.item_count = count;
    tree.nodes.resize(count);
    std::vector<Box3> boxes;
    std::vector<uint32_t> alive;
    for (uint32_t i = 0; i < count; ++i) {
        boxes.push_back(items[i].box);
        alive.push_back(i);
    }
    const auto together = [&](uint32_t a, uint32_t b) {
        Box3 both = boxes[a];
        both.add(boxes[b]);
        const glm::dvec3 size = both.size();
        return group::half_area(both) + 1e-9 * glm::dot(size, size);
    };
    std::vector<std::pair<double, uint32_t>> nearest(count);
    const auto look = [&](uint32_t a) {
        nearest[a] = {std::numeric_limits<double>::infinity(), group::kNoNode};
        for (const uint32_t b : alive) {
            if (b != a)
                nearest[a] = std::min(nearest[a], {together(a, b), b});
        }
    };
    parallel_for(count, [&](size_t i) { look(static_cast<uint32_t>(i)); });
    while (alive.size() > 1) {
        const uint32_t a = *std::min_element(
            alive.begin(), alive.end(), [&](auto x, auto y) { return nearest[x] < nearest[y]; });
        const uint32_t b = nearest[a].second;
        const auto made = static_cast<uint32_t>(tree.nodes.size());
        tree.nodes.emplace_back();
        tree.nodes[made].children = {a, b};
        tree.nodes[a].parent = tree.nodes[b].parent = made;
        boxes.push_back(boxes[a]);
        boxes.back().add(boxes[b]);
        nearest.emplace_back();
        std::erase_if(alive, [&](uint32_t x) { return x == a || x == b; });
        alive.push_back(made);
        look(made);
        for (const uint32_t c : alive) {
            if (c == made)
                continue;
            if (nearest[c].second == a || nearest[c].second == b)
                look(c);
            else
                nearest[c] = std::min(nearest[c], {together(c, made), made});
        }
    }
    tree.root = alive.front();
    for (auto node = static_cast<uint32_t>(count); node < tree.root; ++node) {
        const uint32_t parent = tree.nodes[node].parent;
        if (group::half_area(boxes[node]) < kMerged * group::half_area(boxes[parent]))
            continue;
        std::vector<uint32_t>& around = tree.nodes[parent].children;
        std::erase(around, node);
        for (const uint32_t child : tree.nodes[node].children) {
            tree.nodes[child].parent = parent;
            around.push_back(child);
        }
        tree.nodes[node] = {};
    }
    return tree;
}

Model read(const std::string& path) {
    const segment::Store store(path);
    Model model = store.read();
    for (const ObjectIndex index : bottom_up(model)) {
        Object& object = model.objects[index];
        object.representations.resize(std::min<size_t>(1, object.representations.size()));
        object.attributes.reset();
        object.build_hash = 0;
        if (!object.representations.empty())
            store.load(object.representations[0]);
    }
    store.load_pictures(model);
    for (const ObjectIndex index : bottom_up(model)) {
        if (model.objects[index].group())
            group::dissolve_made_groups(model, index);
    }
    return model;
}

/// Everything directly in the root: how the scene is without its collections. At most so many,
/// those nearest to the middle.
void flatten(Model& model, size_t most) {
    auto flat = std::make_shared<Assembly>();
    const glm::dvec3 middle = model.objects[model.root].bound().center;
    std::vector<std::pair<double, Placement>> found;
    for_each_occurrence(model, [&](const Occurrence& occurrence) {
        Placement placement;
        placement.object = occurrence.object;
        placement.transform = occurrence.world;
        placement.name = occurrence.path;
        placement.hidden = occurrence.hidden;
        const Bound& bound = model.objects[occurrence.object].bound();
        found.emplace_back(glm::length(transformed(bound, occurrence.world).center - middle),
                           placement);
    });
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (size_t i = 0; i < std::min(most, found.size()); ++i)
        flat->placements.push_back(found[i].second);
    model.objects[model.root].representations[0].payload =
        std::shared_ptr<const Assembly>(std::move(flat));
    summarize_assemblies(model, bottom_up(model));
}

/// Eyes around the scene and in it, at many distances; far: ten times as far.
std::vector<View> views_of(const Model& model, bool away) {
    const Bound& bound = model.objects[model.root].bound();
    constexpr double kDistances[] = {0.3, 0.6, 1.0, 1.7, 3.0};  // of the scene's radius
    std::vector<View> views;
    for (int i = 0; i < kViews; ++i) {
        const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
        const double rise = 0.1 + 0.5 * (i % 4) / 3.0;
        const double far = kDistances[i % 5] * bound.radius * (away ? 10 : 1);
        View view;
        view.camera.position =
            bound.center + far * glm::dvec3(std::cos(turn) * std::cos(rise),
                                            std::sin(turn) * std::cos(rise), std::sin(rise));
        view.camera.right = {0.72, 0, 0};  // a lens of 50 mm on 36 mm
        view.camera.up = {0, 0.405, 0};
        view.width = 640;
        view.height = 360;
        view.pixel_error = 1;
        views.push_back(view);
    }
    return views;
}

struct Result {
    double cost = 0;
    size_t groups = 0;
    std::set<ObjectIndex> used;  // of the groups
    double structure_s = 0;      // CPU
    double build_s = 0;          // CPU
    double triangles = 0;        // of meshes, over all views
    double drawn = 0;            // primitives counted as triangles too
    double occurrences = 0;
    double bytes = 0;
};

double drawn_by(const Representation& representation) {
    const RepresentationSummary& summary = representation.summary;
    return static_cast<double>(summary.cost.triangles +
                               row_of(summary.kind).viewer_triangles.value_or(0));
}

void add_cut(Result& result, const Model& model, const View& view) {
    const choose::Cut cut = choose::choose_cut(model, view);
    result.triangles += static_cast<double>(cut.triangles);
    result.occurrences += static_cast<double>(cut.chosen.size());
    result.bytes += static_cast<double>(cut.bytes);
    for (const uint32_t index : cut.chosen) {
        const choose::CutNode& node = cut.nodes[index];
        result.drawn += drawn_by(model.objects[node.object].representations[node.lod]);
    }
}

void add_used(Result& result, const Model& model, size_t made, const View& view) {
    const choose::Cut cut = choose::choose_cut(model, view);
    for (const uint32_t index : cut.chosen) {
        if (cut.nodes[index].object >= made)
            result.used.insert(cut.nodes[index].object);
    }
}

/// What leaves that are not at their coarsest level draw, over all views.
double floor_of(Model model, bool away) {
    const std::vector<View> views = views_of(model, away);
    flatten(model, std::numeric_limits<size_t>::max());
    model.objects[model.root].representations.resize(1);
    double drawn = 0;
    for (const View& view : views) {
        const choose::Cut cut = choose::choose_cut(model, view);
        for (const uint32_t index : cut.chosen) {
            const choose::CutNode& node = cut.nodes[index];
            const Object& object = model.objects[node.object];
            if (node.lod + 1 < object.representations.size())
                drawn += drawn_by(object.representations[node.lod]);
        }
    }
    return drawn;
}

/// Of a group, from its bound's frame up: objects from `made` on were made to structure it.
double cost_below(const Model& model, ObjectIndex index, size_t made, double whole) {
    const Object& object = model.objects[index];
    const std::vector<Placement>& placements = object.representations[0].assembly().placements;
    double cost = static_cast<double>(placements.size()) *
                  (whole > 0 ? group::half_area(object.bound().box) / whole : 1.0);
    for (const Placement& placement : placements) {
        if (placement.object >= made)
            cost += cost_below(model, placement.object, made, whole);
    }
    return cost;
}

using Way = std::function<void(Model&, const std::vector<ObjectIndex>&)>;

group::StructureOptions structure_options;

void by_insertion(Model& model, const std::vector<ObjectIndex>& flat) {
    group::StructureOptions options = structure_options;
    options.fewest = kFewest;
    group::structure_groups(model, flat, options, {});
}

void by_agglomeration(Model& model, const std::vector<ObjectIndex>& flat) {
    const std::vector<group::ObjectTraits> traits = group::traits_of(model, flat, {});
    for (const ObjectIndex index : flat) {
        const group::SortedChildren sorted = group::sorted_children(model, index, traits);
        std::vector<group::GroupingTree> trees;
        for (const std::vector<group::GroupingItem>& items : sorted.items)
            trees.push_back(items.size() > group::kLeastChildren ? agglomerate(items)
                                                                 : group::flat_tree(items.size()));
        group::apply_grouping(model, index, sorted, trees);
    }
}

void by_octree(Model& model, const std::vector<ObjectIndex>& flat) {
    for (const ObjectIndex index : flat)
        group::group_by_position(model, index, group::kLeastChildren);
}

Result measure(const Model& read, const std::string& store, const Way& way,
               const hierarchy::BuildSettings& settings, bool away, double* floor = nullptr) {
    namespace fs = std::filesystem;
    Result result;
    Model model = read;
    const std::vector<ObjectIndex> flat = group::flat_groups(model, kFewest);
    const size_t made = model.objects.size();
    double cpu = cpu_seconds();
    way(model, flat);
    result.structure_s = cpu_seconds() - cpu;
    result.groups = model.objects.size() - made;
    const fs::path scratch = fs::temp_directory_path() / text("lodestone_group_", getpid());
    fs::remove_all(scratch);
    fs::copy(store, scratch, fs::copy_options::recursive);
    Problems problems;
    cpu = cpu_seconds();
    hierarchy::build_hierarchy(model, segment::Store(scratch), settings, problems, {});
    result.build_s = cpu_seconds() - cpu;
    fs::remove_all(scratch);
    for (const ObjectIndex index : flat)
        result.cost +=
            cost_below(model, index, made, group::half_area(model.objects[index].bound().box));
    for (const View& view : views_of(model, away)) {
        add_cut(result, model, view);
        add_used(result, model, made, view);
    }
    for (const View& view : views_of(model, !away))
        add_used(result, model, made, view);
    if (floor != nullptr)
        *floor = floor_of(model, away);
    return result;
}

void print(const std::string& scene, const char* way, const Result& r, const Result& plain,
           const Result& octree, double floor) {
    std::printf(
        "| %s | %s | %zu, %zu | %.1f | %.3f | %.1f | %.0f | %.0f | %.3f | %.3f | %.3f | %.0f | "
        "%.3f "
        "|\n",
        scene.c_str(), way, r.groups, r.used.size(), r.cost, r.structure_s, r.build_s,
        r.triangles / kViews, r.drawn / kViews, r.drawn / std::max(1.0, plain.drawn),
        r.drawn / std::max(1.0, octree.drawn), floor / std::max(1.0, r.drawn),
        r.occurrences / kViews, r.bytes / std::max(1.0, plain.bytes));
    std::fflush(stdout);
}

/// Structuring alone: 10,000 boxes in 100 heaps, minimum / median / maximum of five runs.
void print_times() {
    std::vector<group::GroupingItem> items;
    for (uint64_t i = 0; i < 10000; ++i) {
        PcgRandom random(1, i);
        const uint64_t number = i / 100;
        const auto heap = static_cast<double>(number);
        const glm::dvec3 at(1000 * heap + 20 * random.uniform(), 20 * random.uniform(),
                            20 * random.uniform());
        group::GroupingItem item;
        item.box = {at - 0.5, at + 0.5};
        items.push_back(item);
    }
    std::vector<double> cpu;
    std::vector<double> wall;
    for (int round = 0; round < 5; ++round) {
        const double cpu_before = cpu_seconds();
        const double wall_before = wall_seconds();
        group::group_by_insertion(items, {}, {});
        cpu.push_back(cpu_seconds() - cpu_before);
        wall.push_back(wall_seconds() - wall_before);
    }
    std::sort(cpu.begin(), cpu.end());
    std::sort(wall.begin(), wall.end());
    std::printf("\n10,000 objects: %.2f / %.2f / %.2f CPU s, %.2f / %.2f / %.2f s (goal: 3 s)\n",
                cpu[0], cpu[2], cpu[4], wall[0], wall[2], wall[4]);
}

/// Builds levels of the leaves with little sampling, for scenes that are flattened: thousands of
/// groups are compared with each other, not with what is shipped.
hierarchy::BuildSettings quick_settings() {
    hierarchy::BuildSettings settings;
    settings.rays = 1024;
    settings.samples = 512;
    settings.group_triangles = 10000;
    return settings;
}

void compare(const std::string& path, size_t flat, bool away) {
    namespace fs = std::filesystem;
    std::string scene = fs::path(path).filename();
    Model model = read(path);
    hierarchy::BuildSettings settings;
    const fs::path base = fs::temp_directory_path() / text("lodestone_leaves_", getpid());
    fs::remove_all(base);
    if (flat > 0) {
        scene += text(", ", flat, " flat");
        flatten(model, flat);
        settings = quick_settings();
        fs::create_directories(base);
    } else {
        fs::copy(path, base, fs::copy_options::recursive);
    }
    Model leaves = model;
    Problems problems;
    hierarchy::build_hierarchy(leaves, segment::Store(base), settings, problems, {});
    double floor = 0;
    const auto by = [&](const Way& way, double* to = nullptr) {
        return measure(model, base, way, settings, away, to);
    };
    const Result plain = by([](Model&, const std::vector<ObjectIndex>&) {}, &floor);
    const Result octree = by(by_octree);
    print(scene, "collections", plain, plain, octree, floor);
    print(scene, "octree", octree, plain, octree, floor);
    print(scene, "agglomerative", by(by_agglomeration), plain, octree, floor);
    print(scene, "insertion", by(by_insertion), plain, octree, floor);
    fs::remove_all(base);
}

}  // namespace

int main(int argc, char** argv) {
    std::printf(
        "| scene | way | groups, used | expected cost | structure, CPU s | levels, CPU s | "
        "triangles "
        "| drawn | / collections | / octree | floor / drawn | occurrences | bytes / collections |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    size_t flat = 0;
    bool away = false;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--flat" && i + 1 < argc) {
            flat = std::strtoul(argv[++i], nullptr, 10);
            continue;
        }
        if (argument == "--group-cost" && i + 1 < argc) {
            structure_options.group_cost = std::strtod(argv[++i], nullptr);
            continue;
        }
        if (argument == "--similarity" && i + 1 < argc) {
            structure_options.similarity = std::strtod(argv[++i], nullptr);
            continue;
        }
        if (argument == "--far") {
            away = true;
            continue;
        }
        try {
            compare(argument, flat, away);
        } catch (const std::exception& error) {
            std::fprintf(stderr, "bench_group: %s: %s\n", argument.c_str(), error.what());
            return 1;
        }
        flat = 0;
    }
    print_times();
}
