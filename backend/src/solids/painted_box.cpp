// SPDX-License-Identifier: GPL-3.0-or-later
#include "solids/painted_box.h"

#include "base/error.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

namespace lodestone::solids {
namespace {

// The errors of the vertices' colors that are allowed, as the root of the mean square over the mean
// color: for one color for all, and in addition for merged colors.
// Fitted: by tests/bench/sheets/sheet_replace.py and the street: 0.5 leaves the book pile too dark.
constexpr double kOneColor = 0.3;
// Fitted: by tests/bench/sheets/sheet_replace.py and the street: 0.2 paints white fences.
constexpr double kMerged = 0.25;

/// The vertices of one color: light by color, and the light that falls on them.
struct VertexShade {
    glm::dvec4 sum{0.0};
    double vertices = 1;

    glm::dvec3 color() const { return glm::dvec3(sum) / sum.w; }
};

VertexShade merged(const VertexShade& a, const VertexShade& b) {
    return {a.sum + b.sum, a.vertices + b.vertices};
}

/// The price of merging two: what it adds to the sum of squares over all vertices, which count
/// alike, because any side may be the only one seen beside others.
double price(const VertexShade& a, const VertexShade& b) {
    const glm::dvec3 color = merged(a, b).color();
    const glm::dvec3 from_a = a.color() - color;
    const glm::dvec3 from_b = b.color() - color;
    return a.vertices * glm::dot(from_a, from_a) + b.vertices * glm::dot(from_b, from_b);
}

/// Merges the nearest two again and again, as long as this adds at most `most` in all. `shade_of`:
/// the index of each vertex's shade.
void merge(std::vector<VertexShade>& shades, std::vector<size_t>& shade_of, double most) {
    while (shades.size() > 1) {
        double least = std::numeric_limits<double>::infinity();
        size_t first = 0;
        size_t second = 0;
        for (size_t b = 0; b < shades.size(); ++b) {
            for (size_t a = 0; a < b; ++a) {
                const double now = price(shades[a], shades[b]);
                if (now < least) {
                    least = now;
                    first = a;
                    second = b;
                }
            }
        }
        if (!(least <= most))
            return;
        most -= least;
        shades[first] = merged(shades[first], shades[second]);
        shades.erase(shades.begin() + static_cast<std::ptrdiff_t>(second));
        for (size_t& at : shade_of) {
            if (at == second)
                at = first;
            else if (at > second)
                --at;
        }
    }
}

}  // namespace

std::optional<PaintedBox> painted_box(const Primitive& box, const Material& material,
                                      std::span<const glm::dvec4> shown) {
    // The weight of the mean color at each vertex.
    // Taste: a larger one mutes colors; without it, vertices in the dark have colors by chance.
    constexpr double kUnsure = 0.01;
    PaintedBox out{tessellate_box(box), material};
    if (shown.size() != out.mesh.positions.size())
        fail(Status::Internal, "a box has ", out.mesh.positions.size(), " vertices, not ",
             shown.size());
    const auto vertices = static_cast<double>(shown.size());
    VertexShade all{glm::dvec4(0.0), vertices};
    for (const glm::dvec4& one : shown)
        all.sum += glm::dvec4(one.w * glm::dvec3(one), one.w);
    if (!(all.sum.w > 0))
        return std::nullopt;
    std::vector<VertexShade> shades;
    double off = 0;
    for (const glm::dvec4& one : shown) {
        shades.push_back(
            {glm::dvec4(one.w * glm::dvec3(one), one.w) + kUnsure / vertices * all.sum});
        const glm::dvec3 from_mean = shades.back().color() - all.color();
        off += glm::dot(from_mean, from_mean);
    }
    const double square = glm::dot(all.color(), all.color()) * vertices;
    if (!(off > kOneColor * kOneColor * square))
        return std::nullopt;
    std::vector<size_t> shade_of(shown.size());
    std::iota(shade_of.begin(), shade_of.end(), size_t{0});
    merge(shades, shade_of, kMerged * kMerged * square);
    glm::dvec3 most(0.0);
    for (const VertexShade& shade : shades)
        most = glm::max(most, shade.color());
    const glm::dvec3 base = glm::min(most, glm::dvec3(1.0));
    out.material.vertex_colors = true;
    out.material.base_color = base;
    for (const size_t at : shade_of) {
        glm::vec4 color(1.0f);
        for (int i = 0; i < 3; ++i) {
            if (base[i] > 0)
                color[i] = static_cast<float>(std::min(shades[at].color()[i] / base[i], 1.0));
        }
        out.mesh.colors.push_back(color);
    }
    return out;
}

}  // namespace lodestone::solids
