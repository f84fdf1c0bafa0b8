// SPDX-License-Identifier: GPL-3.0-or-later
// glTF's frame is Y up, ours Z up: transforms between them.
#pragma once

#include "base/maths.h"

#include <array>

namespace lodestone::format {

/// Our axis i is glTF's axis kAxis[i], times kSign[i].
/// Law: glTF's Y points up and its Z to the front (glTF 2.0, coordinates); our Z points up, our Y
/// to the back.
inline constexpr std::array<int, 3> kAxis{0, 2, 1};
/// Law: as kAxis.
inline constexpr std::array<double, 3> kSign{1, -1, 1};

/// The same motion in the other frame; an exchange and signs, so exact. Its own inverse but for
/// the signs' direction: `to_ours` says which.
inline Affine converted(const Affine& from, bool to_ours) {
    Affine to;
    for (int row = 0; row < 3; ++row) {
        const int far_row = kAxis[static_cast<size_t>(row)];
        const double row_sign = kSign[static_cast<size_t>(to_ours ? row : far_row)];
        to.offset[row] = row_sign * from.offset[far_row];
        for (int column = 0; column < 3; ++column) {
            const int far_column = kAxis[static_cast<size_t>(column)];
            const double sign =
                row_sign * kSign[static_cast<size_t>(to_ours ? column : far_column)];
            to.linear[column][row] = sign * from.linear[far_column][far_row];
        }
    }
    return to;
}

}  // namespace lodestone::format
