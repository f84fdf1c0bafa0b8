// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/sky_occlusion.h"

#include "base/findings_file.h"
#include "base/parallel.h"
#include "light/sky/joined_surface.h"
#include "povray_export/lamp/corner_rays.h"
#include "povray_export/lamp/placement_means.h"
#include "povray_export/lamp/seen_sides.h"
#include "povray_export/lamp/sky_grounds.h"
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
constexpr uint32_t kBakeVersion = 28;
// The share of a mesh's triangles from which on all count as seen.
// Taste: a larger value casts fewer rays now, and all of them for the next picture.
constexpr double kMostSeen = 0.6;
// The rays of a corner where triangles are large, over those where they are as large as most.
// Taste: a larger value has more noise on leaves and small things, where it is seen least, for fewer
// rays.
constexpr int kOfLargest = 2;

// The pixels across from which on the sides of a box have their own light of the sky.
// Taste: a smaller value shades smaller boxes, for twenty times the text of each.
constexpr double kSidesShow = 8;
// The pixels across from which on an ellipsoid is shaded, and not lit evenly.
// Taste: a smaller value shades smaller ones, for 1,280 triangles each.
constexpr double kRoundShows = 24;

class SkyPlanner {
public:
    SkyPlanner(const Model& model, const choose::Cut& cut, const SkyOcclusionOptions& options,
               const Job& job)
        : model_(model),
          options_(options),
          job_(job),
          bakes_(options.file, kSkyVersion),
          all_(model, cut, options.most_triangles, options.still, job),
          placements_(all_, options.uneven.get()),
          grounds_(all_),
          surfaces_(model,
                    options.texels ? options.texels : std::make_shared<image::TexelCache>()) {}

    /// The reason why there is none; "" when lights() are found.
    std::string run() {
        if (!all_.too_much().empty())
            return "There is too much in the scene to find what hides the sky: " + all_.too_much();
        if (options_.camera != nullptr)
            own_ = all_.largest_copies(
                [this](size_t i) { return shown(i) ? pixels_across(all_.things()[i]) : 0; });
        find_wanted();
        choose_rays();
        placements_.find(bakes_);
        SharedProgress progress(job_, work_of_bake());
        std::string without_rays;
        try {
            if (placements_.missing() && ray::available(&without_rays))
                placements_.bake(surfaces_, scene(), progress, job_);
            // Shares of copies depend on the ground that means know.
            for (auto& [key, wanted] : wanted_shares_)
                find_shares(key, wanted);
            if (baked())
                progress.add(kept_work_);
            if (!missing_.empty() && ray::available(&without_rays))
                bake_shares(progress);
        } catch (const Error&) {
            keep();  // what is finished is not found again
            throw;
        }
        if (!without_rays.empty())
            return "What hides the sky is not found: " + without_rays;
        keep();
        light_all();
        return "";
    }

    /// Whether anything had to be found.
    bool baked() const { return !missing_.empty() || placements_.missing(); }
    std::vector<SkyLightPtr> lights() { return std::move(lights_); }
    SkyLightPtr mean_of(size_t position) const {
        return position < means_.size() ? even_sky_light(means_[position]) : nullptr;
    }

private:
    /// A request for shares: of one surface alone, or of one thing as it is placed.
    struct WantedShares {
        const Representation* representation = nullptr;
        const SkyThing* placed = nullptr;          // null: alone
        const Representation* original = nullptr;  // the finest level; null: it is that
        const MeansOfPlacements* means = nullptr;  // null: it stands once, or moves
        light::SkyHorizon horizon;                 // of what moves
        Hash key = 0;                              // where it is kept
        /// By triangle, what any of the things shows: bytes of light::SkyShares::seen. Empty: all
        /// count as shown.
        std::vector<uint8_t> seen;
        bool sized = false;  // with their sizes in the picture
        SeenSides sides;
        std::vector<uint8_t> behind;                    // by triangle, 1: its back is seen
        int rays = 0;                                   // of a corner
        int whole_rays = 0;                             // the same where all of it is seen
        uint64_t work = 0;                              // about, for progress
        std::shared_ptr<const light::SkyShares> found;  // of as many or fewer until it is baked
    };

