// SPDX-License-Identifier: GPL-3.0-or-later
// Level fitter: the longer fit of mode best, never worse than the level it begins with.
#pragma once

#include "simplify/fit/better_fit.h"
#include "simplify/simplify.h"

namespace lodestone::simplify {

/// Makes the levels of one original better. Keeps references to it and to the options.
class LevelFitter {
public:
    /// `opened`: the mesh that `source` was opened as. `puts_back`: a few triangles may be
    /// collapsed and put back where the level is farthest off.
    LevelFitter(const Mesh& source, const CollapseMesh& opened, const SimplifyOptions& options,
                bool puts_back)
        : source_(source), options_(options), puts_back_(puts_back), meter_(source, opened) {}

    /// The level, fitted longer where that is better: no measured error (mean, root mean square,
    /// largest distance, outline) is larger than that of `level`. `level` must be compact, and
    /// `adjacency` its own; `around` becomes that of the result.
    CollapseMesh fit(const CollapseMesh& level, const Adjacency& adjacency, Adjacency& around,
                     const Job& job) const;

private:
    const Mesh& source_;
    const SimplifyOptions& options_;
    bool puts_back_;
    LevelMeter meter_;
};

}  // namespace lodestone::simplify
