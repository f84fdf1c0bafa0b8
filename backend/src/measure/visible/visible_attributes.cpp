// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/visible/visible_attributes.h"

#include "base/parallel.h"
#include "measure/visible/principal_axes.h"
#include "measure/visible/stratified_points.h"
#include "model/finish.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

namespace lodestone::measure {
namespace {

/// Rays between two serial sums.
/// Taste: a larger value takes more memory, a smaller one has threads wait more often.
constexpr uint64_t kBatch = uint64_t{1} << 16u;
/// Rays of an even sequence between two sums.
/// Taste: what so many rays find stays in the cache; a larger value does not.
constexpr uint64_t kEvenBatch = uint64_t{1} << 11u;
/// Law: 95 % of a normal distribution lie within so many standard deviations.
constexpr double kConfidence = 1.96;
/// The factor on the paired error, for who stops by it stops rather too early than too late.
/// Fitted: bench_measure on the 20 reference shapes at 1 %: 97.2 % of results within the error, 89
/// % at least.
constexpr double kEarlyStop = 1.04;
/// Rays of the first batch.
/// Taste: a larger value wastes rays on convex shapes, a smaller one guesses the error from few.
constexpr uint64_t kFirstBatch = 512;
/// Rays of a later batch at least.
/// Taste: a larger value overshoots the wanted error, a smaller one sums up more often.
constexpr uint64_t kLeastBatch = 256;
/// Hits before the estimated error is believed.
/// Taste: a larger value casts more rays at sparse things, a smaller one may stop by luck.
constexpr uint64_t kFewestHits = 64;
/// Points for textures where all is seen and only textures are not known.
/// Taste: a larger value knows colors better; this one to 1 or 2 %.
constexpr uint32_t kTextureSamples = 4096;
/// The hits that are told of a surface that no ray was cast at.
/// Taste: large enough for shares by tag to a millionth.
constexpr uint64_t kHitsOfAll = uint64_t{1} << 20u;
/// Tags are below this.
/// Taste: a larger value lets the table of hits by tag take more than 128 MiB.
constexpr uint32_t kMostTags = uint32_t{1} << 24u;

/// Sums of the shown appearances.
struct ShownSums {
    glm::dvec3 color{0.0};
    glm::dvec3 emission{0.0};

    void add(const ray::SurfaceAppearance& shown, double weight) {
        color += weight * shown.color;
        emission += weight * shown.emission;
    }
};

/// The slots of a mesh's skin whose triangles show more than one thing.
class VaryingSkin {
public:
    VaryingSkin(const Mesh& mesh, const ray::MeshSkin* skin) : mesh_(mesh), skin_(skin) {
        uint16_t most = 0;
        for (const uint16_t slot : mesh.slots)
            most = std::max(most, slot);
        varies_.resize(size_t{most} + 1, 0);
        for (size_t slot = 0; skin != nullptr && slot < varies_.size(); ++slot)
            varies_[slot] = skin->varies(mesh, static_cast<uint16_t>(slot)) ? 1 : 0;
    }

    bool slot(size_t index) const { return varies_[index] != 0; }
    void add(const VisiblePoint& at, ShownSums& sums, double weight = 1) const {
        if (slot(mesh_.slot(at.triangle)))
            sums.add(skin_->at(mesh_, at.triangle, at.u, at.v), weight);
    }

private:
    const Mesh& mesh_;
    const ray::MeshSkin* skin_;
    std::vector<uint8_t> varies_;  // by slot
};

/// Sums over visible points, about a fixed point near them.
struct VisiblePointSums {
    glm::dvec3 origin{0.0};
    uint64_t rays = 0;
    uint64_t hits = 0;    // rays with a point
    uint64_t differ = 0;  // pairs of rays of which one hit
    double weight = 0;    // the weight of all points
    glm::dvec3 first{0.0};
    glm::dmat3 second{0.0};
    std::vector<double> by_triangle;  // the weight
    ShownSums varied;                 // the points in slots that vary

    void add(const VisiblePoint& at) {
        const glm::dvec3 arm = at.point - origin;
        weight += 1;
        first += arm;
        second += glm::outerProduct(arm, arm);
        by_triangle[at.triangle] += 1;
    }

    /// The relative error of the estimated area, 95 %, for any rays. Two hits and two misses are
    /// added (Agresti and Coull 1998), so that nothing is certain only because no ray has missed.
    double binomial_error() const {
        const double n = static_cast<double>(rays) + 4;
        const double p = (static_cast<double>(hits) + 2) / n;
        return kConfidence * std::sqrt((1 - p) / (p * n));
    }

