// SPDX-License-Identifier: GPL-3.0-or-later
// Shown triangles: the part of a mesh that one picture needs.
#pragma once

#include "base/hash.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lodestone::povray {

/// The triangles that are written; those left out change nothing in the picture.
struct ShownTriangles {
    std::vector<uint8_t> shown;  // by triangle of the representation's mesh, 1: it is written
    Hash hash = 0;
};
using ShownTrianglesPtr = std::shared_ptr<const ShownTriangles>;

/// The part of a mesh that several uses need together.
class NeededTriangles {
public:
    /// Adds a use: a byte for each triangle, 0 where it does not need it. Empty: it needs all.
    void add(std::span<const uint8_t> needed);
    void add(const NeededTriangles& other);

    /// The triangles to be written; null: all, or so many that other pictures may use the file, too.
    ShownTrianglesPtr shown() const;

private:
    bool all_ = false;
    std::vector<uint8_t> needed_;
};

}  // namespace lodestone::povray
