// SPDX-License-Identifier: GPL-3.0-or-later
// Cell numbers: which cell of a fine grid each vertex lies in, along a space-filling curve.
#pragma once

#include "approximate/cells.h"

#include <span>

namespace lodestone::approximate {

/// A vertex and what the triangles around it add up to: a line of the processor's cache.
struct alignas(64) CellVertex {
    Four point;     // in the frame; not written to again, as the next triangle waits for it
    Four planes_a;  // xx xy xz yy
    Four planes_b;  // yz zz 0 0
    Four open;      // from the first neighbor to the last: nothing where the fan closes

    /// Of its planes: twice the area around it.
    float weight() const { return planes_a[0] + planes_a[3] + planes_b[1]; }
    bool is_open() const { return dot_three(open, open) > 1e-4f * weight(); }
};

/// Sets `cell`, `split` and `step`; see divide(). Points are in the frame.
void number_cells(Cells& cells, std::span<const CellVertex> vertices, size_t least);

}  // namespace lodestone::approximate
