// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/deviation.h"

#include "base/parallel.h"
#include "measure/point_tree.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <set>
#include <tuple>

namespace lodestone::measure {
namespace {

using Sample = SurfaceSample;

constexpr double kQuantile = 0.999;
// Of the places of one look; and looks of a smaller share of the area than this are details, which
// their places alone answer for.
constexpr double kLookQuantile = 0.99;
constexpr double kLeastLookShare = 0.002;
// Of levels as fine as scans a few vertices decide the quantile: those of the stand-in are taken
// all, up to so many at least.
constexpr uint32_t kLevelVertices = 16384;

double weight_of(const std::vector<Sample>& samples, const std::vector<size_t>& indices) {
    double sum = 0;
    for (const size_t i : indices)
        sum += samples[i].weight;
    return sum;
}

/// The smallest distance that `share` of the weight of the samples in `order` does not exceed.
double quantile(const std::vector<Sample>& samples, const std::vector<double>& distances,
                std::vector<size_t> order, double share) {
    // Mostly the farthest few decide: the rest is not sorted.
    constexpr size_t kFirst = 32;
    const double all = weight_of(samples, order);
    const auto farther = [&](size_t a, size_t b) {
        return distances[a] != distances[b] ? distances[a] > distances[b] : a < b;
    };
    const auto at = [&](size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    double above = 0;
    double out = 0;
    size_t end = 0;
    for (size_t begin = 0; begin < order.size(); begin = end) {
        end = std::min(order.size(), std::max(kFirst, 4 * begin));
        if (end < order.size())
            std::nth_element(at(begin), at(end), order.end(), farther);
        std::sort(at(begin), at(end), farther);
        for (size_t i = begin; i < end; ++i) {
            out = distances[order[i]];
            above += samples[order[i]].weight;
            if (above > (1 - share) * all)
                return out;
        }
    }
    return out;
}

/// `places`: how far every sample is from the other surface; `moves`: how far its look was moved.
Deviation summary(const std::vector<Sample>& samples, const std::vector<double>& places,
                  const std::vector<double>& moves) {
    Deviation out;
    std::vector<size_t> all(samples.size());
    std::map<uint16_t, std::vector<size_t>> moved;  // looks of which anything moved
    for (size_t i = 0; i < all.size(); ++i) {
        all[i] = i;
        out.max = std::max({out.max, places[i], moves[i]});
        if (moves[i] > 0)
            moved[samples[i].look];
    }
    for (size_t i = 0; i < samples.size(); ++i) {
        const auto at = moved.find(samples[i].look);
        if (at != moved.end())
            at->second.push_back(i);
    }
    const double least = kLeastLookShare * weight_of(samples, all);
    out.error = quantile(samples, places, std::move(all), kQuantile);
    for (const auto& [look, indices] : moved) {
        if (weight_of(samples, indices) >= least)
            out.error = std::max(out.error, quantile(samples, moves, indices, kLookQuantile));
    }
    return out;
}

/// Whether the quantile of all samples is above that.
bool is_above(const std::vector<Sample>& samples, const std::vector<double>& places, double least) {
    double above = 0;
    double all = 0;
    for (size_t i = 0; i < samples.size(); ++i) {
        all += samples[i].weight;
        above += places[i] > least ? samples[i].weight : 0;
    }
    return above > (1 - kQuantile) * all;
}

/// Whether the error of all samples is larger than `useless` without any doubt, by some of them.
bool surely_above(double useless, const std::vector<Sample>& samples,
                  const std::vector<size_t>& some, const std::vector<double>& places,
                  const std::vector<double>& moves) {
    // Many times as much as the quantiles allow, of samples enough.
    constexpr double kPlaces = 0.02;
    constexpr double kMoves = 0.06;
    constexpr size_t kFewest = 6;
    constexpr double kLeastShare = 5 * kLeastLookShare;
    struct Sum {
        double all = 0;
        double above = 0;
        size_t count = 0;
        void add(double weight, bool is_above) {
            all += weight;
            above += is_above ? weight : 0;
            count += is_above ? 1 : 0;
        }
    };
    if (!std::isfinite(useless))
        return false;
    Sum place;
    std::map<uint16_t, Sum> looks;
    for (const size_t i : some) {
        place.add(samples[i].weight, places[i] > useless);
        looks[samples[i].look].add(samples[i].weight, moves[i] > useless);
    }
    if (place.count >= kFewest && place.above > kPlaces * place.all)
        return true;
    return std::any_of(looks.begin(), looks.end(), [&](const auto& look) {
        const Sum& moved = look.second;
        return moved.count >= kFewest && moved.above > kMoves * moved.all &&
               moved.all > kLeastShare * place.all;
    });
}

constexpr size_t kEvery = 8;  // divides a block
// At so many samples of each look, if it has them, what became of it is asked; what solids of a mean
// color miss changes little from one sample to the next, and takes long.
constexpr size_t kAsked = 512;
constexpr size_t kAskedOfMixed = 256;

/// 1 for the samples that are asked for looks: at least `wanted` of each look, evenly, or all.
std::vector<uint8_t> asked_for_looks(const std::vector<Sample>& samples, size_t wanted) {
    std::map<uint16_t, size_t> counts;
    for (const Sample& sample : samples)
        ++counts[sample.look];
    counts.erase(kAnyLook);
    std::map<uint16_t, size_t> ranks;
    std::vector<uint8_t> out(samples.size(), 0);
    for (size_t i = 0; i < samples.size(); ++i) {
        const auto at = counts.find(samples[i].look);
        if (at == counts.end())
            continue;
        const size_t stride = std::clamp<size_t>(at->second / wanted, 1, kEvery);
        const size_t rank = ranks[samples[i].look]++;
        out[i] = i % kEvery == 0 || rank == 0 || (stride < kEvery && rank % stride == 0) ? 1 : 0;
    }
    return out;
}

/// Gives samples that were not asked what the one of their look before them has.
void spread(const std::vector<Sample>& samples, const std::vector<uint8_t>& asked,
            std::vector<double>& moves) {
    std::map<uint16_t, double> last;
    for (size_t i = 0; i < samples.size(); ++i) {
        if (samples[i].look == kAnyLook)
            continue;
        if (asked[i] != 0)
            last[samples[i].look] = moves[i];
        else
            moves[i] = last[samples[i].look];
    }
}

/// Whether two places can be seen at once: not the grass from above and the road from below.
bool face_alike(const glm::dvec3& a, const glm::dvec3& b) {
    constexpr double kUnknown = 0.5;  // square of a length; sides are unit vectors
    return glm::dot(a, a) < kUnknown || glm::dot(b, b) < kUnknown || glm::dot(a, b) > 0;
}

}  // namespace

/// What can be seen of the finest, in the orders that are asked for.
class DeviationReference::Seen {
public:
    Seen(const std::vector<Sample>& visible, const Looks* palette)
        : visible_(visible), glowing_(glowing(visible, palette)) {
        // Every so many of the visible points are enough for a mean.
        constexpr size_t kMostPoints = 512;
        std::map<uint16_t, std::pair<std::vector<glm::dvec3>, std::vector<uint32_t>>> looks;
        for (uint32_t i = 0; i < visible.size(); ++i) {
            if (visible[i].look == kAnyLook)
                continue;
            auto& [points, numbers] = looks[visible[i].look];
            points.push_back(visible[i].point);
            numbers.push_back(i);
        }
        for (auto& [look, list] : looks)
            by_look_.try_emplace(look, std::move(list.first), std::move(list.second));
        const size_t step = std::max<size_t>(1, visible.size() / kMostPoints);
        for (size_t run = 0; run < visible.size(); run += step) {
            // Any one of each run: they were drawn evenly, and every so many of such are in one
            // place.
            const size_t i = std::min(run + scramble(run) % step, visible.size() - 1);
            if (visible[i].look != kAnyLook)
                mixed_.push_back({visible[i].point, visible[i].side,
                                  Looks::light_of(visible[i].color), visible[i].look});
        }
    }

