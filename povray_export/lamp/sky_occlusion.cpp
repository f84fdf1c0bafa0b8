// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/sky_occlusion.h"

#include "base/findings_file.h"
#include "base/parallel.h"
#include "light/sky/joined_surface.h"
#include "light/sky/sky_means.h"
#include "povray_export/lamp/corner_rays.h"
#include "povray_export/lamp/placement_grades.h"
#include "povray_export/lamp/sky_things.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>

namespace lodestone::povray {
namespace {

// The version of what is kept: raised whenever rays or splits are chosen in another way.
// Law: part of every key.
constexpr uint32_t kBakeVersion = 15;
// Rays that tell what is around one placement, where placements are few.
// Taste: more are truer and take longer.
constexpr int kMeanRays = 128;
constexpr int kFewestMeanRays = 16;        // Taste: as kMeanRays
constexpr double kMostMeanRays = 300'000;  // Taste: rays of all placements together
// The share of a mesh's triangles from which on all count as seen.
// Taste: a larger value casts fewer rays now, and all of them for the next picture.
constexpr double kMostSeen = 0.6;
class SkyPlanner {
public:
    SkyPlanner(const Model& model, const choose::Cut& cut, const SkyOcclusionOptions& options,
               const Job& job)
        : model_(model),
          options_(options),
          job_(job),
          bakes_(options.file, kSkyVersion),
          all_(model, cut, options.most_triangles, job),
          surfaces_(model,
                    options.texels ? options.texels : std::make_shared<image::TexelCache>()) {}

    /// The reason why there is none; "" when lights() are found.
    std::string run() {
        if (!all_.too_much().empty())
            return "There is too much in the scene to find what hides the sky: " + all_.too_much();
        find_wanted();
        choose_rays();
        for (auto& [key, wanted] : wanted_means_)
            find_means(key.first, wanted);
        std::string without_rays;
        if (!missing_means_.empty() && !ray::available(&without_rays))
            return "What hides the sky is not found: " + without_rays;
        SharedProgress progress(job_, work_of_bake());
        bake([&] { bake_means(progress); });
        // Shares of copies depend on the ground that means know.
        for (auto& [key, wanted] : wanted_shares_)
            find_shares(key, wanted, progress);
        if (!missing_.empty() && !ray::available(&without_rays))
            return "What hides the sky is not found: " + without_rays;
        bake([&] { bake_shares(progress); });
        light_all();
        return "";
    }

    /// Whether anything had to be found.
    bool baked() const { return !missing_.empty() || !missing_means_.empty(); }
    std::vector<SkyLightPtr> lights() { return std::move(lights_); }
    SkyLightPtr mean_of(size_t position) const {
        return position < means_.size() ? even_sky_light(means_[position]) : nullptr;
    }

private:
    /// A request for the means of all placements of one finest level, or of one stand-in.
    struct WantedMeans {
        const Representation* representation = nullptr;
        bool group = false;  // a stand-in
        std::vector<Affine> places;
        light::PlacedMeans found;
        std::vector<PlacementShade> shades;  // graded
        Hash key = 0;
    };
    /// A request for shares: of one surface alone, or of one thing as it is placed.
    struct WantedShares {
        const Representation* representation = nullptr;
        const SkyThing* placed = nullptr;          // null: alone
        const Representation* original = nullptr;  // the finest level; null: it is that
        const WantedMeans* means = nullptr;        // of its placements; null: alone, and it moves
        Hash key = 0;                              // where it is kept
        /// By triangle, 1: any of the things shows it. Empty: all count as shown.
        std::vector<uint8_t> seen;
        int rays = 0;                                   // of a corner
        int whole_rays = 0;                             // the same where all of it is seen
        std::shared_ptr<const light::SkyShares> found;  // of as many or fewer until it is baked
    };
    Hash key_of(const SkyThing& thing, bool once) const {
        Hasher hasher;
        const RepresentationSummary& summary = thing.representation->summary;
        const SkyThing* placed = once ? &thing : nullptr;
        hasher.value(kBakeVersion).value(options_.rays);
        hasher.value(summary.hash).value(all_.finest_of(thing).summary.hash);
        hasher.value(summary.cost.triangles).value(thing.moves);
        if (placed != nullptr) {
            hasher.value(all_.scene()).value(summary.max_error).value(all_.splits_of(*placed));
            hash_transform(hasher, placed->world);
        }
        return hasher.result();
    }

