// SPDX-License-Identifier: GPL-3.0-or-later
// Cost model: the costs of drawing in the renderer that levels are built for, handed down as data.
#pragma once

#include <cstdint>

namespace lodestone {

/// The costs of a renderer; all zero: drawing is free. Its numbers lie beside its exporter.
struct CostModel {
    /// The memory, in bytes, of a triangle of a mesh, with or without normals; of a primitive; of
    /// an occurrence, whatever it draws. Meshes are shared between occurrences, the solids of a
    /// composite are copied for each.
    uint64_t triangle_bytes = 0;
    uint64_t primitive_bytes = 0;
    uint64_t occurrence_bytes = 0;
    /// The bytes that are read in the time that a sample takes to cross a clear surface, over an
    /// opaque one.
    double crossing_bytes = 0;
    /// The CPU seconds that a picture saves for each triangle it need not read, and for each
    /// occurrence it need not place.
    double triangle_s = 0;
    double occurrence_s = 0;
    /// The CPU seconds of a pixel with a few lights, and of a picture of nothing.
    double pixel_s = 0;
    double start_s = 0;
};

}  // namespace lodestone