    /// Whether a look is a lamp among the others: much brighter by itself than the whole is in the
    /// mean.
    bool glows(uint16_t look) const { return look < glowing_.size() && glowing_[look] != 0; }

    /// The distance to the nearest point of look `look` that can be seen, from the same side; `most`
    /// where it is not less.
    double nearest(const Sample& from, uint16_t look, double most) const {
        const auto tree = by_look_.find(look);
        if (tree == by_look_.end())
            return most;
        return std::sqrt(tree->second.nearest(from.point, most * most, [&](uint32_t i) {
            return face_alike(visible_[i].side, from.side);
        }));
    }

    /// The same for what shows a color.
    double nearest_of_color(const Sample& from, const glm::dvec3& color, double most) const {
        double square = most * most;
        for (const auto& [look, tree] : by_look_) {
            square = tree.nearest(from.point, square, [&](uint32_t i) {
                return Looks::alike(visible_[i].color, color) &&
                       face_alike(visible_[i].side, from.side);
            });
        }
        return std::sqrt(square);
    }

    /// The radius around a point within which the visible colors mix (as light does, in a pixel that
    /// shows them all) to `color`; `most` where it is not less, or not even all of them do.
    double mixing_radius(const Sample& from, const glm::dvec3& color, double most) const {
        struct Near {
            double square;
            uint16_t look;
            uint32_t index;
            bool operator<(const Near& other) const {
                return std::tie(square, look, index) <
                       std::tie(other.square, other.look, other.index);
            }
        };
        constexpr size_t kFirst = 16;
        std::vector<Near> near;
        near.reserve(mixed_.size());
        for (uint32_t i = 0; i < mixed_.size(); ++i) {
            const glm::dvec3 arm = mixed_[i].point - from.point;
            const double square = glm::dot(arm, arm);
            if (square < most * most && face_alike(mixed_[i].side, from.side))
                near.push_back({square, mixed_[i].look, i});
        }
        const Looks::Lights wanted = Looks::lights_alike(color);
        glm::dvec3 sum(0.0);
        // Mostly the nearest few are enough: the rest is not sorted.
        size_t end = 0;
        for (size_t begin = 0; begin < near.size(); begin = end) {
            end = std::min(near.size(), std::max(kFirst, 2 * begin));
            const auto at = [&](size_t i) { return near.begin() + static_cast<ptrdiff_t>(i); };
            if (end < near.size())
                std::nth_element(at(begin), at(end), near.end());
            std::sort(at(begin), at(end));
            for (size_t i = begin; i < end; ++i) {
                sum += mixed_[near[i].index].light;
                if (wanted.hold(sum / static_cast<double>(i + 1)))
                    return std::sqrt(near[i].square);
            }
        }
        return most;
    }

