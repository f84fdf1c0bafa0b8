// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/image_reduction.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace lodestone::image {
namespace {

/// The first texel of `count` that the one at `index` of a smaller picture covers.
int begin_of(int index, int small, int count) {
    return static_cast<int>(static_cast<int64_t>(index) * count / small);
}

/// The sums of the texels of blocks that lie side by side, to which their rows are added.
class BlockSums {
public:
    BlockSums(int width, int columns) {
        for (int x = 0; x <= columns; ++x)
            begins_.push_back(static_cast<size_t>(begin_of(x, columns, width)));
        sums_.resize(static_cast<size_t>(columns));
        plain_.resize(sums_.size());
    }

    void add(const float* row) {
        ++rows_;
        size_t clear = 0;
        for (size_t x = 0; opaque_ && x < begins_.back(); ++x)
            clear += row[4 * x + 3] != 1.0f ? 1u : 0u;
        if (clear > 0) {  // up to here, plain sums are those by alpha
            std::copy(sums_.begin(), sums_.end(), plain_.begin());
            opaque_ = false;
        }
        for (size_t i = 0; i < sums_.size(); ++i)
            opaque_ ? add_opaque(row, i) : add_by_alpha(row, i);
    }

    glm::dvec4 mean(size_t column) const {
        const auto count = static_cast<double>(rows_ * (begins_[column + 1] - begins_[column]));
        const glm::dvec4& sum = sums_[column];
        return {sum.w > 0 ? glm::dvec3(sum) / sum.w : plain_[column] / count, sum.w / count};
    }

    /// Begins the next blocks.
    void clear() {
        rows_ = 0;
        opaque_ = true;
        std::fill(sums_.begin(), sums_.end(), glm::dvec4(0.0));
    }

private:
    void add_opaque(const float* row, size_t column) {
        glm::dvec4 sum = sums_[column];
        for (const float* at = row + 4 * begins_[column]; at < row + 4 * begins_[column + 1];
             at += 4)
            sum += glm::dvec4(at[0], at[1], at[2], at[3]);
        sums_[column] = sum;
    }
    void add_by_alpha(const float* row, size_t column) {
        glm::dvec4 sum = sums_[column];
        glm::dvec3 plain = plain_[column];
        for (const float* at = row + 4 * begins_[column]; at < row + 4 * begins_[column + 1];
             at += 4) {
            const glm::dvec3 color(at[0], at[1], at[2]);
            const auto alpha = static_cast<double>(at[3]);
            sum += glm::dvec4(alpha * color, alpha);
            plain += color;
        }
        sums_[column] = sum;
        plain_[column] = plain;
    }

    std::vector<size_t> begins_;     // the first texel of each block, and the end
    std::vector<glm::dvec4> sums_;   // of color times alpha, and alpha
    std::vector<glm::dvec3> plain_;  // of color, from the first row on that is not opaque
    size_t rows_ = 0;
    bool opaque_ = true;
};

/// `row_at` gives the texels of a row of a picture of that size.
template <typename Row>
Image reduced_rows(int from_width, int from_height, int width, int height, const Row& row_at) {
    Image to;
    to.width = std::clamp(width, 1, std::max(1, from_width));
    to.height = std::clamp(height, 1, std::max(1, from_height));
    to.pixels.reserve(4 * to.size());
    BlockSums sums(from_width, to.width);
    int row = 0;
    for (int y = 0; y < to.height; ++y) {
        for (const int end = begin_of(y + 1, to.height, from_height); row < end; ++row)
            sums.add(row_at(row));
        for (size_t x = 0; x < static_cast<size_t>(to.width); ++x) {
            const glm::dvec4 mean = sums.mean(x);
            for (int c = 0; c < 4; ++c)
                to.pixels.push_back(static_cast<float>(mean[c]));
        }
        sums.clear();
    }
    return to;
}

}  // namespace

Image reduced(const Image& from, int width, int height) {
    Image to;
    if (!from.pixels.empty())
        to = reduced_rows(from.width, from.height, width, height, [&](int y) {
            return from.pixels.data() +
                   4 * static_cast<size_t>(y) * static_cast<size_t>(from.width);
        });
    to.linear = from.linear;
    return to;
}

Image reduced(const TexelRows& from, int width, int height) {
    std::vector<float> row(4 * static_cast<size_t>(from.width()));
    Image to = reduced_rows(from.width(), from.height(), width, height, [&](int y) {
        from.read(y, row.data());
        return row.data();
    });
    to.linear = true;
    return to;
}

glm::dvec4 mean_of(const TexelRows& rows) {
    BlockSums sums(rows.width(), 1);
    std::vector<float> row(4 * static_cast<size_t>(rows.width()));
    for (int y = 0; y < rows.height(); ++y) {
        rows.read(y, row.data());
        sums.add(row.data());
    }
    return sums.mean(0);
}

void spread_into_clear(Image& image) {
    // The alpha from which on a texel's own color is known.
    // Taste: what is fainter is often rounded, or the background's; a larger value blurs edges.
    constexpr float kKnown = 0.1f;
    bool clear = false;
    for (size_t i = 3; i < image.pixels.size(); i += 4) {
        if (image.pixels[i] >= kKnown)
            continue;
        image.pixels[i] = 0;
        clear = true;
    }
    if (!clear || image.size() <= 1)
        return;
    Image small = reduced(image, (image.width + 1) / 2, (image.height + 1) / 2);
    for (size_t i = 3; i < small.pixels.size(); i += 4)
        small.pixels[i] = small.pixels[i] > 0 ? 1.0f : 0.0f;
    spread_into_clear(small);
    float* at = image.pixels.data();
    for (int y = 0; y < image.height; ++y) {
        const auto row = static_cast<size_t>(static_cast<int64_t>(y) * small.height / image.height);
        for (int x = 0; x < image.width; ++x, at += 4) {
            if (at[3] > 0)
                continue;
            const auto column =
                static_cast<size_t>(static_cast<int64_t>(x) * small.width / image.width);
            const size_t around = 4 * (row * static_cast<size_t>(small.width) + column);
            std::copy_n(small.pixels.begin() + static_cast<ptrdiff_t>(around), 3, at);
        }
    }
}

}  // namespace lodestone::image