    static void hash_horizon(Hasher& hasher, const light::SkyHorizon& horizon) {
        hasher.value(horizon.below).value(horizon.upright);
        hasher.value(horizon.up.x).value(horizon.up.y).value(horizon.up.z);
    }

    Hash key_of(const SkyThing& thing, bool once) const {
        Hasher hasher;
        const RepresentationSummary& summary = thing.representation->summary;
        const SkyThing* placed = once ? &thing : nullptr;
        hasher.value(kBakeVersion).value(options_.rays);
        hasher.value(options_.uneven ? options_.uneven->hash() : 0);
        hasher.value(summary.hash).value(all_.finest_of(thing).summary.hash);
        hasher.value(summary.cost.triangles).value(thing.moves);
        if (thing.moves)
            hash_horizon(hasher, grounds_.horizon(thing));
        if (placed != nullptr) {
            hasher.value(all_.scene()).value(summary.max_error).value(all_.splits_of(*placed));
            hash_transform(hasher, placed->world);
            if (grounds_.is_floor(*placed))
                hasher.value(true);
        }
        return hasher.result();
    }

    /// Whether the corners of a thing have shares of their own.
    bool has_corners(const SkyThing& thing) const {
        const RepresentationSummary& summary = thing.representation->summary;
        return summary.kind == Kind::Mesh ||
               (summary.kind == Kind::Box && pixels_across(thing) >= kSidesShow) ||
               (summary.kind == Kind::Ellipsoid && pixels_across(thing) >= kRoundShows);
    }
    double pixels_across(const SkyThing& thing) const {
        return options_.pixels_across ? options_.pixels_across(transformed(
                                            thing.representation->summary.bound, thing.world))
                                      : 0;
    }

    /// Whether a picture shows anything of a thing.
    bool shown(size_t i) const {
        return !all_.skipped(all_.things()[i]) &&
               (options_.needs == nullptr || options_.needs->shown(i));
    }

    /// Lists all that is to be known.
    void find_wanted() {
        shares_of_.resize(all_.things().size(), nullptr);
        means_of_.resize(all_.things().size(), {nullptr, 0});
        for (size_t i = 0; i < all_.things().size(); ++i) {
            const SkyThing& thing = all_.things()[i];
            if (!shown(i)) {
                // Rays may have missed what full detail draws.
                if (!all_.skipped(thing) && !thing.moves && options_.needs->seen(i))
                    means_of_[i] = placements_.want(thing);
                continue;
            }
            const bool cornered = has_corners(thing);
            const bool once = cornered && ((!own_.empty() && own_[i] != 0) || all_.in_place(thing));
            if (cornered)
                shares_of_[i] = want_shares(thing, once);
            if (shares_of_[i] != nullptr)
                note_seen(i, *shares_of_[i]);
            if (!once && !thing.moves)
                means_of_[i] = placements_.want(thing);
            if (shares_of_[i] != nullptr)
                shares_of_[i]->means = means_of_[i].first;
        }
    }

    WantedShares* want_shares(const SkyThing& thing, bool once) {
        const Hash key = key_of(thing, once);
        const auto [at, fresh] = wanted_shares_.try_emplace(key);
        WantedShares& wanted = at->second;
        if (!fresh)
            return &wanted;
        wanted.representation = thing.representation;
        wanted.placed = once ? &thing : nullptr;
        if (thing.moves)
            wanted.horizon = grounds_.horizon(thing);
        if (all_.finest_of(thing).summary.hash != thing.representation->summary.hash)
            wanted.original = &all_.finest_of(thing);
        wanted.seen.assign(light::drawn_triangles(*thing.representation), 0);
        return &wanted;
    }

    /// Adds what the picture shows of a thing.
    void note_seen(size_t i, WantedShares& wanted) const {
        const std::span<const uint8_t> needs = options_.needs != nullptr
                                                   ? options_.needs->shown_triangles(i)
                                                   : std::span<const uint8_t>{};
        if (needs.size() != wanted.seen.size())
            wanted.seen.clear();
        for (size_t k = 0; k < wanted.seen.size(); ++k) {
            if ((needs[k] & light::kSeen) != 0)
                wanted.seen[k] = light::kSeenOfAnySize;
        }
        const SkyThing& thing = all_.things()[i];
        const Representation& drawn = *thing.representation;
        if (options_.camera != nullptr && drawn.summary.kind == Kind::Mesh && drawn.resident())
            wanted.sides.add(drawn.mesh(), thing.world, *options_.camera, options_.pixels, needs);
    }