    /// Whether these are the samples that numbers are of.
    bool holds(const std::vector<Sample>& samples) const { return &samples == &visible_; }

    /// The same of visible point `number`, however far; infinite where they never mix to it. Kept
    /// for the next stand-in of that color.
    double mixing_radius_at(size_t number, const glm::dvec3& color) const {
        constexpr double kNever = std::numeric_limits<double>::infinity();
        const std::shared_ptr<const Radii> radii = radii_of(color);
        std::atomic<double>& known = radii->by_number[number];
        double radius = known.load(std::memory_order_relaxed);
        if (radius < 0) {
            radius = mixing_radius(visible_[number], color, kNever);
            known.store(radius, std::memory_order_relaxed);
        }
        return radius;
    }

private:
    /// Mixing radii for one color, by visible point; negative where not asked for yet.
    struct Radii {
        glm::dvec3 color;
        std::unique_ptr<std::atomic<double>[]> by_number;
    };

    std::shared_ptr<const Radii> radii_of(const glm::dvec3& color) const {
        const std::lock_guard lock(mutex_);
        if (!radii_ || radii_->color != color) {
            auto fresh = std::make_shared<Radii>();
            fresh->color = color;
            fresh->by_number = std::make_unique<std::atomic<double>[]>(visible_.size());
            for (size_t i = 0; i < visible_.size(); ++i)
                fresh->by_number[i].store(-1, std::memory_order_relaxed);
            radii_ = std::move(fresh);
        }
        return radii_;
    }

    struct Mixed {
        glm::dvec3 point;
        glm::dvec3 side;
        glm::dvec3 light;
        uint16_t look;
    };

    static std::vector<uint8_t> glowing(const std::vector<Sample>& visible, const Looks* palette) {
        constexpr double kMuch = 2;
        std::vector<uint8_t> out;
        if (palette == nullptr)
            return out;
        const auto brightest = [](const glm::dvec3& light) {
            return std::max({light.x, light.y, light.z});
        };
        double light = 0;
        double weight = 0;
        std::set<uint16_t> looks;
        for (const Sample& sample : visible) {
            if (sample.look == kAnyLook)
                continue;
            const double covered = sample.weight * palette->opacity(sample.look);
            light += covered * brightest(Looks::light_of(sample.color));
            weight += covered;
            looks.insert(sample.look);
        }
        for (const uint16_t look : looks) {
            out.resize(std::max<size_t>(out.size(), look + size_t{1}), 0);
            const double own = brightest(palette->emission(look));
            out[look] = own > 0 && own * weight > kMuch * light ? 1 : 0;
        }
        return out;
    }

    const std::vector<Sample>& visible_;
    std::vector<uint8_t> glowing_;  // by look
    std::map<uint16_t, PointTree> by_look_;
    std::vector<Mixed> mixed_;
    mutable std::mutex mutex_;
    mutable std::shared_ptr<const Radii> radii_;
};

/// What the samples of one mesh are compared with.
struct DeviationReference::Against {
    const LookScenes& other;
    const Seen& seen;  // of the finest
    const LookScenes& finest;
    const Looks* palette;
    double none;            // the answer where there is nothing to find
    const Mesh& mesh;       // the other's
    const ray::Skin* skin;  // likewise

