// SPDX-License-Identifier: GPL-3.0-or-later
// Counted errors: by how much more an error shows on what lies in thin layers.
#pragma once

#include "model/object.h"

namespace lodestone::hierarchy {

/// An error as it counts for something of that size (radius, metres): more for environment, and
/// never 0, which the finest alone has.
double counted_error(double error, bool environment, double size);

/// Whether a surface of such variances, across and through it, is 20 times thinner than wide.
bool is_flat(double across, double through);
bool is_flat(const Attributes& attributes);

}  // namespace lodestone::hierarchy
