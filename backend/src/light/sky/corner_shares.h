// SPDX-License-Identifier: GPL-3.0-or-later
// Corner shares: what the rays of all triangles tell about their corners.
#pragma once

#include "light/sky/sky_sampler.h"
#include "light/sky/sky_shares.h"

#include <span>
#include <unordered_map>
#include <vector>

namespace lodestone::light {

/// Joins the shares of triangles at corners: those at one place that face the same way share one
/// number. Of leaves it is the light on what is seen of them: on each side, and at each place, as
/// often as it sees the sky itself, for whoever looks at a leaf looks from where it is open.
class CornerShares {
public:
    /// `welded`: a number for each place, by vertex; `sky`: null where it is the same everywhere.
    /// All must outlive the object.
    CornerShares(const Mesh& mesh, std::span<const uint32_t> welded, const SkySurface& surface,
                 const UnevenSky* sky);

    /// Adds a triangle's shares; all triangles are added in turn. `area`: placed, of any unit;
    /// `behind`: the shares are those of its back.
    void add(size_t triangle, const TriangleShares& shares, double area, bool behind = false);
    /// Lets corners side by side tell each other what their rays met, once all are added.
    void share_rays();
    /// Writes the bytes of all corners and the mean; `shares` are all that were added.
    void finish(std::span<const TriangleShares> shares, SkyShares& out) const;

private:
    /// Corners that share a number.
    struct CornerKey {
        uint32_t vertex;
        std::array<int, 3> normal;
        bool opaque;
        bool behind;
        bool operator==(const CornerKey&) const = default;
    };
    struct CornerKeyHash {
        size_t operator()(const CornerKey& key) const;
    };
    struct GroupShares {
        double seen = 0;
        double rays = 0;
        double back = 0;      // of what is seen: by the backs of leaves
        double count = 0;     // of rays
        double all_seen = 0;  // those inside of something too
        double all_rays = 0;
        UnevenLight uneven;
        bool opaque = true;

        void add(const GroupShares& other);
        /// The share of the side that is seen. See of_side_that_is_seen().
        double share(const UnevenSky* sky) const;
    };

    CornerKey key_of(size_t triangle, int corner, bool behind) const;
    bool opaque(size_t triangle) const { return surface_.opaque_slot(mesh_.slot(triangle)); }
    /// The mean of a triangle's corners.
    double mean_of_corners(size_t triangle) const;
    /// By how much places of leaves that are seen are lighter than corners tell: the mean over all
    /// leaves, at least 1.
    double of_places_that_are_seen(std::span<const TriangleShares> shares) const;

    const Mesh& mesh_;
    std::span<const uint32_t> welded_;
    const SkySurface& surface_;
    const UnevenSky* sky_;
    std::unordered_map<CornerKey, uint32_t, CornerKeyHash> known_;
    std::vector<GroupShares> groups_;
    std::vector<uint32_t> group_of_;  // by corner
    std::vector<double> areas_;       // by triangle
};

}  // namespace lodestone::light
