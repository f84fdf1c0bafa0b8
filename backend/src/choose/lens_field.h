// SPDX-License-Identifier: GPL-3.0-or-later
// Lens field: the effects of the detail lenses of a view on an occurrence (5.5.5, equation 5.18).
#pragma once

#include "model/model.h"

namespace lodestone::choose {

/// The most lenses of a view; more are refused.
/// Taste: each lens costs a little at every occurrence that it touches.
inline constexpr size_t kMostLenses = 1024;
/// The most lists of objects that lenses name.
/// Law: each list has one bit of a uint64_t.
inline constexpr size_t kMostFilters = 64;

/// The value 1 + (strength - 1) cos(pi d / 2 radius)^falloff for d < radius, and 1 outside.
double lens_profile(double strength, double radius, double falloff, double d);

/// A range that contains the values of d in a bound.
struct LensReach {
    double nearest = 0;
    double farthest = 0;
};
LensReach reach(const DetailLens& lens, const Bound& world);

class LensField {
public:
    /// Throws Error(InvalidArgument) with the name of a lens that makes no sense. `in_any_order`:
    /// paths stay valid, whatever was visited since; it takes more memory.
    LensField(const Model& model, const std::vector<DetailLens>& lenses, bool in_any_order = false);

    bool empty() const { return lenses_.empty(); }

    /// The facts that are known along a path: the lenses that touch the groups above, and the lists
    /// that hold any of these groups.
    struct LensPath {
        uint32_t begin = 0;  // in touching_
        uint32_t end = 0;
        uint64_t lists = 0;
    };
    LensPath root();

    struct LensEffect {
        /// The largest value in the bound, for the occurrence and anything below it.
        double refine = 1;
        bool open = false;  // a stand-in would show an object that a lens hides
        bool gone = false;  // a lens hides it
        LensPath below;     // the path of the objects it places
    };
    /// The effect on an occurrence. Occurrences are asked for in depth-first order (all below one
    /// come before the next beside it), or with `in_any_order` in any order in which groups come
    /// before what they place.
    LensEffect at(ObjectIndex object, bool group, const Bound& world, const LensPath& above);

private:
    struct Lens {
        LensShape shape = LensShape::Sphere;
        LensFilter filter = LensFilter::All;
        glm::dmat3 linear{1.0};  // from the world to the frame of the lens
        glm::dvec3 offset{0.0};
        glm::dvec3 row_lengths{1.0};
        double stretch = 1;
        glm::dvec3 center{0.0};  // in the world
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
    std::vector<uint64_t> in_list_;  // by object; empty without filters
    /// By object: the lists that hold it or something below it.
    std::vector<uint64_t> holds_list_;
    std::vector<uint32_t> touching_;  // lenses; a stack, or all that were ever found
    const bool in_any_order_;
};

}  // namespace lodestone::choose
