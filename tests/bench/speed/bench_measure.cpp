// SPDX-License-Identifier: GPL-3.0-or-later
// What measuring costs, in JSON lines for bench_measure.py:
//   bench_measure shapes FILE.ply... SEEDS ERROR    the estimator of the visible area
//   bench_measure closest FILE.ply... ROUNDS        closest points
//   bench_measure error FINEST.ply LEVEL.ply... SEEDS SAMPLES   how stable an error is over seeds
#include "base/clock.h"
#include "base/files.h"
#include "base/parallel.h"
#include "base/random.h"
#include "format/ply.h"
#include "measure/deviation/surface_deviation.h"
#include "measure/visible/visible_attributes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>

using namespace lodestone;

namespace {

Mesh mesh_of(const std::string& path) {
    Problems problems;
    Mesh mesh = format::read_ply(read_file(path), path, problems);
    repair(mesh, path, problems);
    return mesh;
}

std::string name_of(const std::string& path) {
    const size_t slash = path.rfind('/') + 1;  // npos + 1 is 0
    return path.substr(slash, path.rfind('.') - slash);
}

double visible_area(const Mesh& mesh, const ray::MeshScene& scene, measure::CastMethod casting) {
    measure::VisibleOptions options;
    options.relative_error = 0.001;
    options.most_rays = uint64_t{1} << 25u;
    options.seed = 424242;
    options.casting = casting;
    return measure::measure_visible(mesh, scene, nullptr, options).attributes.visible_area;
}

void shape(const std::string& path, int seeds, double error) {
    const Mesh mesh = mesh_of(path);
    const ray::MeshScene scene(mesh);
    const double lines = visible_area(mesh, scene, measure::CastMethod::FromBound);
    const double truth = visible_area(mesh, scene, measure::CastMethod::Best);
    measure::VisibleOptions options;
    options.relative_error = error;
    int inside = 0;
    uint64_t rays = 0;
    double cpu = 0;
    double sum = 0;
    double squares = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        options.seed = static_cast<uint64_t>(seed);
        const double start = cpu_seconds();
        const measure::VisibleAttributes out =
            measure::measure_visible(mesh, scene, nullptr, options);
        cpu += cpu_seconds() - start;
        rays += out.attributes.rays + out.pilot_rays;
        const double off = out.attributes.visible_area / truth - 1;
        inside += std::abs(off) <= error ? 1 : 0;
        sum += off;
        squares += off * off;
    }
    const double bias = sum / seeds;
    const double half_width = 1.96 * std::sqrt(std::max(squares / seeds - bias * bias, 0.0));
    const measure::VisibleSampler sampler(mesh, scene, 1, measure::CastMethod::Best, error);
    std::printf(
        "{\"shape\": \"%s\", \"triangles\": %zu, \"seeds\": %d, \"rays\": %.0f, \"cpu_ms\": "
        "%.4f, \"inside\": %d, \"bias\": %.5f, \"half_width\": %.5f, \"area\": %.9g, "
        "\"area_by_lines\": %.9g, \"way\": \"%s\"}\n",
        name_of(path).c_str(), mesh.triangles.size(), seeds, static_cast<double>(rays) / seeds,
        1e3 * cpu / seeds, inside, bias, half_width, truth, lines,
        sampler.shows_all()      ? "traversal"
        : sampler.from_surface() ? "surface"
                                 : "lines");
}

/// Points of the surface in its order, each moved by up to a hundredth of its radius.
std::vector<glm::dvec3> points_near(const Mesh& mesh, const ray::MeshScene& scene) {
    std::vector<measure::SurfaceSample> samples;
    measure::add_area_samples(mesh, scene, 100000, 1, samples);
    const double far = 0.01 * measure::radius_of(mesh);
    PcgRandom random(7);
    std::vector<glm::dvec3> points;
    for (const measure::SurfaceSample& sample : samples) {
        const glm::dvec3 arm(random.uniform() - 0.5, random.uniform() - 0.5,
                             random.uniform() - 0.5);
        points.push_back(sample.point + far * random.uniform() * arm / glm::length(arm));
    }
    return points;
}

