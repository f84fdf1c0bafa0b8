// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/placement_means.h"

#include "base/parallel.h"

#include <unordered_map>

namespace lodestone::povray {
namespace {

// The version of what is kept: raised whenever rays are chosen in another way.
// Law: part of every key.
constexpr uint32_t kMeansVersion = 20;
// Rays that tell what is around one placement, where placements are few.
// Taste: more are truer and take longer.
constexpr int kMeanRays = 128;
constexpr int kFewestMeanRays = 16;        // Taste: as kMeanRays
constexpr double kMostMeanRays = 300'000;  // Taste: rays of all placements together

}  // namespace

std::pair<const MeansOfPlacements*, size_t> PlacementMeans::want(const SkyThing& thing) {
    const Representation& representation = all_.finest_of(thing);
    MeansOfPlacements& wanted = wanted_[{representation.summary.hash, thing.group}];
    wanted.representation = &representation;
    wanted.group = thing.group;
    if (!thing.group) {
        wanted.places.resize(all_.placements_of(representation.summary.hash));
        return {&wanted, number_of_leaf(thing.first)};
    }
    wanted.places.push_back(thing.world);
    return {&wanted, wanted.places.size() - 1};
}

size_t PlacementMeans::number_of_leaf(uint32_t leaf) {
    if (numbers_.empty()) {
        numbers_.resize(all_.leaves().size());
        std::unordered_map<Hash, uint32_t> counts;
        for (size_t i = 0; i < all_.leaves().size(); ++i)
            numbers_[i] = counts[all_.finest_of(all_.leaves()[i]).summary.hash]++;
    }
    return numbers_[leaf];
}

int PlacementMeans::rays() const {
    return static_cast<int>(limited(kMostMeanRays / static_cast<double>(all_.leaves().size() + 1),
                                    kFewestMeanRays, kMeanRays));
}

void PlacementMeans::find(FindingsFile& kept) {
    for (uint32_t i = 0; i < numbers_.size(); ++i) {
        const SkyLeaf& leaf = all_.leaves()[i];
        const auto wanted = wanted_.find({all_.finest_of(leaf).summary.hash, false});
        if (wanted != wanted_.end())
            wanted->second.places[numbers_[i]] = leaf.world;
    }
    for (auto& [key, wanted] : wanted_) {
        Hasher hasher;
        hasher.value(kMeansVersion).value(all_.scene()).value(key.first);
        hasher.value(wanted.places.size()).value(rays());
        hasher.value(wanted.representation->summary.max_error);
        hasher.value(uneven_ != nullptr ? uneven_->hash() : 0);
        for (const Affine& world : wanted.places)
            hash_transform(hasher, world);
        wanted.key = hasher.result();
        const auto bytes = kept.find(wanted.key);
        auto found =
            bytes ? light::PlacedMeans::of_bytes(*bytes, wanted.places.size()) : std::nullopt;
        if (found)
            wanted.found = std::move(*found);
        else
            missing_.push_back(&wanted);
    }
}

uint64_t PlacementMeans::work() const {
    uint64_t work = 0;
    for (const MeansOfPlacements* wanted : missing_)
        work += wanted->places.size() * static_cast<uint64_t>(rays());
    return work;
}

void PlacementMeans::bake(light::SkySurfaces& surfaces, const light::SkyScene& around,
                          SharedProgress& progress, const Job& job) {
    std::vector<const Representation*> all;
    for (const MeansOfPlacements* wanted : missing_)
        all.push_back(wanted->representation);
    surfaces.add(all, job);
    for (MeansOfPlacements* wanted : missing_) {
        const light::PlacedMeans found =
            baked(*wanted, surfaces.of(*wanted->representation), around, progress, job);
        // The numbers are those that are kept, so that the next picture has the same.
        wanted->found =
            light::PlacedMeans::of_bytes(found.bytes(), found.means.size()).value_or(found);
    }
}

light::PlacedMeans PlacementMeans::baked(const MeansOfPlacements& wanted,
                                         const light::SkySurface& surface,
                                         const light::SkyScene& around, SharedProgress& progress,
                                         const Job& job) const {
    light::PlacedMeans out;
    out.means.resize(wanted.places.size());
    // Another picture places a stand-in elsewhere, and its shares would have to be found anew.
    if (!wanted.group)
        out.horizon = light::sky_horizon(surface, wanted.places, around);
    parallel_for(out.means.size(), [&](size_t i) {
        job.check();
        light::SkyRequest request{surface, wanted.places[i], &around,
                                  wanted.representation->summary.max_error, rays()};
        request.horizon = out.horizon;
        request.uneven = uneven_;
        out.means[i] = mean_sky_shares(request, rays());
        progress.add(static_cast<uint64_t>(rays()));
    });
    return out;
}

void PlacementMeans::keep(FindingsFile& kept) const {
    for (const MeansOfPlacements* wanted : missing_) {
        if (!wanted->found.means.empty())
            kept.add(wanted->key, wanted->found.bytes());
    }
}

void PlacementMeans::grade() {
    for (auto& [hash, wanted] : wanted_) {
        std::vector<PlacementShade> shades;
        for (const light::SkyMeans& mean : wanted.found.means) {
            const double ratio = mean.alone > 0 ? limited(mean.placed / mean.alone, 0, 1) : 1;
            const glm::dvec3 middle = wanted.representation->summary.bound.box.center();
            shades.push_back(
                {ratio, ratio + glm::dot(mean.slope, middle - mean.middle), mean.slope});
        }
        wanted.shades = graded(shades);
    }
}

}  // namespace lodestone::povray