    /// The same error for pairs of rays that share a cell: differences between cells are no error.
    /// A caller who stops by it stops rather too early than too late.
    double paired_error() const {
        const double h = static_cast<double>(std::max<uint64_t>(hits, 1));
        return kEarlyStop * kConfidence * std::sqrt(static_cast<double>(differ) + 2) / h;
    }
};

/// Casts rays 0 ... count - 1 of a sequence on all threads and adds what they found in their order.
/// The first of them are `known`.
template <typename Numbers>
void cast(const VisibleSampler& sampler, const VaryingSkin& varied, const Numbers& numbers,
          uint64_t count, bool with_points, std::span<const CastPoints> known,
          VisiblePointSums& tally, const Job& job) {
    std::vector<CastPoints> found(with_points ? count : 0);
    std::vector<uint8_t> hit(count, 0);
    parallel_for((count + kBlock - 1) / kBlock, [&](size_t block) {
        job.check();
        const ray::FlushDenormals burst;
        const uint64_t end = std::min<uint64_t>(count, (block + 1) * kBlock);
        for (uint64_t i = block * kBlock; i < end; ++i) {
            if (!with_points) {
                hit[i] = sampler.hits(numbers(static_cast<uint32_t>(i))) ? 1 : 0;
                continue;
            }
            if (i < known.size())
                found[i] = known[i];
            else
                found[i].count = sampler.cast(numbers(static_cast<uint32_t>(i)), found[i].points);
            hit[i] = found[i].count > 0 ? 1 : 0;
        }
    });
    for (const CastPoints& ray : found) {
        for (int i = 0; i < ray.count; ++i) {
            tally.add(ray.points[static_cast<size_t>(i)]);
            varied.add(ray.points[static_cast<size_t>(i)], tally.varied);
        }
    }
    for (size_t i = 0; i < hit.size(); ++i) {
        tally.hits += hit[i];
        tally.differ += (i & 1u) != 0 && hit[i] != hit[i - 1] ? 1 : 0;
    }
    tally.rays += count;
}

/// Whether twice the rays changed little. The halves of an even sequence make up for each other:
/// what the second one moves is mostly more than both together are off.
bool is_settled(const VisiblePointSums& before, const VisiblePointSums& now, double share) {
    // The area may move by so many times the share that the centroid may.
    // Fitted: bench_street.py on the street at 1, 2 and 4 px: SSIM and triangles stay, with a third
    // of the rays' time.
    constexpr double kArea = 5;
    if (before.hits < kFewestHits)
        return false;
    const glm::dvec3 mean = now.first / now.weight;
    double square = 0;  // the square of the radius of gyration
    for (int axis = 0; axis < 3; ++axis)
        square += now.second[axis][axis] / now.weight - mean[axis] * mean[axis];
    const glm::dvec3 moved = mean - before.first / before.weight;
    const double area = static_cast<double>(before.hits) / static_cast<double>(before.rays) *
                        static_cast<double>(now.rays) / static_cast<double>(now.hits);
    return glm::dot(moved, moved) <= share * share * square && std::abs(area - 1) <= kArea * share;
}

/// Casts a fixed number of rays, as even as can be.
void sample_evenly(const VisibleSampler& sampler, const VaryingSkin& varied,
                   const VisibleOptions& options, std::span<const CastPoints> known,
                   VisiblePointSums& tally, const Job& job) {
    const SobolPoints sobol(options.seed);
    const uint64_t most = std::min<uint64_t>(options.rays, ~0u);
    VisiblePointSums half;
    while (tally.rays < most) {
        const auto first = static_cast<uint32_t>(tally.rays);
        const auto numbers = [&](uint32_t i) { return sobol.point(first + i); };
        cast(sampler, varied, numbers, std::min(kEvenBatch, most - first), true,
             known.subspan(std::min<size_t>(first, known.size())), tally, job);
        job.progress(static_cast<double>(tally.rays) / static_cast<double>(most));
        if (!(options.settled > 0) || !std::has_single_bit(tally.rays))
            continue;
        if (is_settled(half, tally, options.settled))
            break;
        half = tally;
    }
}

/// Casts rays until the area is known well enough.
void sample_until_sure(const VisibleSampler& sampler, const VaryingSkin& varied,
                       const VisibleOptions& options, VisiblePointSums& tally, const Job& job) {
    const uint64_t most = std::min<uint64_t>(options.most_rays, ~0u) / StratifiedPoints::kStep *
                          StratifiedPoints::kStep;
    uint64_t next = kFirstBatch;
    for (uint64_t batch = 0; tally.rays < most; ++batch) {
        next = std::min({next, kBatch, most - tally.rays});
        const StratifiedPoints strata(scramble(options.seed) + batch, static_cast<uint32_t>(next));
        const auto numbers = [&](uint32_t i) { return strata.point(i); };
        const bool with_points = sampler.from_surface() || tally.rays < kMostLinesWithPoints;
        cast(sampler, varied, numbers, next, with_points, {}, tally, job);
        job.progress(static_cast<double>(tally.rays) / static_cast<double>(most));
        const double off = tally.paired_error() / options.relative_error;
        if (tally.hits >= kFewestHits && off <= 1)
            break;
        // The next batch has as many rays as the error asks for, but never more than there are: it
        // may be wrong.
        const double wanted = static_cast<double>(tally.rays) * (off * off - 1);
        next = static_cast<uint64_t>(
            std::clamp(wanted, static_cast<double>(kLeastBatch), static_cast<double>(tally.rays)));
        next = (next + StratifiedPoints::kStep - 1) / StratifiedPoints::kStep *
               StratifiedPoints::kStep;
    }
}

/// Adds all of the surface, by traversal.
void traverse(const Mesh& mesh, const VisibleSampler& sampler, const VaryingSkin& varied,
              const VisibleOptions& options, VisiblePointSums& tally) {
    const SurfaceInertia& inertia = sampler.inertia();
    const glm::dvec3 arm = inertia.center - tally.origin;
    tally.weight = inertia.area;
    tally.first = inertia.area * arm;
    tally.second = inertia.moments + inertia.area * glm::outerProduct(arm, arm);
    bool varies = false;
    for (size_t i = 0; i < tally.by_triangle.size(); ++i) {
        const double area = 0.5 * glm::length(area_vector(mesh, i));
        tally.by_triangle[i] = area > 0 && std::isfinite(area) ? area : 0;
        varies = varies || varied.slot(mesh.slot(i));
    }
    const SobolPoints sobol(options.seed);
    for (uint32_t i = 0; varies && i < kTextureSamples; ++i)
        varied.add(sampler.on_surface(sobol.point(i)), tally.varied,
                   inertia.area / kTextureSamples);
}

void add_surface(const Mesh& mesh, const ray::MeshSkin* skin, const VaryingSkin& varied,
                 const VisiblePointSums& tally, Attributes& out) {
    std::vector<double> by_slot;
    for (size_t i = 0; i < tally.by_triangle.size(); ++i) {
        const size_t slot = mesh.slot(i);
        if (by_slot.size() <= slot)
            by_slot.resize(slot + 1, 0);
        by_slot[slot] += tally.by_triangle[i];
    }
    ShownSums sums;
    for (size_t slot = 0; slot < by_slot.size(); ++slot) {
        if (by_slot[slot] == 0)
            continue;
        const double share = by_slot[slot] / tally.weight;
        out.shares.push_back({static_cast<uint16_t>(slot), share});
        if (varied.slot(slot))
            continue;
        sums.add(
            skin != nullptr ? skin->mean(static_cast<uint16_t>(slot)) : ray::SurfaceAppearance{},
            share);
    }
    out.color = sums.color + tally.varied.color / tally.weight;
    out.emission = sums.emission + tally.varied.emission / tally.weight;
    set_finish(out, mean_finish(out.shares, [&](uint16_t slot) {
                   return skin != nullptr ? skin->material(slot) : Material{};
               }));
}

}  // namespace

VisibleAttributes measure_visible(const Mesh& mesh, std::span<const Material> materials,
                                  const VisibleOptions& options, std::span<const uint32_t> tags,
                                  const Job& job) {
    image::TexelCache texels;
    const auto skin = std::make_shared<const ray::MeshSkin>(materials, texels);
    return measure_visible(mesh, ray::MeshScene(mesh, skin), skin, options, tags, job);
}

VisibleAttributes measure_visible(const Mesh& mesh, const ray::MeshScene& scene,
                                  const ray::SkinPtr& skin, const VisibleOptions& options,
                                  std::span<const uint32_t> tags, const Job& job) {
    return measure_visible(
        mesh, VisibleSampler(mesh, scene, options.seed, options.casting, options.relative_error),
        skin, options, tags, {}, job);
}

VisibleAttributes measure_visible(const Mesh& mesh, const VisibleSampler& sampler,
                                  const ray::SkinPtr& skin, const VisibleOptions& options,
                                  std::span<const uint32_t> tags, std::span<const CastPoints> known,
                                  const Job& job) {
    if (!tags.empty() && tags.size() != mesh.triangles.size())
        fail(Status::InvalidArgument, tags.size(), " tags for ", mesh.triangles.size(),
             " triangles");
    VisibleAttributes out;
    for (const uint32_t tag : tags) {
        if (tag >= kMostTags)
            fail(Status::InvalidArgument, "tag ", tag, " is not below ", kMostTags);
        if (tag >= out.hits_by_tag.size())
            out.hits_by_tag.resize(tag + 1, 0);
    }
    Attributes& attributes = out.attributes;
    attributes.surface_area = sampler.possible_area();
    if (sampler.empty())
        return out;
    const VaryingSkin varied(mesh, skin.get());
    const bool until_sure = options.relative_error > 0;
    VisiblePointSums tally;
    tally.origin = glm::dvec3(mesh.positions[mesh.triangles[0].x]);
    tally.by_triangle.resize(mesh.triangles.size(), 0);
    job.check();
    if (sampler.shows_all() && (until_sure || options.rays > 0))
        traverse(mesh, sampler, varied, options, tally);
    else if (until_sure)
        sample_until_sure(sampler, varied, options, tally, job);
    else
        sample_evenly(sampler, varied, options, known, tally, job);
    out.pilot_rays = sampler.pilot_rays();
    attributes.rays = tally.rays;
    if (sampler.shows_all())
        attributes.visible_area = tally.weight > 0 ? sampler.possible_area() : 0;
    else {
        attributes.relative_error = until_sure ? tally.paired_error() : tally.binomial_error();
        attributes.visible_area = sampler.reference_area() * static_cast<double>(tally.hits) /
                                  static_cast<double>(std::max<uint64_t>(tally.rays, 1));
    }
    if (!(tally.weight > 0))
        return out;
    const glm::dvec3 mean = tally.first / tally.weight;
    attributes.centroid = tally.origin + mean;
    attributes.moments =
        attributes.visible_area * (tally.second / tally.weight - glm::outerProduct(mean, mean));
    NormalMoments normals;
    for (size_t i = 0; i < tally.by_triangle.size(); ++i) {
        const glm::dvec3 area = area_vector(mesh, i);
        const double length = glm::length(area);
        if (tally.by_triangle[i] > 0 && length > 0)
            normals.add(area / length, tally.by_triangle[i]);
    }
    attributes.axes = principal_axes(attributes.moments, normals);
    attributes.normal_moment = normals.in_frame(attributes.axes);
    add_surface(mesh, skin.get(), varied, tally, attributes);
    out.share_by_tag.resize(out.hits_by_tag.size(), 0);
    for (size_t i = 0; i < tags.size(); ++i)
        out.share_by_tag[tags[i]] += tally.by_triangle[i] / tally.weight;
    const double hits = sampler.shows_all() ? static_cast<double>(kHitsOfAll) : tally.weight;
    for (size_t tag = 0; tag < out.hits_by_tag.size(); ++tag)
        out.hits_by_tag[tag] = static_cast<uint64_t>(std::llround(out.share_by_tag[tag] * hits));
    return out;
}

double visible_area(const VisibleSampler& sampler, uint64_t rays, const Job& job) {
    if (sampler.empty() || rays == 0)
        return 0;
    if (sampler.shows_all())
        return sampler.possible_area();
    const uint64_t count = std::min<uint64_t>(rays, ~0u);
    std::atomic<uint64_t> hits{0};
    parallel_for((count + kBlock - 1) / kBlock, [&](size_t block) {
        job.check();
        const ray::FlushDenormals burst;
        const uint64_t end = std::min<uint64_t>(count, (block + 1) * kBlock);
        uint64_t own = 0;
        for (uint64_t i = block * kBlock; i < end; ++i)
            own += sampler.hits(static_cast<uint32_t>(i)) ? 1 : 0;
        hits += own;
    });
    return sampler.reference_area() * static_cast<double>(hits) / static_cast<double>(count);
}

}  // namespace lodestone::measure
