// SPDX-License-Identifier: GPL-3.0-or-later
// POV-Ray number: numbers as POV-Ray reads them, in any locale; never "inf" or "nan".
#pragma once

#include "base/maths.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <string>

namespace lodestone::povray {

/// The usual digits of a number.
/// Taste: a larger value writes longer files; POV-Ray's doubles hold 15, its meshes' floats 8.
constexpr int kSignificantDigits = 10;

/// Appends the shortest form with at most `digits` significant digits. Throws Error(Internal) for a
/// value that is not finite.
void append_number(std::string& out, double value, int digits = kSignificantDigits);
void append_count(std::string& out, uint64_t value);
/// Appends <x,y,z>.
void append_vector(std::string& out, const glm::dvec3& value, int digits = kSignificantDigits);
/// Appends matrix<...> of 12 numbers, as POV-Ray's transforms are written.
void append_matrix(std::string& out, const Affine& transform);

/// A decimal lattice on which coordinates are written: properties tested on the lattice (equal
/// points, zero areas) are exactly those that POV-Ray reads.
class DecimalLattice {
public:
    /// Takes the coarsest decimal step that rounds by less than `precision`, but never one so fine
    /// that `largest` needs more than 15 digits (a float holds 8).
    DecimalLattice(double precision, double largest);

    /// The nearest step. Throws Error(Internal) for a value that is not finite.
    int64_t round(double value) const;
    /// Writes at most kMostCharacters, and returns the end.
    char* write(char* at, int64_t value) const;
    /// The most characters of a number.
    /// Law: a sign, a point, 15 digits, and the zeros before them in the smallest meshes.
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
