// SPDX-License-Identifier: GPL-3.0-or-later
// Sky sampler: the rays that tell how much of the sky the triangles of a placed surface see.
#pragma once

#include "light/environment/uneven_sky.h"
#include "light/sky/sky_horizon.h"
#include "light/sky/sky_scene.h"
#include "light/sky/sky_shares.h"
#include "measure/visible/sobol_points.h"

#include <array>
#include <optional>

namespace lodestone::light {

/// A placed surface, and what is around it.
struct SkyRequest {
    const SkySurface& surface;
    Affine world;
    /// All that hides the sky, the finest level of this surface too; null: the surface alone hides
    /// the sky from itself.
    const SkyScene* around = nullptr;
    /// Metres, own frame: how far the surface may lie from its finest level, or from what it stands
    /// in for.
    double error = 0;
    int rays = 128;     // about so many tell the share of a corner whose size is not known
    size_t splits = 0;  // about how many triangles splits may add
    int most_rays = 0;  // as `rays`, where triangles are larger than the mean; fewer: none more
    /// The finest level of the surface, or all that it stands for, in its frame: rays begin at the
    /// places of it that the level shows, for it lies behind some of its boards and before others.
    /// Null: it is the finest one, or there is none.
    const SkySurface* original = nullptr;
    /// By triangle of the surface, how much a picture shows of it: bytes of SkyShares::seen. Corners
    /// have as many rays as are seen; what is not seen has few, and is not split. Empty: all are
    /// seen.
    std::span<const uint8_t> seen = {};
    /// By triangle of the surface, 1: it is opaque and seen from behind, so that its share is that
    /// of its back. Empty: none is.
    std::span<const uint8_t> behind = {};
    /// The shares that were found for fewer seen triangles, whose splits are kept. Null: none were.
    const SkyShares* known = nullptr;
    /// How much of the sky below counts, for the surface alone.
    SkyHorizon horizon = {};
    /// The sky by direction; of a surface alone, whose placements may be turned, by height where all
    /// of them are upright. Null: it is the same everywhere.
    const UnevenSky* uneven = nullptr;
    /// Whether `behind` tells which side is seen, but for mirrors and copies that show both. Else a
    /// front that is dark may be the wall of a cave that is seen from outside.
    bool one_side = false;
    /// The place that the picture is seen from (world): no place that it sees lies inside of
    /// something. Shares found for one eye are kept for others. None: nowhere, or the picture is
    /// orthographic.
    std::optional<glm::dvec3> eye = {};
    /// Whether it is the floor of all: nobody sees what is below it, so it is split if it is a box,
    /// too.
    bool floor = false;
    /// Whether it is round all over, as a ball: corners side by side share their rays, for the light
    /// on them differs little.
    bool round = false;
};

/// Sums over rays of the light of an uneven sky, in parts of its color.
struct UnevenLight {
    glm::dvec3 seen{0.0};
    glm::dvec3 open{0.0};      // the same if nothing hid the sky
    glm::dvec3 expected{0.0};  // and so many of them in all directions

    void add(const UnevenLight& other, double weight) {
        seen += weight * other.seen;
        open += weight * other.open;
        expected += weight * other.expected;
    }
    /// The same of all rays, as far as these can tell.
    glm::dvec3 likely() const {
        glm::dvec3 out = seen;
        for (int i = 0; i < 3; ++i)
            out[i] *= open[i] > 0 ? expected[i] / open[i] : 1;
        return out;
    }
};

/// The answers of the rays of one triangle.
struct TriangleShares {
    std::array<double, 3> seen{};  // by corner, weighted by how near each ray began
    std::array<double, 3> back{};  // the part of it that rays to the back of a leaf saw
    std::array<double, 3> rays{};  // the sum of these weights
    /// The weights of rays that begin inside of something opaque, which are not in the others.
    std::array<double, 3> inside_rays{};
    /// By corner, of an uneven sky.
    std::array<UnevenLight, 3> uneven{};
    double passed = 0;    // what seen would be under a sky that is equally bright everywhere
    bool inside = false;  // true: all of it lies inside of something opaque
    /// The rays that were cast once more from the places of leaves, to the same sides: how many there
    /// are, what they saw, and the same times what the first ones saw.
    double again = 0;
    double again_seen = 0;
    double both_seen = 0;

