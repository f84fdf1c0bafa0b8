// SPDX-License-Identifier: GPL-3.0-or-later
// Sample errors: the error of a whole surface, taken from the distances of its single samples.
#pragma once

#include "measure/deviation/surface_deviation.h"

#include <vector>

namespace lodestone::measure {

/// The weight of the samples with these indices together.
double weight_of(const std::vector<SurfaceSample>& samples, const std::vector<size_t>& indices);

/// The smallest distance of the samples in `order` such that no more than `most` of the weight is
/// above it.
double quantile(const std::vector<SurfaceSample>& samples, const std::vector<double>& distances,
                std::vector<size_t> order, double most);

/// The deviation of all samples. `places` holds the distance of every sample from the other
/// surface, exact where it is above `enough`; `moves` holds how far the look of every sample was
/// moved. A quantile of places that is not above `enough` counts as `enough`.
SurfaceDeviation deviation_of(const std::vector<SurfaceSample>& samples,
                              const std::vector<double>& places, const std::vector<double>& moves,
                              double enough);

/// Whether the quantile of the places of all samples is above `least`.
bool is_above(const std::vector<SurfaceSample>& samples, const std::vector<double>& places,
              double least);

/// Whether the error of all samples is larger than `useless` without any doubt, told by `some` of
/// them.
bool surely_above(double useless, const std::vector<SurfaceSample>& samples,
                  const std::vector<size_t>& some, const std::vector<double>& places,
                  const std::vector<double>& moves);

/// One sample of so many is asked for its look, whatever it shows; the number divides a block.
/// Taste: a larger value is faster and knows the quantile of looks less well.
inline constexpr size_t kLookSampleStep = 8;

/// Whether sample `i` belongs to the half that gives a rough answer. The half is chosen by no
/// regular step, for the corners of boxes are listed bottom, top, bottom, top.
inline bool is_rough_sample(size_t i) {
    return static_cast<uint32_t>(i) * 0x9E3779B9u >= 0x80000000u;
}

/// The samples that are asked for looks, marked by 1: at least `wanted` of each look, evenly, or
/// all.
std::vector<uint8_t> look_samples(const std::vector<SurfaceSample>& samples, size_t wanted);

/// Gives every sample that was not asked the move of the last asked sample of its look.
void spread_moves(const std::vector<SurfaceSample>& samples, const std::vector<uint8_t>& asked,
                  std::vector<double>& moves);

}  // namespace lodestone::measure
