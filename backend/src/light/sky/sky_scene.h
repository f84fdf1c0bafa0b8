// SPDX-License-Identifier: GPL-3.0-or-later
// SkyScene: what hides the sky, ready for rays: placed things, with what light goes through.
#pragma once

#include "base/job.h"
#include "light/sky/sky_shares.h"
#include "model/model.h"
#include "ray/placed_scenes.h"

#include <algorithm>
#include <optional>
#include <span>
#include <unordered_map>

namespace lodestone::light {

/// The mesh of a representation whose corners have shares of their own. Ellipsoids are smooth, of
/// 1,280 triangles: their outline is off by less than a pixel where they are 400 across.
Mesh drawn_mesh(const Representation& representation);
/// Its triangles.
uint64_t drawn_triangles(const Representation& representation);
/// Whether shares are the light on what is drawn: splits may be those of another mesh.
bool fits(const Representation& representation, const SkyShares& shares);

/// A placed representation that hides the sky from others.
struct SkyOccluder {
    const Representation* representation = nullptr;
    Affine world;
};

/// One representation as the sky meets it. Its solids are triangles.
struct SkySurface {
    std::shared_ptr<const Mesh> mesh;
    std::shared_ptr<const ray::MeshScene> scene;  // null: nobody casts rays at it alone
    std::vector<uint8_t> see_through;             // by slot: light goes through some or all of it
    std::vector<uint32_t> materials;              // by slot, of the model
    std::vector<Hash> masks;    // by slot (joined: of all), the picture of its mask; 0: none
    std::vector<double> areas;  // of each triangle and all before it

    double area() const { return areas.empty() ? 0 : areas.back(); }
    double area_of(size_t triangle) const {
        return areas[triangle] - (triangle > 0 ? areas[triangle - 1] : 0);
    }
    /// The triangle at a part of the area, 0...1; a number of none at its end.
    size_t triangle_at(double part) const {
        return static_cast<size_t>(std::lower_bound(areas.begin(), areas.end(), part * area()) -
                                   areas.begin());
    }
    bool opaque_slot(uint16_t slot) const {
        return slot >= see_through.size() || see_through[slot] == 0;
    }
};

/// The surfaces of representations, each made once. Masks and clear materials let their share of
/// rays through: always the same ones.
class SkySurfaces {
public:
    /// `texels`: the masks of the model as far as they are decoded.
    explicit SkySurfaces(const Model& model, std::shared_ptr<image::TexelCache> texels =
                                                 std::make_shared<image::TexelCache>())
        : model_(model), texels_(std::move(texels)) {}
    /// Makes what is not made yet. Throws Error(RaysUnavailable), Error(Internal) for what is not
    /// resident, Error(BadFile) for a mask that cannot be decoded.
    void add(std::span<const Representation* const> representations, const Job& job);
    /// The same without scenes, which take most of the time.
    void add_meshes(std::span<const Representation* const> representations, const Job& job);
    /// The surface of a representation that was added.
    const SkySurface& of(const Representation& representation) const {
        return known_.at(representation.summary.hash);
    }
    /// The skin of all materials of the model, by their numbers; null where all are opaque.
    ray::SkinPtr skin_of_model() const;

private:
    SkySurface made(const Representation& representation) const;
    std::shared_ptr<const ray::MeshScene> scene_of(const SkySurface& surface) const;

    const Model& model_;
    std::unordered_map<Hash, SkySurface> known_;
    std::shared_ptr<image::TexelCache> texels_;
    ray::SkinPtr skin_;
};

/// All that hides the sky. Const methods may be called from any thread.
///
/// Most placements are joined into one mesh of all that is opaque and one of the rest: their boxes
/// overlap, and a tree over triangles is left sooner than trees one in another (zengarden: a
/// quarter of the time). Those of meshes that are placed most often stay apart where there would be
/// too many triangles.
class SkyScene {
public:
    /// Triangles that are joined at most.
    /// Taste: a larger value is faster where much is placed often, for 0.2 KB and 1 us a triangle.
    static constexpr uint64_t kMostJoined = 1'500'000;

    /// The meshes of all occluders were added to the surfaces; scenes are where they are needed. Both
    /// outlive the scene.
    SkyScene(const Model& model, SkySurfaces& surfaces, std::span<const SkyOccluder> occluders,
             const Job& job, uint64_t most_joined = kMostJoined);

    /// Whether an occluder hides the sky in a direction. `blocker` begins as
    /// ray::PlacedScenes::kNothing and makes the next call faster.
    bool hides(const glm::dvec3& from, const glm::dvec3& direction, uint32_t& blocker) const {
        const glm::dvec3 near = from - origin_;
        return opaque_.hides(near, direction) || clear_.hides(near, direction) ||
               placed_.occluded(from, direction, kInfinity, blocker);
    }
    /// The first opaque thing in a direction, up to `far`: how far it is, and whether its back is
    /// met.
    struct SkyBlock {
        double t = kInfinity;
        bool back = false;
    };
    SkyBlock first_block(const glm::dvec3& from, const glm::dvec3& direction,
                         double far = kInfinity) const;
    /// The origin of coordinates of single precision: rays must begin above surfaces by their
    /// rounding. It lies amid most things, so that a huge one does not make it coarser for others.
    const glm::dvec3& origin() const { return origin_; }

private:
    struct JoinedMesh {
        Mesh mesh;
        std::optional<ray::MeshScene> scene;
        bool hides(const glm::dvec3& from, const glm::dvec3& direction) const {
            return scene && scene->occluded(from, direction);
        }
    };
    void join(const SkyOccluder& occluder, const SkySurface& surface);

    std::span<const SkyOccluder> occluders_;
    std::vector<const SkySurface*> surfaces_;
    JoinedMesh opaque_;
    JoinedMesh clear_;
    ray::PlacedScenes placed_;
    glm::dvec3 origin_{0.0};  // of the joined meshes
};

/// The first opaque thing of a surface in a direction, in its frame.
SkyScene::SkyBlock first_block(const SkySurface& surface, const glm::dvec3& from,
                               const glm::dvec3& direction, double far = kInfinity);

}  // namespace lodestone::light