    /// Lists all that is to be known.
    void find_wanted() {
        shares_of_.resize(all_.things().size(), nullptr);
        means_of_.resize(all_.things().size(), {nullptr, 0});
        for (size_t i = 0; i < all_.things().size(); ++i) {
            const SkyThing& thing = all_.things()[i];
            if (all_.skipped(thing) || (options_.needs != nullptr && !options_.needs->seen(i)))
                continue;
            const bool once = all_.in_place(thing);
            if (thing.representation->summary.kind == Kind::Mesh)
                shares_of_[i] = want_shares(thing, once);
            if (shares_of_[i] != nullptr)
                note_seen(i, *shares_of_[i]);
            if (!once && !thing.moves)
                want_means(i);
            if (shares_of_[i] != nullptr)
                shares_of_[i]->means = means_of_[i].first;
        }
        for (uint32_t i = 0; i < numbers_.size(); ++i) {
            const auto wanted =
                wanted_means_.find({all_.finest_of(all_.leaves()[i]).summary.hash, false});
            if (wanted != wanted_means_.end())
                wanted->second.places[numbers_[i]] = all_.leaves()[i].world;
        }
    }

    /// Whether what was kept is the light on this mesh: splits may be those of another one.
    static bool fits(const Representation& representation, const light::SkyShares& shares) {
        if (!representation.resident())
            return false;
        return light::whole(representation.mesh(), shares) ||
               light::split_for_sky(representation.mesh(), shares).has_value();
    }

    WantedShares* want_shares(const SkyThing& thing, bool once) {
        const Hash key = key_of(thing, once);
        const auto [at, fresh] = wanted_shares_.try_emplace(key);
        WantedShares& wanted = at->second;
        if (!fresh)
            return &wanted;
        wanted.representation = thing.representation;
        wanted.placed = once ? &thing : nullptr;
        if (all_.finest_of(thing).summary.hash != thing.representation->summary.hash)
            wanted.original = &all_.finest_of(thing);
        wanted.seen.assign(thing.representation->summary.cost.triangles, 0);
        return &wanted;
    }

    /// Adds what the picture shows of a thing.
    void note_seen(size_t i, WantedShares& wanted) const {
        const std::span<const uint8_t> needs =
            options_.needs != nullptr ? options_.needs->triangles(i) : std::span<const uint8_t>{};
        if (needs.size() != wanted.seen.size())
            wanted.seen.clear();
        for (size_t k = 0; k < wanted.seen.size(); ++k) {
            if ((needs[k] & light::kSeen) != 0)
                wanted.seen[k] = 1;
        }
    }

    /// The triangles of a surface that count as seen.
    static uint64_t seen_of(const WantedShares& wanted) {
        return wanted.seen.empty() ? wanted.representation->summary.cost.triangles
                                   : static_cast<uint64_t>(std::count(
                                         wanted.seen.begin(), wanted.seen.end(), uint8_t{1}));
    }

    /// Chooses the rays of all surfaces by what is seen of them.
    void choose_rays() {
        std::vector<uint64_t> counts;
        std::vector<uint64_t> all;
        for (auto& [key, wanted] : wanted_shares_) {
            all.push_back(wanted.representation->summary.cost.triangles);
            if (static_cast<double>(seen_of(wanted)) >
                kMostSeen * static_cast<double>(wanted.seen.size()))
                wanted.seen.clear();
            counts.push_back(seen_of(wanted));
        }
        const CornerRays rays(options_.rays, counts, options_.pixels);
        const CornerRays whole_rays(options_.rays, all, options_.pixels);
        for (auto& [key, wanted] : wanted_shares_) {
            wanted.rays = rays.of(seen_of(wanted));
            wanted.whole_rays = whole_rays.of(wanted.representation->summary.cost.triangles);
        }
    }

