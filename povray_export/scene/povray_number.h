// SPDX-License-Identifier: GPL-3.0-or-later
// Number: numbers as POV-Ray reads them, in any locale; never "inf" or "nan", which it cannot read.
#pragma once

#include "base/maths.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <string>

namespace lodestone::povray {

constexpr int kSignificantDigits = 10;

/// Appends the shortest form with at most `digits` significant digits. Throws Error(Internal) for a
/// value that is not finite.
void append_number(std::string& out, double value, int digits = kSignificantDigits);
void append_count(std::string& out, uint64_t value);
/// <x,y,z>
void append_vector(std::string& out, const glm::dvec3& value, int digits = kSignificantDigits);
/// matrix<...> of 12 numbers, as POV-Ray's transforms are written.
void append_matrix(std::string& out, const Affine& transform);

/// Decimal lattice on which coordinates are written: what is tested on the lattice (equal points,
/// zero areas) is exactly what POV-Ray reads.
class DecimalLattice {
public:
    /// The coarsest decimal step that rounds by less than `precision`, but never so fine that
    /// `largest` needs more than 15 digits (a float holds 8).
    DecimalLattice(double precision, double largest);

    /// Throws Error(Internal) for a value that is not finite.
    int64_t round(double value) const;
    /// Writes at most kMostCharacters, and returns the end.
    char* write(char* at, int64_t value) const;
    static constexpr size_t kMostCharacters = 32;

private:
    int decimals_;    // a step is 10^-decimals
    double steps_;    // per unit
    uint64_t whole_;  // steps of a unit, where they are a whole number; else 0
};

/// Writes at most 20 characters, and returns the end: for numbers by the million, where appending
/// each to a string would take longer.
char* write_count(char* at, uint64_t value);

}  // namespace lodestone::povray
