// SPDX-License-Identifier: GPL-3.0-or-later
// Sample errors: what the distances of single samples say of a whole surface.
#pragma once

#include "measure/deviation/surface_deviation.h"

#include <vector>

namespace lodestone::measure {

double weight_of(const std::vector<SurfaceSample>& samples, const std::vector<size_t>& indices);

/// The smallest distance of the samples in `order` that no more than `most` of the weight is above.
double quantile(const std::vector<SurfaceSample>& samples, const std::vector<double>& distances,
                std::vector<size_t> order, double most);

/// `places`: how far every sample is from the other surface, exactly where that is above `enough`;
/// `moves`: how far its look was moved. A quantile of places that is not above `enough` counts as
/// that.
SurfaceDeviation deviation_of(const std::vector<SurfaceSample>& samples,
                              const std::vector<double>& places, const std::vector<double>& moves,
                              double enough);

/// Whether the quantile of all samples is above that.
bool is_above(const std::vector<SurfaceSample>& samples, const std::vector<double>& places,
              double least);

/// Whether the error of all samples is larger than `useless` without any doubt, by some of them.
bool surely_above(double useless, const std::vector<SurfaceSample>& samples,
                  const std::vector<size_t>& some, const std::vector<double>& places,
                  const std::vector<double>& moves);

/// Every so many samples are asked whatever they show. Divides a block.
inline constexpr size_t kLookSampleStep = 8;

/// One of two samples, for a rough answer, by no regular step: the corners of boxes are listed
/// bottom, top, bottom, top.
inline bool is_rough_sample(size_t i) {
    return static_cast<uint32_t>(i) * 0x9E3779B9u >= 0x80000000u;
}

/// 1 for the samples that are asked for looks: at least `wanted` of each look, evenly, or all.
std::vector<uint8_t> look_samples(const std::vector<SurfaceSample>& samples, size_t wanted);

/// Gives samples that were not asked what the one of their look before them has.
void spread_moves(const std::vector<SurfaceSample>& samples, const std::vector<uint8_t>& asked,
                  std::vector<double>& moves);

}  // namespace lodestone::measure
