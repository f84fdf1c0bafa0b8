// SPDX-License-Identifier: GPL-3.0-or-later
// Whether errors are true, in JSON lines for bench_errors.py:
//   bench_errors STORE [--most N] [--side N] [--picture FILE --object NAME --lod N]
// Every level of every object and group of a store is looked at from 26 directions, from the
// nearest place from which one pixel of a picture of 1,000 pixels is as large as its error. What
// an eye sees there of the finest is so and so far from the level, and what it sees of the level so
// far from the finest: 99.9 % of the pixels (of either picture) are to be nearer than the error.
// A line tells the worst of the directions. Of levels that are drawn alike one is looked at, and of
// more than `most` that many, evenly over the list. Pictures are of one level: the finest, the
// level, and where the two are farther from each other than the error (red), from its worst
// direction.
#include "image/image.h"
#include "scenes/seen_errors.h"
#include "segment/store.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <string>

using namespace lodestone;

namespace {

/// Groups of more are compared with children of a small error instead of the finest.
constexpr uint64_t kMostTriangles = 3'000'000;

class Bench {
public:
    Bench(const std::string& folder, int side)
        : store_(folder), model_(with_pictures(store_)), side_(side), surfaces_(model_, source()) {}

    const Model& model() const { return model_; }
    seen::Surface finest_of(ObjectIndex index) { return surfaces_.finest(index, kMostTriangles); }
    seen::Surface level_of(ObjectIndex index, size_t lod) { return surfaces_.level(index, lod); }

    /// What is seen from the worst direction.
    seen::Seen worst(ObjectIndex index, const seen::Surface& finest, const seen::Surface& level,
                     double error, size_t& direction) const {
        return seen::seen_worst(model_.objects[index].bound(), finest, level, side_, error,
                                &direction);
    }

    void picture(ObjectIndex index, size_t lod, const std::string& path) {
        const seen::Surface finest = finest_of(index);
        const seen::Surface level = level_of(index, lod);
        const double error = model_.objects[index].representations[lod].summary.error;
        size_t direction = 0;
        worst(index, finest, level, error, direction);
        constexpr int kSide = 180;
        const seen::Eye eye =
            seen::eye_at(model_.objects[index].bound(), measure::cube_directions()[direction],
                         error / seen::kPixelAt1m);
        const std::vector<double> there = seen::distances(eye, finest, level, kSide, error);
        const std::vector<double> back = seen::distances(eye, level, finest, kSide, error);
        image::Image out;
        out.width = 3 * kSide;
        out.height = kSide;
        out.pixels.assign(4 * out.size(), 1.0F);
        for (int row = 0; row < kSide; ++row) {
            for (int column = 0; column < kSide; ++column) {
                const size_t pixel = static_cast<size_t>(row) * kSide + static_cast<size_t>(column);
                const glm::dvec3 ray = seen::ray_of(eye, kSide, column, row);
                const glm::dvec3 shown = shade(finest, eye, ray);
                put(out, column, row, shown);
                put(out, kSide + column, row, shade(level, eye, ray));
                const double off = std::max(there[pixel], back[pixel]) / error;
                const double gray = 0.5 + 0.5 * shown.x;
                put(out, 2 * kSide + column, row,
                    off > 1 ? glm::mix(glm::dvec3(1, 0.8, 0.2), glm::dvec3(0.8, 0, 0),
                                       std::min(1.0, std::log2(off) / 4))
                            : glm::dvec3(gray));
            }
        }
        image::write_png(path, out);
    }

private:
    static Model with_pictures(const segment::Store& store) {
        Model model = store.read();
        store.load_pictures(model);
        return model;
    }

    hierarchy::MeshSource source() const {
        return [this](const Representation& level) {
            return level.resident() ? std::get<std::shared_ptr<const Mesh>>(level.payload)
                                    : store_.load_mesh(level.summary.hash);
        };
    }

    static glm::dvec3 shade(const seen::Surface& surface, const seen::Eye& eye,
                            const glm::dvec3& ray) {
        const ray::RayHit hit = surface.scene->first_hit(eye.position, ray);
        if (!hit.hit)
            return glm::dvec3(1);
        const glm::dvec3 area = area_vector(surface.mesh, hit.triangle);
        const double length = std::max(glm::length(area), 1e-300);
        const double facing = std::abs(glm::dot(area / length, glm::normalize(ray)));
        const double above = std::abs(area.z) / length;
        return glm::dvec3(0.15 + 0.45 * facing + 0.25 * above);
    }

