// SPDX-License-Identifier: GPL-3.0-or-later
// What a picture uses of a large surface: `cmake --build build/release --target bench_surfaces`,
// then build/release/tests/bench_surfaces [SIDE ...]. A terrain of SIDE x SIDE points over a square
// kilometre (512, 2829: half a million triangles, and 16 million) is built, then seen from above,
// from over a corner, from afar, from a height of 10 m, and along a flight of 100 frames. "Whole"
// is one level for all of it, as every consumer but POV-Ray draws it; "by points" is what no choice
// by the errors of chunks can go below; "off screen coarse" is by chunks, with OffScreen::Shadows.
// Of half a million triangles it is told how true the errors of chunks are: what 99.9 % of 8,192
// points of each are nearer than, over its error, and in the picture, in pixels over the Pixel
// Error, each for the worst chunk. 200 cameras at random places look at these, too: their closed
// meshes are searched for torn edges, and rays through a million pixels for gaps. As much terrain
// of which half is a plain comes last.
#include "base/clock.h"
#include "base/random.h"
#include "choose/criterion.h"
#include "choose/surface_detail.h"
#include "hierarchy/hierarchy_build.h"
#include "ray/mesh_scene.h"
#include "scenes/chunk_truth.h"
#include "scenes/open_edges.h"
#include "scenes/ridged_terrain.h"
#include "scenes/small_models.h"
#include "segment/store.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sys/resource.h>

using namespace lodestone;

namespace {

// Metres along a side of the terrain.
constexpr double kSize = 1000;

/// A camera with a field of 60 degrees in a picture of 1920 x 1080.
View looking(const glm::dvec3& from, const glm::dvec3& to, double pixel_error) {
    View view = models::view_from(0, pixel_error);
    view.width = 1920;
    view.height = 1080;
    Camera& camera = view.camera;
    camera.position = from;
    camera.direction = glm::normalize(to - from);
    camera.near_clip = 0.1;
    // Law: the width of the picture at distance 1 is that of `right`.
    camera.right = 1.1547 * glm::normalize(glm::cross(camera.direction, glm::dvec3(0, 0, 1)));
    camera.up = 0.5625 * glm::cross(camera.right, camera.direction);
    return view;
}

glm::dvec3 above_ground(double x, double y, double height) {
    return {kSize * x, kSize * y, kSize * terrains::height_at(x, y) + height};
}

/// A terrain with its levels, and what the truth of its chunks is told by.
struct BuiltTerrain {
    Model model;
    bool small = false;  // not too large to look at all of it
    std::vector<std::vector<uint32_t>> by_chunk = {};