    /// Finds what was kept, or lists what is to be found: the shares of what the picture shows, and
    /// once another picture shows more those of all, so that many pictures do not begin anew.
    void find_shares(Hash key, WantedShares& wanted, SharedProgress& progress) {
        const light::SkyHorizon horizon = horizon_of(wanted);
        wanted.key = Hasher()
                         .value(key)
                         .value(horizon.below)
                         .value(horizon.up.x)
                         .value(horizon.up.y)
                         .value(horizon.up.z)
                         .result();
        if (const auto bytes = bakes_.find(wanted.key)) {
            auto found =
                light::SkyShares::of_bytes(*bytes, wanted.representation->summary.cost.triangles);
            if (found && fits(*wanted.representation, *found))
                wanted.found = std::make_shared<const light::SkyShares>(std::move(*found));
        }
        if (wanted.found) {
            const int rays =
                wanted.found->seen.empty() ? std::min(wanted.rays, wanted.whole_rays) : wanted.rays;
            if (wanted.found->rays >= static_cast<uint32_t>(rays) &&
                light::covers(*wanted.found, wanted.seen)) {
                progress.add(work_of(wanted));
                return;
            }
            wanted.seen.clear();
            wanted.rays = wanted.whole_rays;
        }
        missing_.push_back(&wanted);
    }

    /// What lies below a thing alone.
    static light::SkyHorizon horizon_of(const WantedShares& wanted) {
        return wanted.placed == nullptr && wanted.means != nullptr ? wanted.means->found.horizon
                                                                   : light::SkyHorizon{};
    }

    /// The means are those of all placements of the finest level, so that grades do not depend on
    /// which of them the cut draws; those of a stand-in are of the cut's.
    void want_means(size_t i) {
        const SkyThing& thing = all_.things()[i];
        const Representation& representation = all_.finest_of(thing);
        WantedMeans& wanted = wanted_means_[{representation.summary.hash, thing.group}];
        wanted.representation = &representation;
        wanted.group = thing.group;
        if (thing.group) {
            means_of_[i] = {&wanted, wanted.places.size()};
            wanted.places.push_back(thing.world);
        } else {
            means_of_[i] = {&wanted, number_of_leaf(representation.summary.hash, thing.first)};
        }
    }

    /// The number of a leaf among those of its finest level.
    size_t number_of_leaf(Hash hash, uint32_t leaf) {
        if (numbers_.empty()) {
            numbers_.resize(all_.leaves().size());
            std::unordered_map<Hash, uint32_t> counts;
            for (size_t i = 0; i < all_.leaves().size(); ++i)
                numbers_[i] = counts[all_.finest_of(all_.leaves()[i]).summary.hash]++;
        }
        wanted_means_[{hash, false}].places.resize(all_.placements_of(hash));
        return numbers_[leaf];
    }

    /// The rays that tell what is around one placement: as many whatever is known already.
    int mean_rays() const {
        return static_cast<int>(
            limited(kMostMeanRays / static_cast<double>(all_.leaves().size() + 1), kFewestMeanRays,
                    kMeanRays));
    }

    void find_means(Hash hash, WantedMeans& wanted) {
        Hasher hasher;
        hasher.value(kBakeVersion).value(all_.scene()).value(hash).value(wanted.places.size());
        hasher.value(mean_rays()).value(wanted.representation->summary.max_error);
        for (const Affine& world : wanted.places)
            hash_transform(hasher, world);
        wanted.key = hasher.result();
        const auto bytes = bakes_.find(wanted.key);
        auto found =
            bytes ? light::PlacedMeans::of_bytes(*bytes, wanted.places.size()) : std::nullopt;
        if (found)
            wanted.found = std::move(*found);
        else
            missing_means_.push_back(&wanted);
    }

    /// Does something, and keeps what was found even where it ends early.
    template <typename Work>
    void bake(const Work& work) {
        try {
            work();
        } catch (const Error&) {
            keep();  // what is finished is not found again
            throw;
        }
        keep();
    }

    /// All that hides the sky, made when something is to be found.
    const light::SkyScene& scene() {
        if (around_)
            return *around_;
        if (options_.load_finest)
            options_.load_finest();
        std::vector<const Representation*> all;
        for (const SkyLeaf& leaf : all_.leaves()) {
            if (!leaf.hides)
                continue;
            occluders_.push_back({&all_.finest_of(leaf), leaf.world});
            all.push_back(&all_.finest_of(leaf));
        }
        surfaces_.add(all, job_);
        return around_.emplace(model_, surfaces_, occluders_, job_);
    }

