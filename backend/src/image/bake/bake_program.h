// SPDX-License-Identifier: GPL-3.0-or-later
// BakeProgram: the steps of a bake, checked, and run for one texel after the other.
#pragma once

#include "image/bake/baked_image.h"

namespace lodestone::image {

/// Throws Error(InvalidArgument) when a step uses a later one, or a texture or table that is not
/// there, or the picture is empty or larger than kMostBakeSide.
void check_bake(const std::vector<BakeStep>& steps, size_t texture_count, int width, int height);

/// The result of a checked step that is no Texel, from those of the steps before it, which `done`
/// begins with.
glm::dvec4 result_of(const BakeStep& step, const std::vector<glm::dvec4>& done);

/// The number, or 0 for one that is not finite.
double finite_or_zero(double value);

}  // namespace lodestone::image
