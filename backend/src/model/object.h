// SPDX-License-Identifier: GPL-3.0-or-later
// Object: the abstract thing ("the chair") and the ways to draw it.
#pragma once

#include "model/attributes.h"
#include "model/posed_surface.h"
#include "model/representation.h"

#include <optional>
#include <string>
#include <vector>

namespace lodestone {

enum class ObjectRole : uint8_t {
    Automatic = 0,    // the ground of what is beside it is recognized as such
    Environment = 1,  // wall, ground or sky: simplified, never made a primitive
    Ordinary = 2,
};

/// A material that a group's stand-ins were made from.
struct SourceMaterial {
    uint32_t material = 0;  // into Model::materials
    bool plain = false;     // without its textures
};

struct Object {
    std::string uid;   // stable, unique in its model
    std::string name;  // the user's
    ObjectRole role = ObjectRole::Automatic;
    // Its shape is another one in every frame: its levels follow it from one collapse for all
    // frames, or there are none. Nothing stands in for a group that holds it, so that no picture
    // ever shows a level of another frame.
    bool deforms = false;
    // One mesh of the user's whose loose parts were put into clusters: a group that counts as one
    // object and as one occurrence, whatever of it is drawn how finely.
    bool made_of_parts = false;
    /// The surface that the levels of a deforming object follow; may be null.
    std::shared_ptr<const PosedSurface> pose;
    /// The importance of the most important thing below it, over that of the object itself;
    /// infinite where something must not be drawn coarser than some level. See set_demands.
    double demand = 1;
    Hash source_hash = 0;  // of the finest representation and of all below it
    Hash shape_hash = 0;   // of the same without the materials' finishes
    Hash build_hash = 0;   // of the shape and settings its stand-ins were made from; 0 = none
    Hash bind_hash = 0;    // of the poses and settings its levels were collapsed from; 0 = none
    std::optional<Attributes> attributes;
    /// By slot, of the mesh that a group's stand-ins were made from. Those of a leaf are its own.
    std::vector<SourceMaterial> sources;
    /// Index = LOD number: 0 is the finest, errors rise strictly. Only [0] may be an assembly.
    std::vector<Representation> representations;

    bool group() const {
        return !representations.empty() && representations[0].summary.kind == Kind::Assembly;
    }
    const Bound& bound() const { return representations.at(0).summary.bound; }
    /// Around all of its levels: coarse ones may stick out of what they stand for.
    Bound reach() const {
        Bound all;
        for (const Representation& level : representations)
            all = merged(all, level.summary.bound);
        return all;
    }
};

}  // namespace lodestone