    /// The rays of a bake, about: two triangles have about one corner.
    uint64_t work_of(const WantedShares& wanted) const {
        return 1 + static_cast<uint64_t>(wanted.rays) * seen_of(wanted) / 2;
    }
    uint64_t work_of_bake() const {
        uint64_t work = 1;
        for (const auto& [key, wanted] : wanted_shares_)
            work += work_of(wanted);
        for (const WantedMeans* wanted : missing_means_)
            work += wanted->places.size() * static_cast<uint64_t>(mean_rays());
        return work;
    }

    static bool stands_in(const WantedShares& wanted) {
        return wanted.placed != nullptr && wanted.placed->group;
    }

    void bake_shares(SharedProgress& progress) {
        if (missing_.empty())
            return;
        scene();  // loads what is missing
        std::vector<const Representation*> all;
        for (const WantedShares* wanted : missing_) {
            all.push_back(wanted->representation);
            if (wanted->original != nullptr)
                all.push_back(wanted->original);
        }
        surfaces_.add(all, job_);
        parallel_for(missing_.size(), [&](size_t i) {
            WantedShares& wanted = *missing_[i];
            if (stands_in(wanted))
                return;
            bake_one(wanted,
                     wanted.original == nullptr ? nullptr : &surfaces_.of(*wanted.original));
            progress.add(work_of(wanted));
        });
        // One after the other, for what they stand for is joined and takes memory.
        for (WantedShares* wanted : missing_) {
            if (!stands_in(*wanted))
                continue;
            job_.check();
            const std::optional<light::SkySurface> joined = light::joined_surface(
                surfaces_, occluders_below(*wanted->placed), wanted->placed->world);
            bake_one(*wanted, joined ? &*joined : nullptr);
            progress.add(work_of(*wanted));
        }
    }

    void bake_one(WantedShares& wanted, const light::SkySurface* original) const {
        job_.check();
        light::SkyRequest request{
            surfaces_.of(*wanted.representation), {}, nullptr, 0, wanted.rays, 0, options_.rays};
        request.error = wanted.representation->summary.max_error;
        request.original = original;
        request.seen = wanted.seen;
        request.known = wanted.found.get();
        request.horizon = horizon_of(wanted);
        if (wanted.placed != nullptr) {
            request.world = wanted.placed->world;
            request.around = &*around_;
            request.splits = all_.splits_of(*wanted.placed);
        }
        wanted.found = std::make_shared<const light::SkyShares>(sky_shares(request, job_));
    }

    /// All that rests below a thing.
    std::vector<light::SkyOccluder> occluders_below(const SkyThing& thing) const {
        std::vector<light::SkyOccluder> out;
        for (uint32_t i = thing.first; i < thing.end; ++i) {
            const SkyLeaf& leaf = all_.leaves()[i];
            if (leaf.hides)
                out.push_back({&all_.finest_of(leaf), leaf.world});
        }
        return out;
    }

    void bake_means(SharedProgress& progress) {
        if (missing_means_.empty())
            return;
        const light::SkyScene& around = scene();
        std::vector<const Representation*> all;
        for (const WantedMeans* wanted : missing_means_)
            all.push_back(wanted->representation);
        surfaces_.add(all, job_);
        const int rays = mean_rays();
        for (WantedMeans* wanted : missing_means_) {
            light::PlacedMeans found;
            found.means.resize(wanted->places.size());
            const light::SkySurface& surface = surfaces_.of(*wanted->representation);
            if (!wanted->group)
                found.horizon = light::sky_horizon(surface, wanted->places, around);
            parallel_for(found.means.size(), [&](size_t i) {
                job_.check();
                light::SkyRequest request{surface, wanted->places[i], &around,
                                          wanted->representation->summary.max_error, rays};
                request.horizon = found.horizon;
                found.means[i] = mean_sky_shares(request, rays);
                progress.add(static_cast<uint64_t>(rays));
            });
            // The numbers are those that are kept, so that the next picture has the same.
            auto kept = light::PlacedMeans::of_bytes(found.bytes(), found.means.size());
            wanted->found = kept ? std::move(*kept) : std::move(found);
        }
    }

    /// Keeps what was found now.
    void keep() {
        for (const WantedShares* wanted : missing_) {
            if (wanted->found)
                bakes_.add(wanted->key, wanted->found->bytes());
        }
        for (const WantedMeans* wanted : missing_means_) {
            if (!wanted->found.means.empty())
                bakes_.add(wanted->key, wanted->found.bytes());
        }
        bakes_.save();
    }