    double share() const {
        const double sum = rays[0] + rays[1] + rays[2];
        return sum > 0 ? (seen[0] + seen[1] + seen[2]) / sum : 0;
    }
    /// The share of an equally bright sky.
    double open_share() const {
        const double sum = rays[0] + rays[1] + rays[2];
        return sum > 0 ? passed / sum : 0;
    }
};

/// The factor on the mean of two sides' shares that makes it the share of the side that is seen:
/// whoever looks at a leaf looks from where it is open, on each side as often as it sees the sky.
/// `front`, `back`: the shares, by so many rays each; what differs by chance does not count.
double of_side_that_is_seen(double front, double back, double rays);

/// Casts the rays of one request from triangles of a mesh that lies on its surface.
class SkySampler {
public:
    explicit SkySampler(const SkyRequest& request);

    double size() const { return size_; }
    /// Tells that the backs of a mesh are never seen.
    void note_closed(bool closed) { closed_ = closed; }

    /// The triangle in both frames; none for one without area.
    struct PlacedTriangle {
        std::array<glm::dvec3, 3> at;
        glm::dvec3 face;      // unit, own frame
        glm::dvec3 up;        // unit, world
        double longest = 0;   // edge, own frame
        double area = 0;      // world, twice
        bool turned = false;  // true: the faces are those of its back

        PlacedTriangle back() const;
    };
    std::optional<PlacedTriangle> placed(const Mesh& mesh, size_t triangle) const;

    /// The shares of a triangle: those of its back, where it is one of a level whose front lies
    /// inside of the original. There a thin thing became flat, and the back may be what is seen.
    /// `behind`: it is opaque and its back is what is seen.
    TriangleShares shares(const Mesh& mesh, size_t triangle, int rays, bool behind = false) const;

    /// A place where rays begin.
    struct SkyPlace {
        std::array<double, 4> point;    // of the sequence
        std::array<double, 3> weights;  // how near to the corners it is
        glm::dvec3 at;                  // own frame
        glm::dvec3 face;                // unit, own frame
        glm::dvec3 up;                  // unit, world
        glm::dvec3 normal;              // unit, world, smooth
        double longest = 0;             // edge of its triangle, own frame
    };
    /// A place on a triangle, or on the original there. `near`: a triangle of the original that may
    /// be near, which makes it faster; it becomes the one that was found.
    SkyPlace place(const Mesh& mesh, size_t triangle, const PlacedTriangle& placed, uint32_t number,
                   uint32_t& near) const;

    /// One ray: from where, whereto, and how near to the corners it begins.
    struct SkyRay {
        glm::dvec3 from;        // own frame
        glm::dvec3 from_world;  // a little farther from the surface: precision is that of all
        glm::dvec3 direction;   // unit, world
        std::array<double, 3> weights;
        bool open = false;  // false: it points into the surface
    };
    SkyRay ray(const SkyPlace& place, bool back, bool opposite = false) const;
    /// The same place, whose rays have other directions, by chance.
    static SkyPlace again(const SkyPlace& place, uint64_t seed);

    /// Whether a ray points below the horizon, and how much light there is where nothing hides it.
    bool down(const SkyRay& ray) const {
        return request_.horizon.down(to_own_.linear * ray.direction);
    }
    double light(const SkyRay& ray) const { return down(ray) ? request_.horizon.below : 1; }
    /// The sky in the direction of a ray, for the surface as it is placed or alone, and its
    /// luminance; 1 is the color of an uneven one.
    glm::dvec3 color(const SkyRay& ray, bool placed) const;
    double brightness(const SkyRay& ray, bool placed) const {
        return request_.uneven == nullptr ? 1 : request_.uneven->share_of(color(ray, placed));
    }

