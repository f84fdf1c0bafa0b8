// SPDX-License-Identifier: GPL-3.0-or-later
// How far textures slide over a surface when it is simplified:
//   build/release/tests/bench_textures FILE.obj ...   (bench_program.py textures gives the models)
// Every mesh with texture coordinates and a thousand triangles or more is simplified to 50, 10, 2
// and .5 %, in both modes. At points spread over a level's area the texture coordinates are
// compared with those of the original at the nearest point that faces the same way. The slip is the
// difference times the metres that a step in the texture takes there, as a share of half the
// diagonal of the model's box, 1 at most: its median, the mean of what is below a twentieth, and
// the share of the area above (where a seam has moved, or an island has vanished).
#include "base/files.h"
#include "base/random.h"
#include "format/obj/obj.h"
#include "ray/mesh_scene.h"
#include "ray/mesh_skin.h"
#include "simplify/simplify.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <vector>

using namespace lodestone;

namespace {

constexpr size_t kFewest = 1000;
constexpr size_t kPoints = 40'000;
constexpr double kFar = 0.05;
constexpr double kTargets[] = {0.5, 0.1, 0.02, 0.005};

double cpu_seconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The metres that a step of 1 in the texture takes on a triangle.
double metres_per_uv(const Mesh& mesh, uint32_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    const glm::dvec2 b = glm::dvec2(mesh.uvs[t.y]) - glm::dvec2(mesh.uvs[t.x]);
    const glm::dvec2 c = glm::dvec2(mesh.uvs[t.z]) - glm::dvec2(mesh.uvs[t.x]);
    const double twice = std::abs(b.x * c.y - b.y * c.x);
    return std::sqrt(glm::length(area_vector(mesh, triangle)) / std::max(twice, 1e-30));
}

/// The slips at points of a level, rising.
std::vector<double> slips_of(const Mesh& level, const Mesh& original, const ray::MeshScene& scene,
                             double radius) {
    std::vector<double> sums;
    double sum = 0;
    for (size_t i = 0; i < level.triangles.size(); ++i)
        sums.push_back(sum += glm::length(area_vector(level, i)));
    std::vector<double> slips;
    PcgRandom random(1);
    for (size_t n = 0; n < kPoints; ++n) {
        const double at = sum * (static_cast<double>(n) + 0.5) / static_cast<double>(kPoints);
        const auto found = std::lower_bound(sums.begin(), sums.end(), at);
        if (found == sums.end())
            continue;
        const auto i = static_cast<uint32_t>(found - sums.begin());
        double u = random.uniform();
        double v = random.uniform();
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const Triangle& t = level.triangles[i];
        const glm::dvec3 a(level.positions[t.x]);
        const glm::dvec3 place = a + u * (glm::dvec3(level.positions[t.y]) - a) +
                                 v * (glm::dvec3(level.positions[t.z]) - a);
        const ray::ClosestPoint near =
            scene.closest_facing(place, glm::normalize(area_vector(level, i)), 4 * radius);
        if (near.triangle == ray::kNoTriangle)
            continue;
        const glm::dvec2 off =
            ray::uv_at(level, i, u, v) - ray::uv_at(original, near.triangle, near.u, near.v);
        const double slip = glm::length(off) * metres_per_uv(original, near.triangle) / radius;
        slips.push_back(slip < 1 ? slip : 1);
    }
    std::sort(slips.begin(), slips.end());
    return slips;
}

void measure(const std::string& name, const Mesh& mesh) {
    const ray::MeshScene scene(mesh);
    glm::dvec3 low(mesh.positions.front());
    glm::dvec3 high = low;
    for (const glm::vec3& p : mesh.positions) {
        low = glm::min(low, glm::dvec3(p));
        high = glm::max(high, glm::dvec3(p));
    }
    const double radius = 0.5 * glm::length(high - low);
    for (const double target : kTargets) {
        for (const auto mode : {simplify::SimplifyMode::Fast, simplify::SimplifyMode::Best}) {
            simplify::SimplifyOptions options;
            options.mode = mode;
            const double before = cpu_seconds();
            const Mesh level = simplify::simplify_mesh(
                mesh,
                static_cast<size_t>(std::ceil(target * static_cast<double>(mesh.triangles.size()))),
                options);
            const double cpu = cpu_seconds() - before;
            const std::vector<double> slips = slips_of(level, mesh, scene, radius);
            if (slips.empty())
                continue;
            const auto far = std::lower_bound(slips.begin(), slips.end(), kFar);
            double near = 0;
            for (auto slip = slips.begin(); slip != far; ++slip)
                near += *slip;
            std::printf(
                "| %s | %s | %zu | %.3f %% | %.3f %% | %.1f %% | %.2f |\n", name.c_str(),
                mode == simplify::SimplifyMode::Fast ? "fast" : "best", level.triangles.size(),
                100 * slips[slips.size() / 2],
                100 * near / std::max(1.0, static_cast<double>(far - slips.begin())),
                100 * static_cast<double>(slips.end() - far) / static_cast<double>(slips.size()),
                cpu);
            std::fflush(stdout);
        }
    }
}

}  // namespace

int main(int count, char** words) {
    if (count < 2) {
        std::fprintf(stderr, "usage: bench_textures FILE.obj ...\n");
        return 2;
    }
    std::printf(
        "| model | mode | triangles | median slip | mean of what slips below 5 %% | slips "
        "farther | CPU s |\n|---|---|---|---|---|---|---|\n");
    for (int i = 1; i < count; ++i) {
        const std::filesystem::path path = words[i];
        Problems problems;
        const Model model = format::read_obj(read_file(path), path, problems);
        for (const Object& object : model.objects) {
            if (object.representations.empty() ||
                object.representations[0].summary.kind != Kind::Mesh)
                continue;
            const Mesh& mesh = object.representations[0].mesh();
            if (!mesh.uvs.empty() && mesh.triangles.size() >= kFewest)
                measure(path.stem().string(), mesh);
        }
    }
    return 0;
}