    void light_all() {
        for (auto& [hash, wanted] : wanted_means_) {
            std::vector<PlacementShade> shades;
            for (const light::SkyMeans& mean : wanted.found.means) {
                const double ratio = mean.alone > 0 ? limited(mean.placed / mean.alone, 0, 1) : 1;
                const glm::dvec3 middle = wanted.representation->summary.bound.box.center();
                shades.push_back(
                    {ratio, ratio + glm::dot(mean.slope, middle - mean.middle), mean.slope});
            }
            wanted.shades = graded(shades);
        }
        lights_.resize(all_.things().size());
        means_.resize(all_.things().size(), 1);
        for (size_t i = 0; i < all_.things().size(); ++i) {
            const auto& [means, number] = means_of_[i];
            if (means != nullptr)
                means_[i] = means->found.means[number].placed;
            if (shares_of_[i] == nullptr) {
                if (means != nullptr)
                    lights_[i] = even_sky_light(share_of_grade(grade_of_share(means_[i])));
                continue;
            }
            const std::shared_ptr<const light::SkyShares>& shares = shares_of_[i]->found;
            if (means == nullptr)
                means_[i] = shares->mean;
            const Hash key = shares_of_[i]->key;
            lights_[i] = means == nullptr ? sky_light(key, shares, {}, {})
                                          : sky_light(key, shares, means->shades[number],
                                                      means->representation->summary.bound.box);
        }
        grade_means();
    }

    /// Other levels have one factor each: those of one finest level are graded, as its copies are.
    void grade_means() {
        std::unordered_map<Hash, std::vector<size_t>> alike;
        for (size_t i = 0; i < all_.things().size(); ++i) {
            const SkyThing& thing = all_.things()[i];
            if (!all_.skipped(thing) && lights_[i])
                alike[all_.finest_of(thing).summary.hash].push_back(i);
        }
        for (const auto& [hash, numbers] : alike) {
            std::vector<PlacementShade> means;
            means.reserve(numbers.size());
            for (const size_t i : numbers)
                means.push_back({means_[i], means_[i], {}});
            means = graded(means);
            for (size_t i = 0; i < numbers.size(); ++i)
                means_[numbers[i]] = means[i].share;
        }
    }

    const Model& model_;
    const SkyOcclusionOptions& options_;
    const Job& job_;
    FindingsFile bakes_;
    SkyThings all_;
    light::SkySurfaces surfaces_;
    std::vector<light::SkyOccluder> occluders_;
    std::optional<light::SkyScene> around_;
    std::vector<uint32_t> numbers_;  // by leaf
    std::map<Hash, WantedShares> wanted_shares_;
    std::map<std::pair<Hash, bool>, WantedMeans> wanted_means_;  // with: a stand-in
    std::vector<WantedShares*> missing_;
    std::vector<WantedMeans*> missing_means_;
    std::vector<WantedShares*> shares_of_;                   // by thing
    std::vector<std::pair<WantedMeans*, size_t>> means_of_;  // by thing
    std::vector<SkyLightPtr> lights_;
    std::vector<double> means_;
};

}  // namespace

SkyOcclusion::SkyOcclusion(const Model& model, const choose::Cut& cut,
                           const SkyOcclusionOptions& options, Problems& problems, const Job& job)
    : lights_(cut.chosen.size()) {
    SkyPlanner planner(model, cut, options, job);
    std::string reason;
    try {
        reason = planner.run();
        baked_ = planner.baked();
    } catch (const Error& error) {
        if (error.status == Status::Cancelled)
            throw;
        reason = std::string("What hides the sky is not found: ") + error.what();
    }
    if (!reason.empty()) {
        problems.push_back({"", Severity::Info, "sky_not_occluded", reason});
        return;
    }
    lights_ = planner.lights();
    for (size_t i = 0; i < cut.chosen.size(); ++i) {
        if (lights_[i])
            means_.emplace_back(cut.chosen[i], planner.mean_of(i));
    }
}

SkyLightPtr SkyOcclusion::mean_of_node(uint32_t node) const {
    const auto at = std::lower_bound(means_.begin(), means_.end(), node,
                                     [](const std::pair<uint32_t, SkyLightPtr>& mean,
                                        uint32_t wanted) { return mean.first < wanted; });
    return at != means_.end() && at->first == node ? at->second : nullptr;
}

}  // namespace lodestone::povray
