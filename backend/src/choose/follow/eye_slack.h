// SPDX-License-Identifier: GPL-3.0-or-later
// Eye slack: how far the eye may go before something could be drawn by another level.
#pragma once

#include "choose/cut_chooser.h"

#include <limits>

namespace lodestone::choose {

/// The eye on its way from where a cut was chosen anew. Decisions depend on distances, and these
/// change no faster than the eye moves. source: temporal coherence of distances; Lipschitz bounds,
/// exact but for a margin for rounding
struct EyeWalk {
    const ChoiceTable& table;
    View view;
    double frame = 1;   // the size of a pixel at 1 m, when the cut was chosen anew
    double pixel = 1;   // the size of a pixel of the view at 1 m
    double travel = 0;  // the length of the eye's way since then
    double away = 0;    // the distance of the eye from the origin

    EyeWalk(const ChoiceTable& of, const View& from);
    /// False: the eye is so far away that the kept facts are worth nothing.
    bool advance_to(const View& next);

    OccurrenceSight sight_of(const Affine& world, const SeenNode& seen) const;
    /// Whether two sizes of pixels are equal but for rounding, as when a camera turns.
    static bool same_pixels(double a, double b);
};

/// The range of distances in which a node is drawn as it is, and the bound whose distance counts.
/// It fills one line of a cache, and nothing else is read of a node that may have left its range.
struct alignas(64) DrawnRange {
    glm::dvec3 center{0.0};  // the center of the box of its bound, in the world
    glm::vec3 half{0.0F};    // half of the sides of that box
    float radius = 0;        // the radius of the ball of its bound
    float low = 0;           // in metres; rounded up
    float high = 0;          // in metres; rounded down
    /// The error that the distance may have, apart from that of the eye's position; infinite: no
    /// range is known.
    float margin = std::numeric_limits<float>::infinity();

    DrawnRange() = default;
    DrawnRange(const EyeWalk& walk, const CutNode& node, const Affine& world, const SeenNode& seen);
    /// The distance of the bound from the eye, without margins.
    double distance(const glm::dvec3& eye) const;
};

/// How long the ranges of nodes last, however the eye goes. A step reads these 12 bytes of every
/// node; each number is rounded to the safe side.
class EyeSlack {
public:
    size_t size() const { return expires_.size(); }
    void resize(size_t count);
    void grow(size_t most);
    /// Sets the slack of a node that is now drawn by another level.
    void set(size_t index, const EyeWalk& walk, const DrawnRange& range, const CutNode& node,
             const SeenNode& seen);
    /// Renews the slack of a node that is drawn as before, from where the eye is now. False:
    /// another level may have to draw it.
    bool renew(size_t index, const EyeWalk& walk, const DrawnRange& range);
    void copy(const EyeSlack& from, size_t index, size_t to);
    /// Nodes [begin, end) move to `to`; the slack that lies there is lost.
    void move(size_t begin, size_t end, size_t to);
    /// Finds the nodes whose slack is used up.
    void find_expired(double travel, std::vector<uint32_t>& expired) const;
    /// Finds the first of the largest errors on screen. Errors grow no faster than the eye may have
    /// come nearer, so only those that may be the largest are computed. `seen`, `ranges`: by
    /// CutNode::transform; `guess`: a node, or none.
    void find_largest(const EyeWalk& walk, const std::vector<SeenNode>& seen,
                      const std::vector<DrawnRange>& ranges, Cut& cut, uint32_t guess);

private:
    /// The travel at which another level may have to draw it; rounded down.
    std::vector<float> expires_;
    std::vector<float> sizes_;   // error / size of a pixel at 1 m, rounded up; -1: opened
    std::vector<float> places_;  // distance + travel when it was looked at, rounded down
};

}  // namespace lodestone::choose
