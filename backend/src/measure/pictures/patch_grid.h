// SPDX-License-Identifier: GPL-3.0-or-later
// PatchGrid: points of a surface gathered into patches, and how far two surfaces differ in the mean
// of these.
#pragma once

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace lodestone::measure {

/// A patch is what lies in one cube of space and belongs to one of six sides: those that it is seen
/// from, or faces. Its number is that of the smallest patch; its first bits name the larger ones.
class PatchGrid {
public:
    /// The smallest patches are the bound's width halved so many times.
    /// Taste: a larger value tells finer differences, of which single rays know little.
    static constexpr int kHalvings = 10;

    /// How far patches of one size differ.
    struct PatchDifference {
        double off = 0;    // root of the mean square of the differences of patches' means
        double known = 0;  // share of the samples that are not alone in their patch
        double noise = 0;  // standard deviation of off^2, for samples are few
    };

    /// `place`: 0...1 along each axis of the bound. `side`: a unit direction.
    static uint64_t patch_of(const glm::dvec3& side, const glm::dvec3& place) {
        return on_side(side, cube_of(place));
    }
    /// The smallest cube that a place is in.
    static uint64_t cube_of(const glm::dvec3& place) {
        // Law: the cells along an axis after so many halvings.
        constexpr int kCells = 1 << kHalvings;
        const glm::ivec3 cell(
            glm::clamp(place * double{kCells}, glm::dvec3(0.0), glm::dvec3(kCells - 1)));
        uint64_t cube = 0;
        for (int bit = kHalvings; bit-- > 0;) {
            for (int axis = 0; axis < 3; ++axis)
                cube = cube << 1u | (static_cast<uint32_t>(cell[axis]) >> bit & 1u);
        }
        return cube;
    }
    /// The patch of a cube on one of six sides: that of the longest axis of a direction.
    static uint64_t on_side(const glm::dvec3& side, uint64_t cube) {
        int most = 0;
        for (int axis = 1; axis < 3; ++axis)
            most = std::abs(side[axis]) > std::abs(side[most]) ? axis : most;
        const uint64_t number = 2 * static_cast<uint64_t>(most) + (side[most] < 0 ? 1 : 0);
        return number << (3 * kHalvings) | cube;
    }

    /// The differences `off` of samples in `patches` (sorted), in the mean over patches of the
    /// bound's width halved `halvings` times. Single samples differ anyway: the noise that comes
    /// from their small number is left out (products of two samples' differences have nothing of
    /// it). What covers a patch in part counts in part: `full` samples cover it, if that is not 0.
    /// With `normals`, one for each sample, what points along a patch's mean normal is left out.
    static PatchDifference difference(std::span<const uint64_t> patches,
                                      std::span<const glm::dvec3> off, int halvings,
                                      double full = 0, std::span<const glm::dvec3> normals = {}) {
        const int shift = 3 * (kHalvings - halvings);
        double squares = 0;
        double count = 0;
        double variance = 0;
        for (size_t begin = 0, end = 0; begin < patches.size(); begin = end) {
            glm::dvec3 along(0.0);
            for (end = begin;
                 end < patches.size() && patches[end] >> shift == patches[begin] >> shift; ++end) {
                if (!normals.empty())
                    along += normals[end];
            }
            const auto samples = static_cast<double>(end - begin);
            if (samples < 2)
                continue;
            along /= std::max(glm::length(along), 1e-9);
            glm::dvec3 sum(0.0);
            double alone = 0;
            for (size_t i = begin; i < end; ++i) {
                const glm::dvec3 one = off[i] - glm::dot(off[i], along) * along;
                sum += one;
                alone += glm::dot(one, one);
            }
            const double covered = full > samples ? samples / full : 1;
            const double part = covered * covered;
            squares += part * (glm::dot(sum, sum) - alone) / (samples - 1);
            // Products of vectors in a plane have half the square of theirs.
            variance += part * part * alone * alone / (samples * (samples - 1));
            count += samples;
        }
        if (!(count > 0))
            return {};
        return {std::sqrt(std::max(0.0, squares / count)),
                count / static_cast<double>(patches.size()), std::sqrt(variance) / count};
    }
};

}  // namespace lodestone::measure
