// SPDX-License-Identifier: GPL-3.0-or-later
// Sky things: what a cut draws and what is placed below it, as far as the sky's light on it goes.
#pragma once

#include "base/job.h"
#include "choose/cut.h"
#include "light/sky/sky_scene.h"

#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

namespace lodestone::povray {

/// A placement of something that is not a group.
struct SkyLeaf {
    ObjectIndex object = kNoObject;
    Affine world;
    bool hides = false;  // rests, and is met by shadow rays
};

/// A choice of the cut.
struct SkyThing {
    const Representation* representation = nullptr;
    Affine world;
    uint32_t first = 0;  // of the leaves that are it or below it
    uint32_t end = 0;    // of them
    bool seen = false;   // false: it is drawn as nothing
    bool moves = false;
    bool group = false;  // stands in for a group
};

/// Adds a transform to a hash.
void hash_transform(Hasher& hasher, const Affine& world);

/// The things of a cut, and all that is placed. Model, cut and job must outlive it.
class SkyThings {
public:
    /// `still`: what moves in an animation rests. Throws Error(Cancelled).
    SkyThings(const Model& model, const choose::Cut& cut, uint64_t most_triangles, bool still,
              const Job& job);

    /// How much is too much; "" when it is not.
    const std::string& too_much() const { return too_much_; }
    const std::vector<SkyLeaf>& leaves() const { return leaves_; }
    /// Those of the cut, by position in cut.chosen.
    const std::vector<SkyThing>& things() const { return things_; }
    /// The hash of all that hides the sky, and of where it does.
    Hash scene() const { return scene_; }
    /// How often a finest level is placed.
    uint64_t placements_of(Hash finest) const { return placed_.at(finest).count; }

    const Representation& finest_of(const SkyLeaf& leaf) const;
    /// The finest level of what a thing is, or the stand-in that it is.
    const Representation& finest_of(const SkyThing& thing) const;
    /// The leaves of a range, as SkyThing has one, that hide the sky.
    std::vector<light::SkyOccluder> occluders(size_t first, size_t end) const;
    /// Whether nothing is drawn for a thing itself.
    bool skipped(const SkyThing& thing) const;
    /// Whether a thing's shares, if its corners have some, are found where it stands.
    bool in_place(const SkyThing& thing) const;
    /// By thing, 1: it is one of the largest opaque copies that are not in place, which may have
    /// shares of their own in a picture alone. `pixels`: how many of them a thing is across; 0: it
    /// is not seen. Leaves, whose outlines make them large as text, are lit about alike everywhere.
    std::vector<uint8_t> largest_copies(const std::function<double(size_t)>& pixels) const;
    /// The triangles that splits may add to something where it stands: large things have more of
    /// them, whatever the cut draws.
    size_t splits_of(const SkyThing& thing) const;

private:
    /// A finest level, and how often it is placed.
    struct PlacedMesh {
        uint64_t count = 0;
        uint64_t triangles = 0;
        bool copied = false;  // true: each copy has shares of its own
    };

    std::string collect(uint64_t most_triangles);
    /// Whether light goes through some of it.
    bool clear(const Representation& representation) const;
    bool moves(const Object& object) const { return !still_ && object.deforms; }
    bool walk(ObjectIndex object, const Affine& world, RayMask hidden, bool below);
    /// Finds the meshes whose copies all have shares of their own: those of few placements, and
    /// of the others the smallest.
    void choose_copied();

    const Model& model_;
    const choose::Cut& cut_;
    bool still_;
    const Job& job_;
    std::string too_much_;
    std::vector<SkyLeaf> leaves_;
    std::vector<SkyThing> things_;
    std::unordered_map<Hash, PlacedMesh> placed_;   // leaves by finest level
    std::unordered_map<Hash, uint32_t> stand_ins_;  // things by stand-in
    size_t visits_ = 0;
    uint64_t triangles_ = 0;
    double sizes_ = 0;  // radii of all that hides the sky
    Hash scene_ = 0;
};

}  // namespace lodestone::povray
