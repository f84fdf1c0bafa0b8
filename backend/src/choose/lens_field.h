// SPDX-License-Identifier: GPL-3.0-or-later
// Lens field: what the detail lenses of a view do to an occurrence (5.5.5, equation 5.18).
#pragma once

#include "model/model.h"

namespace lodestone::choose {

/// More lenses than this are refused: each costs a little at everything it touches.
inline constexpr size_t kMostLenses = 1024;
/// Lists of objects: a bit of a mask for each.
inline constexpr size_t kMostFilters = 64;

/// 1 + (strength - 1) cos(pi d / 2 radius)^falloff for d < radius, 1 outside.
double lens_profile(double strength, double radius, double falloff, double d);

/// Least and greatest value of d in a bound, never less tight than true.
struct LensReach {
    double nearest = 0;
    double farthest = 0;
};
LensReach reach(const DetailLens& lens, const Bound& world);

class LensField {
public:
    /// Throws Error(InvalidArgument) naming a lens that makes no sense.
    /// `in_any_order`: paths stay valid, whatever was visited since; it takes more memory.
    LensField(const Model& model, const std::vector<DetailLens>& lenses, bool in_any_order = false);

    bool empty() const { return lenses_.empty(); }

    /// What is known along a path: which lenses touch what is above, and the lists that hold any of
    /// it.
    struct LensPath {
        uint32_t begin = 0;  // in touching_
        uint32_t end = 0;
        uint64_t lists = 0;
    };
    LensPath root();

    struct LensEffect {
        double refine = 1;  // the largest value anywhere in the bound, and for anything below
        bool open = false;  // a stand-in would show what a lens hides
        bool gone = false;  // hidden by a lens
        LensPath below;     // for what it places
    };
    /// Occurrences in depth-first order, what is below one before the next beside it, or in any in
    /// which groups come before what they place.
    LensEffect at(ObjectIndex object, bool group, const Bound& world, const LensPath& above);

private:
    struct Lens {
        LensShape shape = LensShape::Sphere;
        LensFilter filter = LensFilter::All;
        glm::dmat3 linear{1.0};  // world -> its frame
        glm::dvec3 offset{0.0};
        glm::dvec3 row_lengths{1.0};
        double stretch = 1;
        glm::dvec3 center{0.0};  // world
        double world_radius = 0;
        double radius = 1;
        double strength = 1;
        double falloff = 1;
        uint64_t list = 0;
    };
    static Lens prepared(const DetailLens& lens);
    static LensReach reach(const Lens& lens, const Bound& world);
    friend LensReach choose::reach(const DetailLens& lens, const Bound& world);

    std::vector<Lens> lenses_;
    std::vector<uint64_t> in_list_;     // by object; empty without filters
    std::vector<uint64_t> holds_list_;  // by object: lists that hold it or something below it
    std::vector<uint32_t> touching_;    // lenses; a stack, or all that was ever found
    const bool in_any_order_;
};

}  // namespace lodestone::choose