    const std::vector<Representation>& levels() const { return model.objects[0].representations; }
    const Mesh& finest() const { return levels()[0].mesh(); }
    const SurfaceTree& tree() const { return *levels()[0].surface->tree; }
};

struct UsedTriangles {
    uint64_t whole = 0;
    uint64_t chunks = 0;
};

UsedTriangles used_in(const Model& model, const View& view) {
    const choose::Cut cut = choose::choose_cut(model, view);
    const auto details = choose::surface_details(model, view, cut);
    return {cut.triangles, details.empty() ? cut.triangles : details[0].triangles};
}

/// The mesh that is drawn in a picture.
Mesh drawn_in(const Model& model, const View& view) {
    const choose::Cut cut = choose::choose_cut(model, view);
    const auto details = choose::surface_details(model, view, cut);
    if (details.empty())
        return model.objects[0].representations[cut.nodes[cut.chosen[0]].lod].mesh();
    const choose::DetailedCut drawn = choose::draw_surfaces(model, cut, details);
    const choose::CutNode& node = drawn.cut.nodes[details[0].node];
    return drawn.model.objects[node.object].representations[node.lod].mesh();
}

/// What 99.9 % of the points of the worst chunk are nearer than, in pixels over the Pixel Error.
double worst_chunk_in(const BuiltTerrain& terrain, const View& view) {
    const Mesh drawn = drawn_in(terrain.model, view);
    const ray::MeshScene scene(drawn);
    const ray::MeshScene finest(terrain.finest());
    std::vector<double> worst(terrain.by_chunk.size());
    parallel_for(worst.size(), [&](size_t chunk) {
        std::vector<double> off;
        for (const glm::dvec3& point :
             chunks::points_on(terrain.finest(), finest, terrain.by_chunk[chunk])) {
            const double z = glm::length(point - view.camera.position);
            off.push_back(scene.closest_point(point).distance / choose::pixel_size(view, z));
        }
        worst[chunk] = chunks::quantile_of(std::move(off));
    });
    return *std::max_element(worst.begin(), worst.end()) / view.pixel_error;
}

/// The triangles if every point of the surface had the coarsest level whose chunk there is good
/// enough at its own distance.
double least_for(const BuiltTerrain& terrain, const View& view) {
    // The triangles from one point to the next.
    constexpr size_t kApart = 37;
    const std::vector<Representation>& levels = terrain.levels();
    const Mesh& mesh = terrain.finest();
    double sum = 0;
    size_t points = 0;
    for (size_t t = 0; t < mesh.triangles.size(); t += kApart, ++points) {
        const double z =
            glm::length(glm::dvec3(mesh.positions[mesh.triangles[t].x]) - view.camera.position);
        const uint32_t chunk = terrain.tree().chunk_of(mesh, t);
        size_t lod = 0;
        while (lod + 1 < levels.size() && levels[lod + 1].surface != nullptr &&
               choose::good_enough(
                   view,
                   levels[lod + 1].surface->error_of(chunk >> levels[lod + 1].surface->shift,
                                                     levels[lod + 1].summary.error),
                   1, z))
            ++lod;
        sum += static_cast<double>(levels[lod].summary.cost.triangles);
    }
    return sum / static_cast<double>(points);
}

double peak_megabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

void tell_levels(const BuiltTerrain& terrain) {
    std::printf(
        "\n| level | error | chunks | least error | median | largest | truth over error, worst |\n"
        "|---|---|---|---|---|---|---|\n");
    for (const Representation& level : terrain.levels()) {
        if (level.surface == nullptr || level.surface->errors.empty())
            continue;
        std::vector<double> errors = level.surface->errors;
        std::vector<double> truth = chunks::true_errors(terrain.finest(), level);
        for (size_t node = 0; node < truth.size(); ++node)
            truth[node] /= errors[node];
        std::sort(errors.begin(), errors.end());
        std::printf("| %zu | %.3f | %zu | %.3f | %.3f | %.3f | %.2f |\n",
                    static_cast<size_t>(level.summary.cost.triangles), level.summary.error,
                    errors.size(), errors.front(), errors[errors.size() / 2], errors.back(),
                    *std::max_element(truth.begin(), truth.end()));
    }
}

void tell_views(const BuiltTerrain& terrain) {
    const Model& model = terrain.model;
    std::printf(
        "\n| view | Pixel Error | whole | by chunks | by points | off screen coarse |%s\n"
        "|---|---|---|---|---|---|%s\n",
        terrain.small ? " worst chunk |" : "", terrain.small ? "---|" : "");
    const glm::dvec3 middle(kSize / 2, kSize / 2, 80);
    const struct {
        const char* name;
        glm::dvec3 from, to;
    } views[] = {{"from above", {kSize / 2, kSize / 2, 900}, {kSize / 2, kSize / 2 + 1, 0}},
                 {"over a corner", {0.1 * kSize, 0.1 * kSize, 350}, middle},
                 {"from afar", {kSize / 2, -1600, 900}, middle},
                 {"10 m above the ground", above_ground(0.3, 0.2, 10), above_ground(0.5, 0.9, 0)}};
    for (const auto& view : views) {
        for (const double pixel_error : {1.0, 4.0}) {
            View given = looking(view.from, view.to, pixel_error);
            const UsedTriangles used = used_in(model, given);
            given.modifiers.off_screen = OffScreen::Shadows;
            const auto off_screen = static_cast<size_t>(used_in(model, given).chunks);
            given.modifiers.off_screen = OffScreen::Full;
            std::printf("| %s | %.0f | %zu | %zu | %.0f | %zu |", view.name, pixel_error,
                        static_cast<size_t>(used.whole), static_cast<size_t>(used.chunks),
                        least_for(terrain, given), off_screen);
            if (terrain.small)
                std::printf(" %.2f |", worst_chunk_in(terrain, given));
            std::printf("\n");
        }
    }
}

void tell_flight(const Model& model) {
    constexpr int kFrames = 100;
    double step_whole = 1;
    double step_chunks = 1;
    UsedTriangles before;
    for (int frame = 0; frame < kFrames; ++frame) {
        const double at = 0.1 + 0.8 * frame / kFrames;
        const View view =
            looking(above_ground(at, 0.3 + 0.4 * at, 60), above_ground(at + 0.2, 0.9, 0), 1);
        const UsedTriangles used = used_in(model, view);
        const auto ratio = [](uint64_t a, uint64_t b) {
            return static_cast<double>(std::max(a, b)) / static_cast<double>(std::min(a, b));
        };
        if (frame > 0) {
            step_whole = std::max(step_whole, ratio(used.whole, before.whole));
            step_chunks = std::max(step_chunks, ratio(used.chunks, before.chunks));
        }
        before = used;
    }
    std::printf(
        "\nA flight of %d frames, 60 m above the ground: from one frame to the next the "
        "triangles grow or shrink by a factor of at most %.2f whole and %.2f by chunks.\n",
        kFrames, step_whole, step_chunks);
}

void tell_gaps(const Model& model) {
    constexpr int kViews = 200;
    constexpr int kRays = 5000;
    PcgRandom random(5, 1);
    size_t torn = 0;
    size_t parted = 0;
    size_t gaps = 0;
    for (int i = 0; i < kViews; ++i) {
        const auto any = [&](double low, double high) {
            return low + (high - low) * random.uniform();
        };
        const View view = looking(above_ground(any(0.05, 0.95), any(0.05, 0.95), any(2, 400)),
                                  above_ground(any(0.1, 0.9), any(0.1, 0.9), 0), any(0.5, 8));
        const choose::Cut cut = choose::choose_cut(model, view);
        const auto details = choose::surface_details(model, view, cut);
        if (details.empty())
            continue;
        ++parted;
        const choose::DetailedCut drawn = choose::draw_surfaces(model, cut, details);
        const choose::CutNode& node = drawn.cut.nodes[details[0].node];
        const Mesh& mesh = drawn.model.objects[node.object].representations[node.lod].mesh();
        torn += loops_of(open_edges(mesh)) - 1;
        const ray::MeshScene scene(mesh);
        // From below, straight up: whatever is there has no gap.
        for (int ray = 0; ray < kRays; ++ray) {
            const glm::dvec3 from(any(0.02, 0.98) * kSize, any(0.02, 0.98) * kSize, -kSize);
            gaps += scene.occluded(from, {0, 0, 1}) ? 0 : 1;
        }
    }
    std::printf(
        "\n%d cameras at random places, of which %zu take chunks from several levels: %zu "
        "holes in the closed meshes, %zu of %zu rays find a gap.\n",
        kViews, parted, torn, gaps, parted * kRays);
}

void measure_terrain(const char* name, Mesh mesh, const std::string& store) {
    BuiltTerrain terrain;
    Model& model = terrain.model;
    model.costs = povray::povray_costs();
    model.root = models::add_leaf(model, "terrain", std::move(mesh));
    summarize_assemblies(model, bottom_up(model));
    Problems problems;
    hierarchy::BuildSettings settings;
    settings.rebuild = true;
    const double before = peak_megabytes();
    const double start = cpu_seconds();
    hierarchy::build_hierarchy(model, segment::Store(store), settings, problems, {});
    const double spent = cpu_seconds() - start;
    terrain.small = terrain.finest().triangles.size() < 1'000'000;
    std::printf(
        "\n## %s, %zu triangles\n\nBuilt in %.1f CPU s; %.0f MB at most, of which %.0f "
        "before.\n",
        name, terrain.finest().triangles.size(), spent, peak_megabytes(), before);
    if (terrain.small) {
        terrain.by_chunk = chunks::triangles_by_chunk(terrain.finest(), terrain.tree());
        tell_levels(terrain);
    }
    tell_views(terrain);
    tell_flight(model);
    if (terrain.small)
        tell_gaps(model);
    std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
    const std::string store =
        (std::filesystem::temp_directory_path() / "lodestone_bench_surfaces").string();
    try {
        std::vector<uint32_t> sides;
        for (int i = 1; i < count; ++i)
            sides.push_back(static_cast<uint32_t>(std::atoi(arguments[i])));
        if (sides.empty())
            sides = {512, 2829};
        for (const uint32_t side : sides)
            measure_terrain("Ridges", terrains::terrain(side, kSize), store);
        measure_terrain("Ridges beside a plain",
                        terrains::height_field(512, kSize, terrains::half_plain_height_at), store);
        std::filesystem::remove_all(store);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