    /// What the other shows at a point of its own; `varies`: elsewhere on the triangle other
    /// things.
    glm::dvec3 color_at(const ray::Closest& at, bool& varies) const {
        varies = skin != nullptr && skin->varies(mesh, mesh.slot(at.triangle));
        return varies ? Looks::color_of(skin->at(mesh, at.triangle, at.u, at.v))
                      : palette->color(other.look_of(at.triangle));
    }
    /// Whether what the other shows does not depend on where.
    bool shows_one_thing() const {
        if (palette == nullptr)
            return true;
        if (other.several())
            return false;
        if (skin == nullptr)
            return true;
        const std::set<uint16_t> slots(mesh.slots.begin(), mesh.slots.end());
        return !skin->varies(mesh, 0) &&
               std::none_of(slots.begin(), slots.end(),
                            [&](uint16_t slot) { return skin->varies(mesh, slot); });
    }
    /// Whether it shows a look that the finest has nowhere.
    bool is_mixed() const {
        return palette != nullptr && other.whole().triangles() > 0 && !finest.has(other.look_of(0));
    }
    /// How far a look was moved at a sample where the other mesh shows the look `theirs`.
    double moved_by(const std::vector<Sample>& samples, size_t number, uint16_t theirs,
                    const glm::dvec3& color) const {
        const Sample& sample = samples[number];
        const bool mixed = !finest.has(theirs);
        double least = none;
        // A lamp that is gone is missed from as far as anything is seen, though what is there
        // instead is near.
        const bool glows = seen.glows(sample.look);
        if (!mixed && !glows)
            least = seen.nearest(sample, theirs, least);
        least = std::min(least, other.nearest(sample.look, sample.point, least).distance);
        if (glows && !(glm::length(palette->emission(theirs)) > 0))
            return least;
        if (!mixed)
            return least;
        // Whatever shows it, the same color mixes in the same place: solids share their color.
        if (least < none || !seen.holds(samples))
            return seen.mixing_radius(sample, color, least);
        return std::min(least, seen.mixing_radius_at(number, color));
    }
    /// How far the same texture slid along the surface at a sample where the other shows another
    /// color.
    double slid_by(const Sample& sample, const ray::Closest& at, const glm::dvec3& color) const {
        double least = none;
        if (sample.metres_per_uv > 0 && !mesh.uvs.empty()) {
            const glm::dvec2 there = ray::uv_at(mesh, at.triangle, at.u, at.v);
            least = std::min(least, glm::length(there - sample.uv) * sample.metres_per_uv);
        }
        return seen.mixing_radius(sample, color, seen.nearest_of_color(sample, color, least));
    }
    /// How far what a sample shows was moved on the other mesh, whose nearest point is `at`.
    double move_of(const std::vector<Sample>& samples, size_t number,
                   const ray::Closest& at) const {
        const Sample& sample = samples[number];
        const uint16_t theirs = other.look_of(at.triangle);
        if (palette == nullptr)
            return 0;
        if (theirs == sample.look && !sample.varies)
            return 0;
        bool varies = false;
        const glm::dvec3 color = color_at(at, varies);
        const bool lamp = theirs != sample.look && seen.glows(sample.look);
        if ((varies || sample.varies) && !lamp && Looks::alike(color, sample.color))
            return 0;
        return theirs == sample.look ? slid_by(sample, at, color)
                                     : moved_by(samples, number, theirs, color);
    }
};

/// From the samples to the nearest points of the other mesh. What is not near the quantile is found
/// out no further than that it is below, and looks are asked for at some samples for all.
Deviation DeviationReference::measure(const std::vector<Sample>& samples, const Against& against,
                                      double useless, const Job& job) {
    constexpr size_t kFewSamples = 512;
    constexpr double kBelow = 0.97;  // a quantile of every eighth, below that of all
    std::vector<double> places(samples.size(), 0);
    std::vector<double> moves(samples.size(), 0);
    const ray::Scene& scene = against.other.whole();
    const bool one_thing = against.shows_one_thing();
    const std::vector<uint8_t> asked =
        asked_for_looks(samples, one_thing && against.is_mixed() ? kAskedOfMixed : kAsked);
    // `before`: what was near enough the last time, and has to be found out better.
    const auto visit = [&](size_t step, double enough, double before) {
        const bool again = before < std::numeric_limits<double>::infinity();
        const size_t count = (samples.size() + step - 1) / step;
        parallel_for((count + kBlock - 1) / kBlock, [&](size_t block) {
            job.check();
            uint32_t last = ray::kNoTriangle;
            size_t known = samples.size();  // whose place was found before
            for (size_t k = block * kBlock; k < std::min(count, (block + 1) * kBlock); ++k) {
                const size_t i = k * step;
                const Sample& sample = samples[i];
                bool looks = asked[i] != 0;
                if ((step == 1 && i % kEvery == 0) ||
                    (again && ((looks && !one_thing) || places[i] > before)))
                    continue;
                looks = looks && !again;
                if (!looks && known < samples.size()) {
                    // What is beside something that is near is near.
                    const double most =
                        places[known] + glm::length(sample.point - samples[known].point);
                    if (most <= enough) {
                        places[i] = most;
                        continue;
                    }
                }
                // Neighbors in the list are mostly neighbors in space. Where only the distance
                // counts, any point that is near enough will do.
                const ray::Closest closest =
                    scene.closest_point(sample.point, std::numeric_limits<double>::infinity(), last,
                                        looks && !one_thing ? 0 : enough);
                // Nothing in reach at all: a scene of triangles that have no finite corners.
                const bool found = std::isfinite(closest.distance);
                places[i] = found ? closest.distance : against.none;
                last = closest.triangle;
                known = i;
                if (looks && found)
                    moves[i] = against.move_of(samples, i, closest);
            }
        });
    };
    constexpr double kNever = std::numeric_limits<double>::infinity();
    visit(kEvery, 0, kNever);
    std::vector<size_t> some;
    for (size_t i = 0; i < samples.size(); i += kEvery)
        some.push_back(i);
    if (surely_above(useless, samples, some, places, moves))
        return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    const bool many = samples.size() >= kFewSamples;
    double enough = many ? quantile(samples, places, std::move(some), kBelow) : 0;
    visit(1, enough, kNever);
    for (const double less : {0.8, 0.5, 0.0}) {
        if (!(enough > 0) || is_above(samples, places, enough))
            break;
        const double before = enough;
        enough *= less;
        visit(1, enough, before);
    }
    spread(samples, asked, moves);
    return summary(samples, places, moves);
}

DeviationReference::DeviationReference(const Mesh& finest, const DeviationOptions& options,
                                       const Surface& surface, const Job& job)
    : options_(options),
      scenes_(finest, surface.looks, surface.skin, ray::Uses::Everything),
      sampler_(finest, scenes_.whole(), options.seed),
      palette_(surface.palette),
      diameter_(2 * radius_of(finest)) {
    if (!sampler_.empty()) {
        add_visible_points(finest, sampler_, surface, options.samples, job, visible_);
        const std::vector<WeightedVertex> vertices =
            weighted_vertices(finest, options.most_vertices, options.seed);
        if (surface.skin && surface.skin->transmits())
            add_vertex_samples(finest, scenes_.whole(), vertices, visible_);
        else
            add_visible_vertices(finest, scenes_.whole(), sampler_.sides(), vertices,
                                 ray_lift(diameter_ / 2), options.seed, job, visible_);
    }
    seen_ = std::make_unique<const Seen>(visible_, palette_);
}

DeviationReference::~DeviationReference() = default;

Deviation DeviationReference::of(const Mesh& stand_in, const Surface& surface, const Job& job,
                                 double useless) const {
    const LookScenes scenes(stand_in, surface.looks, surface.skin, ray::Uses::ClosestPoints);
    const double none = std::max(diameter_, 2 * radius_of(stand_in));
    if (scenes.whole().triangles() == 0 || scenes_.whole().triangles() == 0)
        return {none, none};
    // What the stand-in shows where, the visible points have asked already.
    std::vector<Sample> samples;
    add_area_samples(stand_in, scenes.whole(), options_.samples, options_.seed, samples);
    add_vertex_samples(stand_in, scenes.whole(),
                       weighted_vertices(stand_in, std::max(options_.most_vertices, kLevelVertices),
                                         options_.seed),
                       samples);
    const ray::Skin* const skin = surface.skin.get();
    const Deviation there =
        measure(visible_, {scenes, *seen_, scenes_, palette_, none, stand_in, skin}, useless, job);
    if (!std::isfinite(there.error))
        return there;
    const Deviation back =
        measure(samples, {scenes_, *seen_, scenes_, palette_, none, stand_in, skin}, useless, job);
    return {std::max(there.error, back.error), std::max(there.max, back.max)};
}

}  // namespace lodestone::measure