    /// The triangles of a surface that count as seen.
    static uint64_t seen_of(const WantedShares& wanted) {
        if (wanted.seen.empty())
            return light::drawn_triangles(*wanted.representation);
        const auto unseen = std::count(wanted.seen.begin(), wanted.seen.end(), uint8_t{0});
        return wanted.seen.size() - static_cast<uint64_t>(unseen);
    }

    /// Chooses the rays of all surfaces by what is seen of them: where its size in the picture is
    /// known, by that.
    void choose_rays() {
        std::vector<uint64_t> counts;
        std::vector<uint64_t> all;
        for (auto& [key, wanted] : wanted_shares_) {
            wanted.behind = wanted.sides.behind();
            all.push_back(light::drawn_triangles(*wanted.representation));
            wanted.sized = wanted.sides.add_sizes(wanted.seen);
            if (!wanted.sized && static_cast<double>(seen_of(wanted)) >
                                     kMostSeen * static_cast<double>(wanted.seen.size()))
                wanted.seen.clear();
            counts.push_back(wanted.sized ? 0 : seen_of(wanted));
        }
        const int usual = std::max(options_.rays / kOfLargest, 1);
        const CornerRays rays(usual, counts, options_.pixels);
        const CornerRays whole_rays(usual, all, options_.pixels);
        for (auto& [key, wanted] : wanted_shares_) {
            wanted.rays = wanted.sized ? usual : rays.of(seen_of(wanted));
            wanted.whole_rays = whole_rays.of(light::drawn_triangles(*wanted.representation));
        }
    }

    /// Finds what was kept, or lists what is to be found: the shares of what the picture shows, and
    /// once another picture shows more those of all, so that many pictures do not begin anew.
    void find_shares(Hash key, WantedShares& wanted) {
        const light::SkyHorizon horizon = horizon_of(wanted);
        Hasher hasher;
        hash_horizon(hasher.value(key), horizon);
        // Cameras that see other sides do not find what another one saw anew each time.
        if (wanted.sides.known())
            hasher.value(true).array(std::span<const uint8_t>(wanted.behind));
        wanted.key = hasher.result();
        if (const auto bytes = bakes_.find(wanted.key)) {
            auto found =
                light::SkyShares::of_bytes(*bytes, light::drawn_triangles(*wanted.representation));
            if (found && light::fits(*wanted.representation, *found))
                wanted.found = std::make_shared<const light::SkyShares>(std::move(*found));
        }
        if (wanted.found) {
            const int rays =
                wanted.found->seen.empty() ? std::min(wanted.rays, wanted.whole_rays) : wanted.rays;
            if (wanted.found->rays >= static_cast<uint32_t>(rays) &&
                light::covers(*wanted.found, wanted.seen, wanted.behind)) {
                kept_work_ += wanted.work;
                return;
            }
            if (wanted.sized) {
                light::see_all(wanted.seen, wanted.found->seen);
            } else {
                wanted.seen.clear();
                wanted.rays = wanted.whole_rays;
            }
        }
        missing_.push_back(&wanted);
    }

    /// The sky below a thing alone.
    static light::SkyHorizon horizon_of(const WantedShares& wanted) {
        return wanted.placed == nullptr && wanted.means != nullptr ? wanted.means->found.horizon
                                                                   : wanted.horizon;
    }

    /// All that hides the sky, made when something is to be found.
    const light::SkyScene& scene() {
        if (around_)
            return *around_;
        if (options_.load_finest)
            options_.load_finest();
        occluders_ = all_.occluders(0, all_.leaves().size());
        std::vector<const Representation*> all;
        all.reserve(occluders_.size());
        for (const light::SkyOccluder& occluder : occluders_)
            all.push_back(occluder.representation);
        surfaces_.add_meshes(all, job_);
        return around_.emplace(model_, surfaces_, occluders_, job_);
    }

    /// The rays of a bake, about: two triangles have about one corner.
    uint64_t work_of_bake() {
        uint64_t work = 1 + placements_.work();
        for (auto& [key, wanted] : wanted_shares_) {
            wanted.work = 1 + static_cast<uint64_t>(wanted.rays) * seen_of(wanted) / 2;
            work += wanted.work;
        }
        return work;
    }

