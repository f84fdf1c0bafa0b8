// SPDX-License-Identifier: GPL-3.0-or-later
// Placement means: what is around each placement of the things whose copies share their light.
#pragma once

#include "base/findings_file.h"
#include "light/sky/sky_means.h"
#include "povray_export/lamp/placement_grades.h"
#include "povray_export/lamp/sky_things.h"

#include <map>
#include <utility>

namespace lodestone::povray {

/// The means of all placements of a finest level, or of the cut's placements of a stand-in.
struct MeansOfPlacements {
    const Representation* representation = nullptr;
    bool group = false;  // a stand-in
    std::vector<Affine> places;
    light::PlacedMeans found;
    std::vector<PlacementShade> shades;  // graded
    Hash key = 0;                        // where they are kept
};

/// All of them that a picture needs. First things are wanted, then what was kept is found and the
/// rest is baked, then all is graded.
class PlacementMeans {
public:
    /// The things, and the sky (null: the same everywhere), must outlive it.
    PlacementMeans(const SkyThings& all, const light::UnevenSky* uneven)
        : all_(all), uneven_(uneven) {}

    /// Wants those of a thing; returns them, which stay where they are, and its number among them.
    /// They are those of all placements of the finest level, so that grades do not depend on which
    /// of them the cut draws; those of a stand-in are of the cut's.
    std::pair<const MeansOfPlacements*, size_t> want(const SkyThing& thing);
    /// Finds what was kept, once all is wanted.
    void find(FindingsFile& kept);

    bool missing() const { return !missing_.empty(); }
    /// The rays of bake().
    uint64_t work() const;
    /// Finds what is missing, through `surfaces`, which it adds to. Throws Error(Cancelled).
    void bake(light::SkySurfaces& surfaces, const light::SkyScene& around, SharedProgress& progress,
              const Job& job);
    /// Keeps what was baked.
    void keep(FindingsFile& kept) const;
    void grade();

private:
    /// The number of a leaf among those of its finest level.
    size_t number_of_leaf(uint32_t leaf);
    /// The rays that tell what is around one placement: as many whatever is known already.
    int rays() const;
    light::PlacedMeans baked(const MeansOfPlacements& wanted, const light::SkySurface& surface,
                             const light::SkyScene& around, SharedProgress& progress,
                             const Job& job) const;

    const SkyThings& all_;
    const light::UnevenSky* uneven_;
    std::vector<uint32_t> numbers_;                              // by leaf
    std::map<std::pair<Hash, bool>, MeansOfPlacements> wanted_;  // with: a stand-in
    std::vector<MeansOfPlacements*> missing_;
};

}  // namespace lodestone::povray