void closest(const std::string& path, int rounds) {
    const Mesh mesh = mesh_of(path);
    const double start = cpu_seconds();
    const ray::MeshScene scene(mesh, nullptr, ray::SceneUse::ClosestPoints);
    (void)scene.closest_point({});
    const double build = cpu_seconds() - start;
    const std::vector<glm::dvec3> points = points_near(mesh, scene);
    const auto rates = [&](bool hinted, double& mean) {
        std::vector<double> out;
        double sum = 0;
        for (int round = 0; round < rounds; ++round) {
            uint32_t last = ray::kNoTriangle;
            const double begin = cpu_seconds();
            for (const glm::dvec3& point : points) {
                const ray::ClosestPoint found =
                    scene.closest_point(point, std::numeric_limits<double>::infinity(),
                                        hinted ? last : ray::kNoTriangle);
                last = found.triangle;
                sum += found.distance;
            }
            out.push_back(static_cast<double>(points.size()) / (cpu_seconds() - begin) / 1e6);
        }
        std::sort(out.begin(), out.end());
        mean = sum / static_cast<double>(points.size()) / rounds;
        return std::array<double, 3>{out.front(), out[out.size() / 2], out.back()};
    };
    double mean = 0;
    const std::array<double, 3> bare = rates(false, mean);
    const std::array<double, 3> hinted = rates(true, mean);
    std::printf(
        "{\"mesh\": \"%s\", \"triangles\": %zu, \"build_ms\": %.3f, \"bare\": [%.4f, %.4f, "
        "%.4f], \"hinted\": [%.4f, %.4f, %.4f], \"mean\": %.9g}\n",
        name_of(path).c_str(), mesh.triangles.size(), 1e3 * build, bare[0], bare[1], bare[2],
        hinted[0], hinted[1], hinted[2], mean);
}

void error(const std::string& finest_path, const std::string& level_path, int seeds,
           uint32_t samples) {
    const Mesh finest = mesh_of(finest_path);
    const Mesh level = mesh_of(level_path);
    std::vector<double> errors;
    double most = 0;
    const double start = cpu_seconds();
    for (int seed = 1; seed <= seeds; ++seed) {
        measure::DeviationOptions options;
        if (samples > 0)
            options.samples = options.most_vertices = samples;
        options.seed = static_cast<uint64_t>(seed);
        const measure::SurfaceDeviation out =
            measure::DeviationReference(finest, options).of(level);
        errors.push_back(out.error);
        most = std::max(most, out.max);
    }
    const double cpu = cpu_seconds() - start;
    const double mean = std::accumulate(errors.begin(), errors.end(), 0.0) / seeds;
    double square = 0;
    for (const double one : errors)
        square += (one / mean - 1) * (one / mean - 1);
    const auto [low, high] = std::minmax_element(errors.begin(), errors.end());
    std::printf(
        "{\"level\": \"%s\", \"triangles\": %zu, \"error\": %.9g, \"deviation\": %.5f, "
        "\"low\": %.5f, \"high\": %.5f, \"max\": %.9g, \"cpu_ms\": %.3f}\n",
        name_of(level_path).c_str(), level.triangles.size(), mean, std::sqrt(square / seeds),
        *low / mean - 1, *high / mean - 1, most, 1e3 * cpu / seeds);
}

}  // namespace

int main(int argc, char** argv) {
    const ThreadLimit one(1);
    std::vector<std::string> words(argv + 1, argv + argc);
    try {
        const std::string what = words.empty() ? "" : words[0];
        const size_t last = words.size();
        if (what == "shapes" && last > 3) {
            for (size_t i = 1; i + 2 < last; ++i)
                shape(words[i], std::stoi(words[last - 2]), std::stod(words[last - 1]));
        } else if (what == "closest" && last > 2) {
            for (size_t i = 1; i + 1 < last; ++i)
                closest(words[i], std::stoi(words[last - 1]));
        } else if (what == "error" && last > 4) {
            for (size_t i = 2; i + 2 < last; ++i)
                error(words[1], words[i], std::stoi(words[last - 2]),
                      static_cast<uint32_t>(std::stoul(words[last - 1])));
        } else {
            std::fprintf(stderr, "usage: see the top of bench_measure.cpp\n");
            return 2;
        }
    } catch (const std::exception& problem) {
        std::fprintf(stderr, "%s\n", problem.what());
        return 1;
    }
    return 0;
}