    static void put(image::Image& out, int column, int row, const glm::dvec3& color) {
        for (int i = 0; i < 3; ++i)
            out.pixels[4 * static_cast<size_t>(row * out.width + column) + static_cast<size_t>(i)] =
                static_cast<float>(color[i]);
    }

    segment::Store store_;
    Model model_;
    int side_;
    seen::Surfaces surfaces_;
};

struct LevelToLookAt {
    ObjectIndex object;
    size_t lod;
};

std::vector<LevelToLookAt> levels_of(const Model& model, size_t most) {
    std::set<std::pair<Hash, Hash>> known;
    std::vector<LevelToLookAt> all;
    for (const ObjectIndex index : bottom_up(model)) {
        const std::vector<Representation>& levels = model.objects[index].representations;
        for (size_t lod = 1; lod < levels.size(); ++lod) {
            if (known.insert({levels[0].summary.hash, levels[lod].summary.hash}).second)
                all.push_back({index, lod});
        }
    }
    if (all.size() <= most)
        return all;
    std::vector<LevelToLookAt> out;
    for (size_t i = 0; i < most; ++i)
        out.push_back(all[i * all.size() / most]);
    return out;
}

void look_at_all(Bench& bench, size_t most) {
    const Model& model = bench.model();
    std::optional<seen::Surface> finest;
    ObjectIndex last = kNoObject;
    for (const LevelToLookAt& one : levels_of(model, most)) {
        const Object& object = model.objects[one.object];
        const RepresentationSummary& summary = object.representations[one.lod].summary;
        if (!finest || last != one.object)
            finest.emplace(bench.finest_of(one.object));
        last = one.object;
        if (finest->scene->triangles() == 0)
            continue;
        const seen::Surface level = bench.level_of(one.object, one.lod);
        size_t direction = 0;
        const seen::Seen shown = bench.worst(one.object, *finest, level, summary.error, direction);
        const bool clear = finest->scene->see_through() || finest->skin->transmits() ||
                           level.scene->see_through() || level.skin->transmits();
        const nlohmann::json line = {
            {"object", object.name},
            {"lod", one.lod},
            {"kind", std::string(name_of(summary.kind))},
            {"group", object.group()},
            {"clear", clear},
            {"triangles", summary.cost.triangles},
            {"of", finest->mesh.triangles.size()},
            {"size", 2 * object.bound().radius},
            {"error", summary.error},
            {"seen", std::max(0.0, shown.quantile - finest->error)},
            {"largest", shown.largest},
            {"share", shown.share},
            {"pixels", shown.pixels},
            {"direction", direction},
        };
        const auto replace = nlohmann::json::error_handler_t::replace;
        std::printf("%s\n", line.dump(-1, ' ', false, replace).c_str());
        std::fflush(stdout);
    }
}

}  // namespace

int main(int count, char** arguments) {
    std::map<std::string, std::string> options{{"--most", "1000000"}, {"--side", "96"}};
    std::string store;
    for (int i = 1; i < count; ++i) {
        const std::string word = arguments[i];
        if (word.rfind("--", 0) == 0 && i + 1 < count)
            options[word] = arguments[++i];
        else
            store = word;
    }
    if (store.empty()) {
        std::fprintf(stderr,
                     "usage: bench_errors STORE [--most N] [--side N] "
                     "[--picture FILE --object NAME --lod N]\n");
        return 2;
    }
    try {
        Bench bench(store, std::stoi(options["--side"]));
        if (options.count("--picture") == 0) {
            look_at_all(bench, std::stoul(options["--most"]));
            return 0;
        }
        const std::vector<Object>& objects = bench.model().objects;
        const size_t lod = std::stoul(options["--lod"]);
        for (ObjectIndex i = 0; i < objects.size(); ++i) {
            if (objects[i].name == options["--object"] && lod < objects[i].representations.size()) {
                bench.picture(i, lod, options["--picture"]);
                return 0;
            }
        }
        std::fprintf(stderr, "no object of that name has that level\n");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
    }
    return 1;
}
