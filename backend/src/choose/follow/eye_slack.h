// SPDX-License-Identifier: GPL-3.0-or-later
// EyeSlack: how far the eye may go before something could be drawn otherwise.
#pragma once

#include "choose/cut_chooser.h"

#include <limits>

namespace lodestone::choose {

/// The eye on its way from where a cut was chosen anew. What is decided by distances changes no
/// faster than the eye moves. source: temporal coherence of distances; Lipschitz bounds, exact by a
/// margin for rounding
struct EyeWalk {
    const ChoiceTable& table;
    View view;
    double frame = 1;   // size of a pixel at 1 m, when it was chosen anew
    double pixel = 1;   // size of a pixel of the view at 1 m
    double travel = 0;  // of the eye since then
    double away = 0;    // of the eye from the origin

    EyeWalk(const ChoiceTable& of, const View& from);
    /// False: so far that what is known is worth nothing.
    bool advance_to(const View& next);

    OccurrenceSight sight_of(const Affine& world, const SeenNode& seen) const;
    /// Whether two sizes of pixels are one but for rounding, as when a camera turns.
    static bool same_pixels(double a, double b);
};

/// From how near to how far a node is drawn as it is, and what is that far: a line of a cache, all
/// that is read of a node that the eye may have come too near to, or too far from.
struct alignas(64) DrawnRange {
    glm::dvec3 center{0.0};  // of its bound's box, in the world
    glm::vec3 half{0.0F};    // of that box's sides
    float radius = 0;        // of its bound's ball
    float low = 0;           // metres, or more
    float high = 0;          // or less
    /// By so much the distance may be off, but for where the eye is; infinite: nothing is known.
    float margin = std::numeric_limits<float>::infinity();

    DrawnRange() = default;
    DrawnRange(const EyeWalk& walk, const CutNode& node, const Affine& world, const SeenNode& seen);
    /// Distance of the bound from the eye, but for margins.
    double distance(const glm::dvec3& eye) const;
};

/// How long nodes' ranges last, however the eye goes: what a step reads of every node, 12 bytes,
/// each number rounded to the safe side.
class EyeSlack {
public:
    size_t size() const { return expires_.size(); }
    void resize(size_t count);
    void grow(size_t most);
    /// Of a node that is drawn otherwise than before.
    void set(size_t index, const EyeWalk& walk, const DrawnRange& range, const CutNode& node,
             const SeenNode& seen);
    /// The same, from where the eye is now, of a node that is drawn as before. False: it may have
    /// to be drawn otherwise.
    bool renew(size_t index, const EyeWalk& walk, const DrawnRange& range);
    void copy(const EyeSlack& from, size_t index, size_t to);
    /// Nodes [begin, end) move to `to`; what lies there is lost.
    void move(size_t begin, size_t end, size_t to);
    /// Nodes whose slack is eaten.
    void find_expired(double travel, std::vector<uint32_t>& expired) const;
    /// The first of the largest errors on screen. Errors grow no faster than the eye may have come
    /// nearer; only what may then be the largest is computed. `seen`, `ranges`: by CutNode::transform;
    /// `guess`: a node, or none.
    void find_largest(const EyeWalk& walk, const std::vector<SeenNode>& seen,
                      const std::vector<DrawnRange>& ranges, Cut& cut, uint32_t guess);

private:
    std::vector<float> expires_;  // travel from which on it may be drawn otherwise, or less
    std::vector<float> sizes_;    // error / size of a pixel at 1 m, or more; -1: opened
    std::vector<float> places_;   // distance + travel when it was looked at, or less
};

}  // namespace lodestone::choose