    static bool stands_in(const WantedShares& wanted) {
        return wanted.placed != nullptr && wanted.placed->group;
    }

    void bake_shares(SharedProgress& progress) {
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
            progress.add(wanted.work);
        });
        // One after the other, for what they stand for is joined and takes memory.
        for (WantedShares* wanted : missing_) {
            if (!stands_in(*wanted))
                continue;
            job_.check();
            const std::optional<light::SkySurface> joined = light::joined_surface(
                surfaces_, all_.occluders(wanted->placed->first, wanted->placed->end),
                wanted->placed->world);
            bake_one(*wanted, joined ? &*joined : nullptr);
            progress.add(wanted->work);
        }
    }

    void bake_one(WantedShares& wanted, const light::SkySurface* original) const {
        job_.check();
        light::SkyRequest request{
            surfaces_.of(*wanted.representation), {}, nullptr, 0, wanted.rays, 0, options_.rays};
        request.error = wanted.representation->summary.max_error;
        request.original = original;
        request.seen = wanted.seen;
        request.behind = wanted.behind;
        request.one_side = wanted.sides.known();
        request.known = wanted.found.get();
        request.horizon = horizon_of(wanted);
        request.uneven = options_.uneven.get();
        request.round = wanted.representation->summary.kind == Kind::Ellipsoid;
        if (wanted.placed != nullptr) {
            request.world = wanted.placed->world;
            request.around = &*around_;
            request.splits = all_.splits_of(*wanted.placed);
            request.floor = grounds_.is_floor(*wanted.placed);
            if (wanted.sides.known() && !options_.camera->orthographic)
                request.eye = options_.camera->position;
        }
        wanted.found = std::make_shared<const light::SkyShares>(sky_shares(request, job_));
    }

    /// Keeps what was found now.
    void keep() {
        for (const WantedShares* wanted : missing_) {
            if (wanted->found)
                bakes_.add(wanted->key, wanted->found->bytes());
        }
        placements_.keep(bakes_);
        bakes_.save();
    }

    /// The share of what moves and has one for all of it, as of a ball.
    double mean_of_mover(const SkyThing& thing) const {
        const double below = grounds_.horizon(thing).below;
        return options_.uneven ? options_.uneven->mean(below) : (1 + below) / 2;
    }

    void light_all() {
        placements_.grade();
        const glm::dvec3 color = options_.uneven ? options_.uneven->color() : glm::dvec3(1.0);
        lights_.resize(all_.things().size());
        means_.resize(all_.things().size(), 1);
        for (size_t i = 0; i < all_.things().size(); ++i) {
            const auto& [means, number] = means_of_[i];
            if (means != nullptr)
                means_[i] = means->found.means[number].placed;
            if (shares_of_[i] == nullptr) {
                if (all_.things()[i].moves && !all_.skipped(all_.things()[i]))
                    means_[i] = mean_of_mover(all_.things()[i]);
                if (means != nullptr || all_.things()[i].moves)
                    lights_[i] = even_sky_light(share_of_grade(grade_of_share(means_[i])));
                continue;
            }
            const std::shared_ptr<const light::SkyShares>& shares = shares_of_[i]->found;
            if (means == nullptr)
                means_[i] = shares->mean;
            const Hash key = shares_of_[i]->key;
            lights_[i] = means == nullptr
                             ? sky_light(key, shares, {}, {}, color)
                             : sky_light(key, shares, means->shades[number],
                                         means->representation->summary.bound.box, color);
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
    PlacementMeans placements_;
    SkyGrounds grounds_;
    light::SkySurfaces surfaces_;
    std::vector<light::SkyOccluder> occluders_;
    std::optional<light::SkyScene> around_;
    std::map<Hash, WantedShares> wanted_shares_;
    std::vector<WantedShares*> missing_;
    uint64_t kept_work_ = 0;    // of shares that were kept
    std::vector<uint8_t> own_;  // by thing, 1: a copy that has shares of its own. Empty: none
    std::vector<WantedShares*> shares_of_;                               // by thing
    std::vector<std::pair<const MeansOfPlacements*, size_t>> means_of_;  // by thing
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
    found_ = true;
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
