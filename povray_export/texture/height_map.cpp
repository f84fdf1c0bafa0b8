// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/texture/height_map.h"

#include "image/texture_sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <map>
#include <mutex>
#include <numbers>

namespace lodestone::povray {
namespace {

/// The texels along a side.
/// Taste: a larger value shows finer bumps, for memory and time that grow with its square.
constexpr int kMostSide = 1024;
/// Steeper slopes are cut.
/// Taste: such normals are mistakes of compression; a larger value lets them make spikes.
constexpr double kSteepest = 4;

using Complex = std::complex<double>;

/// The discrete Fourier transform in place; the size is a power of two, `sign` -1 or +1.
void transform(Complex* values, size_t count, size_t stride, double sign) {
    const auto at = [=](size_t i) -> Complex& { return values[i * stride]; };
    for (size_t i = 1, j = 0; i < count; ++i) {
        size_t bit = count / 2;
        for (; (j & bit) != 0; bit /= 2)
            j ^= bit;
        j ^= bit;
        if (i < j)
            std::swap(at(i), at(j));
    }
    for (size_t length = 2; length <= count; length *= 2) {
        const double angle = sign * 2 * std::numbers::pi / static_cast<double>(length);
        std::vector<Complex> turns(length / 2);
        for (size_t i = 0; i < turns.size(); ++i)
            turns[i] = std::polar(1.0, angle * static_cast<double>(i));
        for (size_t start = 0; start < count; start += length) {
            for (size_t i = 0; i < length / 2; ++i) {
                const Complex even = at(start + i);
                const Complex odd = at(start + i + length / 2) * turns[i];
                at(start + i) = even + odd;
                at(start + i + length / 2) = even - odd;
            }
        }
    }
}

void transform(std::vector<Complex>& values, size_t width, size_t height, double sign) {
    for (size_t y = 0; y < height; ++y)
        transform(values.data() + y * width, width, 1, sign);
    for (size_t x = 0; x < width; ++x)
        transform(values.data() + x, height, width, sign);
}

int side_of(int texels) {
    return static_cast<int>(
        std::min<unsigned>(std::bit_ceil(static_cast<unsigned>(std::max(texels, 2))), kMostSide));
}

HeightMap integrated(const Texture& normals) {
    const image::PackedPtr from = image::packed(*normals.picture);
    const image::TexelRows rows(*from, normals.picture->space);
    HeightMap map;
    map.width = side_of(from->width);
    map.height = side_of(from->height);
    const auto width = static_cast<size_t>(map.width);
    const auto height = static_cast<size_t>(map.height);
    // The slope along a row, and along a column (downward) as the imaginary part.
    std::vector<Complex> slopes(width * height);
    std::vector<int> counts(slopes.size(), 0);
    std::vector<float> row(4 * static_cast<size_t>(from->width));
    int row_y = -1;
    const auto add = [&](size_t to, int x) {
        const float* texel = row.data() + 4 * static_cast<size_t>(x);
        const glm::dvec3 n =
            2.0 * image::color_of(normals, glm::dvec4(texel[0], texel[1], texel[2], 1)) - 1.0;
        const double up = std::max(n.z, 1e-3);
        slopes[to] += Complex(std::clamp(-n.x / up, -kSteepest, kSteepest),
                              std::clamp(n.y / up, -kSteepest, kSteepest));
        ++counts[to];
    };
    for (int y = 0; y < std::max(from->height, map.height); ++y) {
        const int source_y = from->height >= map.height ? y : y * from->height / map.height;
        const int to_y = from->height >= map.height ? y * map.height / from->height : y;
        if (source_y != row_y)
            rows.read(row_y = source_y, row.data());
        for (int x = 0; x < std::max(from->width, map.width); ++x) {
            const int source_x = from->width >= map.width ? x : x * from->width / map.width;
            const int to_x = from->width >= map.width ? x * map.width / from->width : x;
            add(static_cast<size_t>(to_y) * width + static_cast<size_t>(to_x), source_x);
        }
    }
    for (size_t i = 0; i < slopes.size(); ++i)
        slopes[i] /= std::max(counts[i], 1);
    transform(slopes, width, height, -1);
    // Both slopes are real: their spectra are the even and odd parts of the sum's spectrum.
    std::vector<Complex> heights(slopes.size());
    for (size_t y = 0; y < height; ++y) {
        for (size_t x = 0; x < width; ++x) {
            const Complex here = slopes[y * width + x];
            const Complex there =
                std::conj(slopes[(height - y) % height * width + (width - x) % width]);
            const Complex along = 0.5 * (here + there);
            const Complex down = Complex(0, -0.5) * (here - there);
            const auto frequency = [](size_t i, size_t count) {
                const double signed_i = i <= count / 2
                                            ? static_cast<double>(i)
                                            : static_cast<double>(i) - static_cast<double>(count);
                return 2 * i == count
                           ? 0.0
                           : 2 * std::numbers::pi * signed_i / static_cast<double>(count);
            };
            const double u = frequency(x, width);
            const double v = frequency(y, height);
            if (u != 0 || v != 0)
                heights[y * width + x] = Complex(0, -1) * (u * along + v * down) / (u * u + v * v);
        }
    }
    transform(heights, width, height, 1);
    double low = 1e300;
    double high = -1e300;
    for (Complex& value : heights) {
        value /= static_cast<double>(heights.size());
        low = std::min(low, value.real());
        high = std::max(high, value.real());
    }
    map.range = high - low;
    map.values.resize(heights.size());
    for (size_t i = 0; i < heights.size(); ++i)
        map.values[i] =
            map.range > 0 ? static_cast<float>((heights[i].real() - low) / map.range) : 0.5F;
    return map;
}

}  // namespace

std::shared_ptr<const HeightMap> height_map(const Texture& normals) {
    static std::mutex mutex;
    static std::map<Hash, std::shared_ptr<const HeightMap>> known;
    // Height maps that are kept, of up to 4 MB each.
    // Taste: a larger value fits fewer maps again, for memory.
    constexpr size_t kKept = 32;
    Hasher hasher;
    hasher.value(normals.picture->hash).value(normals.channel);
    for (int i = 0; i < 3; ++i)
        hasher.value(normals.scale[i]).value(normals.offset[i]);
    const Hash hash = hasher.result();
    {
        const std::lock_guard lock(mutex);
        const auto found = known.find(hash);
        if (found != known.end())
            return found->second;
    }
    auto made = std::make_shared<const HeightMap>(integrated(normals));
    const std::lock_guard lock(mutex);
    if (known.size() >= kKept)
        known.clear();
    return known[hash] = std::move(made);
}

std::string png_of(const HeightMap& map) {
    // The gray levels between k and k + 1, and which of red, green and blue are k + 1.
    // Law: POV-Ray's gray is 0.297 R + 0.589 G + 0.114 B.
    static constexpr struct {
        double gray;
        int red, green, blue;
    } kSteps[] = {{0, 0, 0, 0},    {.114, 0, 0, 1}, {.297, 1, 0, 0}, {.411, 1, 0, 1},
                  {.589, 0, 1, 0}, {.703, 0, 1, 1}, {.886, 1, 1, 0}};
    image::Image image;
    image.width = map.width;
    image.height = map.height;
    for (const float value : map.values) {
        const double level = std::clamp(static_cast<double>(value), 0.0, 1.0) * 254.99;
        const double whole = std::floor(level);
        const auto* best = &kSteps[0];
        for (const auto& step : kSteps) {
            if (std::abs(level - whole - step.gray) < std::abs(level - whole - best->gray))
                best = &step;
        }
        for (const int more : {best->red, best->green, best->blue})
            image.pixels.push_back(static_cast<float>(std::min(whole + more, 255.0) / 255));
        image.pixels.push_back(1);
    }
    return image::png_bytes(image);
}

}  // namespace lodestone::povray