    /// Whether the sky is hidden on a ray: by anything, or by the surface itself.
    bool hidden(const SkyRay& ray, uint32_t& blocker) const;
    bool hidden_alone(const SkyRay& ray) const;

    /// Whether a triangle lies inside of something opaque: many of its rays meet backs.
    bool lies_inside(const Mesh& mesh, size_t triangle, const PlacedTriangle& placed) const;

private:
    /// The part of a sky's light on a ray that arrives, 0...1: none where anything hides it.
    double passed(const SkyRay& ray, uint32_t& blocker) const {
        const double sky = ray.open ? light(ray) : 0;
        return sky > 0 && !hidden(ray, blocker) ? sky : 0;
    }
    /// The light of the sky on a ray.
    double seen(const SkyRay& ray, uint32_t& blocker) const {
        const double part = passed(ray, blocker);
        return part > 0 ? part * brightness(ray, request_.around != nullptr) : 0;
    }
    /// The sum of what two rays of a place would see on the average if nothing hid the sky; `open`:
    /// of what these would.
    glm::dvec3 expected(const SkyPlace& place, bool both, const glm::dvec3& open) const;
    TriangleShares shares_of_front(const Mesh& mesh, size_t triangle, const PlacedTriangle& placed,
                                   int rays) const;
    /// The face and the smooth normal of a place on a triangle.
    static void face_of(const Mesh& mesh, size_t triangle, const PlacedTriangle& placed,
                        const glm::dmat3& normal_map, const std::array<double, 3>& weights,
                        SkyPlace& out);
    /// Moves a place to the original.
    void move_to_original(bool both, SkyPlace& place, uint32_t& near) const;
    /// Whether a slot of a level is cut out of a picture that the original does not show, as crossed
    /// cards are: it shows what is seen of the original along its normal.
    bool shows_own_picture(uint16_t slot) const;
    /// Moves a place to the first one of the original that is seen from outside along the normal.
    /// False: there is none.
    bool move_to_pictured(SkyPlace& place) const;
    /// Moves a place to the outermost face of the original, within the level's error, that faces
    /// alike: that is what the level shows there. False: there is none.
    bool move_to_outermost(SkyPlace& place) const;

    /// Makes the share of a dark triangle the mean of its sides: it may be the wall of a cave, or
    /// face the wrong way, and be seen from its back. Only the sky above counts there, for under a
    /// ground nobody looks.
    void add_back(const Mesh& mesh, size_t triangle, const PlacedTriangle& placed, int rays,
                  TriangleShares& out) const;

    /// Whether backs are all around above a place, as below a ground, and not as below a roof.
    bool lies_below_backs(const SkyPlace& place) const;
    /// Whether nothing is between a place and the eye; what is clear may count.
    bool seen_by_eye(const SkyPlace& place) const;

    /// Whether a ray ends at the back of something opaque within `reach` (world): the back of a
    /// roof is farther than that of what a thing stands in.
    bool meets_near_back(const SkyRay& ray, double reach) const;

    /// The surface that hides the sky from the requested one itself.
    const SkySurface& self() const {
        return request_.original != nullptr ? *request_.original : request_.surface;
    }

    const SkyRequest& request_;
    glm::dmat3 normal_map_;
    Affine to_own_;
    double size_ = 0;
    double above_ = 0;        // where rays begin, own frame
    double above_world_ = 0;  // and farther, world frame
    double enlarged_ = 1;     // by the placement
    bool flat_ = false;       // the placement leaves no body, which hides nothing from itself
    bool closed_ = true;
    measure::SobolPoints points_{7};
};

}  // namespace lodestone::light
