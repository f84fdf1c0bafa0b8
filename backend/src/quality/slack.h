// SPDX-License-Identifier: GPL-3.0-or-later
// Slack: how far the eye may go before something could be drawn otherwise.
#pragma once

#include "quality/chooser.h"

namespace lodestone::quality {

/// The eye on its way from where a cut was chosen anew. What is decided by distances changes no faster
/// than the eye moves. source: temporal coherence of distances; Lipschitz bounds, exact by a margin
/// for rounding
struct Walk {
    const Table& table;
    View view;
    double frame = 1;   // size of a pixel at 1 m, when it was chosen anew
    double pixel = 1;   // size of a pixel of the view at 1 m
    double travel = 0;  // of the eye since then

    Walk(const Table& of, const View& from);
    /// False: so far that what is known is worth nothing.
    bool to(const View& next);

    Sight sight_of(const Affine& world, const Seen& seen) const;
    /// How far rounding may be off in distances of a node, and in sums of them and the travel.
    double margin(const Affine& world, const Seen& seen, double z) const;
    /// Whether two sizes of pixels are one but for rounding, as when a camera turns.
    static bool same_pixels(double a, double b);
};

/// What a step reads of every node: 12 bytes, each number rounded to the safe side.
class Slack {
public:
    size_t size() const { return expires_.size(); }
    void resize(size_t count);
    void grow(size_t most);
    /// From where to where a node's decision holds, and so for how long.
    void set(size_t index, const Walk& walk, const Placed& placed, const Seen& seen,
             const Sight& sight, const Decision& made);
    void copy(const Slack& from, size_t index, size_t to);
    /// Nodes [begin, end) move to `to`; what lies there is lost.
    void move(size_t begin, size_t end, size_t to);
    /// Nodes whose slack is eaten.
    void find_expired(double travel, std::vector<uint32_t>& expired) const;
    /// The first of the largest errors on screen. Errors grow no faster than the eye may have come
    /// nearer; only what may then be the largest is computed. `seen`: by Node::transform; `guess`: a
    /// node, or none.
    void find_largest(const Walk& walk, const std::vector<Seen>& seen, Cut& cut, uint32_t guess);

private:
    std::vector<float> expires_;  // travel from which on it may be drawn otherwise, or less
    std::vector<float> sizes_;    // error / size of a pixel at 1 m, or more; -1: opened
    std::vector<float> places_;   // distance + travel when it was looked at, or less
};

}  // namespace lodestone::quality
