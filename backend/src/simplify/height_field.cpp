// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/height_field.h"

#include <algorithm>
#include <cmath>

namespace lodestone::simplify {
namespace {

// The distance from the grid that a vertex may have, in parts of the spacing.
// Taste: a larger one takes bent meshes for grids.
constexpr double kTolerance = 1e-3;

/// Evenly spaced values, the same for all vertices of a line.
struct GridAxis {
    double first = 0;
    double step = 0;
    size_t count = 0;

    /// The line that a value is on; `count` when it is on none.
    size_t line(double value) const {
        const double at = (value - first) / step;
        const double whole = std::round(at);
        if (!(whole >= 0 && whole < static_cast<double>(count) &&
              std::abs(at - whole) <= kTolerance))
            return count;
        return static_cast<size_t>(whole);
    }
};

/// The lines along one axis if the first ones are evenly spaced; line() tells whether all are.
std::optional<GridAxis> lines_of(const Mesh& mesh, int axis) {
    float low = mesh.positions[0][axis];
    float high = low;
    for (const glm::vec3& p : mesh.positions) {
        if (!std::isfinite(p[axis]))
            return {};
        low = std::min(low, p[axis]);
        high = std::max(high, p[axis]);
    }
    const double size = double{high} - double{low};
    // The second line is the nearest that is not the first; rounding of floats is smaller than
    // this.
    const double round = 1e-6 * std::max(std::abs(double{low}), std::abs(double{high}));
    double next = size;
    for (const glm::vec3& p : mesh.positions) {
        const double away = double{p[axis]} - double{low};
        if (away > round + 1e-6 * size)
            next = std::min(next, away);
    }
    if (!(next > 0))
        return {};
    const double steps = std::round(size / next);
    if (!(steps >= 1 && steps < static_cast<double>(mesh.positions.size())))
        return {};
    return GridAxis{double{low}, size / steps, static_cast<size_t>(steps) + 1};
}

/// Whether every cell is two triangles that face the same way; sets grid.turned.
bool cells_are_cut(const Mesh& mesh, HeightGrid& grid, const std::vector<uint32_t>& place) {
    // The corners that were left out, a bit each.
    std::vector<uint8_t> corners((grid.columns - 1) * (grid.rows - 1), 0);
    size_t turned = 0;
    for (const Triangle& t : mesh.triangles) {
        size_t columns[3];
        size_t rows[3];
        for (int i = 0; i < 3; ++i) {
            columns[i] = place[t[i]] % grid.columns;
            rows[i] = place[t[i]] / grid.columns;
        }
        const size_t column = std::min({columns[0], columns[1], columns[2]});
        const size_t row = std::min({rows[0], rows[1], rows[2]});
        unsigned used = 0;
        for (int i = 0; i < 3; ++i) {
            if (columns[i] > column + 1 || rows[i] > row + 1)
                return false;
            used |= 1u << (columns[i] - column + 2 * (rows[i] - row));
        }
        const unsigned left_out = 15u & ~used;
        if (left_out == 0 || (left_out & (left_out - 1)) != 0)
            return false;  // a corner occurs twice
        if (column + 1 >= grid.columns || row + 1 >= grid.rows)
            return false;
        uint8_t& cell = corners[row * (grid.columns - 1) + column];
        if ((cell & left_out) != 0)
            return false;
        cell = static_cast<uint8_t>(cell | left_out);
        const auto signed_area = [&](int b, int c) {
            const auto difference = [](size_t x, size_t y) {
                return static_cast<int>(x) - static_cast<int>(y);
            };
            return difference(columns[b], columns[0]) * difference(rows[c], rows[0]) -
                   difference(columns[c], columns[0]) * difference(rows[b], rows[0]);
        };
        turned += signed_area(1, 2) < 0 ? 1 : 0;
    }
    grid.turned = turned > 0;
    if (turned != 0 && turned != mesh.triangles.size())
        return false;
    // The two triangles of a cell leave out opposite corners.
    return std::all_of(corners.begin(), corners.end(),
                       [](uint8_t cell) { return cell == 0b1001 || cell == 0b0110; });
}

std::optional<HeightGrid> grid_in(const Mesh& mesh, int across, int along) {
    const std::optional<GridAxis> x = lines_of(mesh, across);
    const std::optional<GridAxis> y = lines_of(mesh, along);
    if (!x || !y || x->count * y->count != mesh.positions.size() ||
        2 * (x->count - 1) * (y->count - 1) != mesh.triangles.size())
        return {};
    HeightGrid grid{across, along, x->count, y->count, false, {}};
    constexpr uint32_t kFree = ~uint32_t{0};
    grid.vertex.assign(mesh.positions.size(), kFree);
    std::vector<uint32_t> place(mesh.positions.size());
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        const size_t column = x->line(mesh.positions[v][across]);
        const size_t row = y->line(mesh.positions[v][along]);
        if (column >= x->count || row >= y->count)
            return {};
        uint32_t& vertex = grid.vertex[row * x->count + column];
        if (vertex != kFree)
            return {};
        vertex = static_cast<uint32_t>(v);
        place[v] = static_cast<uint32_t>(row * x->count + column);
    }
    if (!cells_are_cut(mesh, grid, place))
        return {};
    return grid;
}

/// Resamples `from` evenly spaced values, `stride` apart, to `count`: the piecewise linear curve
/// with the least squared distance that begins and ends where the finer one does.
class LineResampler {
public:
    LineResampler(size_t from, size_t count) : from_(from), count_(count) {
        // The share of each fine value in the integrals of f with the coarse tents: those of the
        // fine tents with the coarse ones, by Simpson's rule on each piece, which is exact.
        const double ratio =
            static_cast<double>(count - 1) / static_cast<double>(std::max<size_t>(from - 1, 1));
        for (size_t i = 0; i + 1 < from; ++i) {
            // A coarse sample may lie within a fine piece, which is cut there.
            const double begin = static_cast<double>(i) * ratio;
            const double end = static_cast<double>(i + 1) * ratio;
            double at = begin;
            while (at < end - 1e-12) {
                const double stop = std::min(end, std::floor(at + 1e-9) + 1);
                add_piece(i, begin, end, at, stop);
                at = stop;
            }
        }
    }

    void run(const double* values, double* out, std::vector<double>& scratch) const {
        std::vector<double>& right = scratch;
        right.assign(2 * count_, 0.0);
        for (const ResampleTerm& term : terms_)
            right[term.sample] += term.weight * values[term.from];
        out[0] = values[0];
        out[count_ - 1] = values[from_ - 1];
        if (count_ < 3)
            return;
        // The overlap of a tent is 2/3 with itself and 1/6 with each neighbor: Thomas's algorithm.
        double* const upper = right.data() + count_;
        right[1] -= out[0] / 6;
        right[count_ - 2] -= out[count_ - 1] / 6;
        double pivot = 2.0 / 3;
        for (size_t i = 1; i + 1 < count_; ++i) {
            if (i > 1) {
                upper[i] = (1.0 / 6) / pivot;
                pivot = 2.0 / 3 - upper[i] / 6;
                right[i] -= right[i - 1] / 6;
            }
            right[i] /= pivot;
        }
        out[count_ - 2] = right[count_ - 2];
        for (size_t i = count_ - 2; i-- > 1;)
            out[i] = right[i] - upper[i + 1] * out[i + 1];
    }

private:
    struct ResampleTerm {
        uint32_t from;
        uint32_t sample;
        double weight;
    };

    /// Adds the part from `at` to `stop` (in coarse steps) of the fine piece from value i to i + 1.
    void add_piece(size_t i, double begin, double end, double at, double stop) {
        const double middle = 0.5 * (at + stop);
        const auto left = static_cast<size_t>(
            std::min(std::max(std::floor(middle), 0.0), static_cast<double>(count_) - 2));
        double weights[2][2] = {};  // [fine end][coarse end]
        const double places[3] = {at, middle, stop};
        const double simpson[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
        for (int k = 0; k < 3; ++k) {
            const double fine = (places[k] - begin) / (end - begin);
            const double coarse = places[k] - static_cast<double>(left);
            const double weight = simpson[k] * (stop - at);
            weights[0][0] += weight * (1 - fine) * (1 - coarse);
            weights[0][1] += weight * (1 - fine) * coarse;
            weights[1][0] += weight * fine * (1 - coarse);
            weights[1][1] += weight * fine * coarse;
        }
        for (size_t fine = 0; fine < 2; ++fine) {
            for (size_t coarse = 0; coarse < 2; ++coarse)
                terms_.push_back({static_cast<uint32_t>(i + fine),
                                  static_cast<uint32_t>(left + coarse), weights[fine][coarse]});
        }
    }

    size_t from_;
    size_t count_;
    std::vector<ResampleTerm> terms_;
};

/// One number for each vertex, resampled along rows, then along columns.
std::vector<double> resampled(const HeightGrid& grid, size_t columns, size_t rows,
                              const std::vector<double>& values) {
    const LineResampler across(grid.columns, columns);
    const LineResampler along(grid.rows, rows);
    std::vector<double> scratch;
    std::vector<double> half(columns * grid.rows);
    for (size_t row = 0; row < grid.rows; ++row)
        across.run(&values[row * grid.columns], &half[row * columns], scratch);
    std::vector<double> out(columns * rows);
    std::vector<double> line(grid.rows);
    std::vector<double> made(rows);
    for (size_t column = 0; column < columns; ++column) {
        for (size_t row = 0; row < grid.rows; ++row)
            line[row] = half[row * columns + column];
        along.run(line.data(), made.data(), scratch);
        for (size_t row = 0; row < rows; ++row)
            out[row * columns + column] = made[row];
    }
    return out;
}

/// Adds smooth normals of the new surface, weighted by area.
void add_normals(Mesh& mesh) {
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0));
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::dvec3 area = area_vector(mesh, i);
        for (int k = 0; k < 3; ++k)
            sums[mesh.triangles[i][k]] += area;
    }
    for (const glm::dvec3& sum : sums) {
        const double length = glm::length(sum);
        mesh.normals.emplace_back(length > 0 ? sum / length : glm::dvec3(0, 0, 1));
    }
}

}  // namespace

std::optional<HeightGrid> find_grid(const Mesh& mesh) {
    check(mesh);
    // A grid has w h vertices and 2 (w - 1) (h - 1) triangles, and few other meshes do: these two
    // numbers mostly spare a visit of the vertices.
    const auto vertices = static_cast<double>(mesh.positions.size());
    const double sum = vertices + 1 - 0.5 * static_cast<double>(mesh.triangles.size());
    const double difference = std::sqrt(std::max(0.0, sum * sum - 4 * vertices));
    const double columns = std::round(0.5 * (sum + difference));
    if (mesh.triangles.size() < 2 || !(columns >= 2 && sum - columns >= 2) ||
        columns * (sum - columns) != vertices)
        return {};
    if (std::any_of(mesh.slots.begin(), mesh.slots.end(),
                    [&](uint16_t slot) { return slot != mesh.slots[0]; }))
        return {};
    for (int height = 2; height >= 0; --height) {
        if (auto grid = grid_in(mesh, (height + 1) % 3, (height + 2) % 3))
            return grid;
    }
    return {};
}

Mesh subsample(const Mesh& mesh, const HeightGrid& grid, size_t triangles, const Job& job) {
    const size_t wide = grid.columns - 1;
    const size_t high = grid.rows - 1;
    if (triangles >= 2 * wide * high)
        return mesh;
    const double cells = std::max(1.0, std::floor(0.5 * static_cast<double>(triangles)));
    const double scale = std::sqrt(cells / (static_cast<double>(wide) * static_cast<double>(high)));
    const auto part = [](double number, size_t most) {
        return static_cast<size_t>(std::clamp(number, 1.0, static_cast<double>(most)));
    };
    // The shorter side is rounded down, the longer one takes the rest.
    const bool flat = wide >= high;
    const size_t less = part(scale * static_cast<double>(flat ? high : wide), flat ? high : wide);
    const size_t more = part(cells / static_cast<double>(less), flat ? wide : high);
    const size_t columns = (flat ? more : less) + 1;
    const size_t rows = (flat ? less : more) + 1;

    const auto taken = [&](const auto& value) {
        job.check();
        std::vector<double> values(grid.vertex.size());
        for (size_t i = 0; i < values.size(); ++i)
            values[i] = value(grid.vertex[i]);
        return resampled(grid, columns, rows, values);
    };
    Mesh out;
    out.positions.resize(columns * rows);
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<double> made =
            taken([&](uint32_t v) { return double{mesh.positions[v][axis]}; });
        for (size_t i = 0; i < made.size(); ++i)
            out.positions[i][axis] = static_cast<float>(made[i]);
    }
    if (!mesh.uvs.empty()) {
        out.uvs.resize(columns * rows);
        for (int k = 0; k < 2; ++k) {
            const std::vector<double> made =
                taken([&](uint32_t v) { return double{mesh.uvs[v][k]}; });
            for (size_t i = 0; i < made.size(); ++i)
                out.uvs[i][k] = static_cast<float>(made[i]);
        }
    }
    if (!mesh.colors.empty()) {
        out.colors.resize(columns * rows);
        for (int k = 0; k < 4; ++k) {
            const std::vector<double> made =
                taken([&](uint32_t v) { return double{mesh.colors[v][k]}; });
            for (size_t i = 0; i < made.size(); ++i)
                out.colors[i][k] = static_cast<float>(std::max(0.0, made[i]));
        }
    }
    out.triangles.reserve(2 * (columns - 1) * (rows - 1));
    for (size_t row = 0; row + 1 < rows; ++row) {
        for (size_t column = 0; column + 1 < columns; ++column) {
            const auto at = static_cast<uint32_t>(row * columns + column);
            const auto above = static_cast<uint32_t>(at + columns);
            // The diagonal with the smaller difference in height bends the surface less.
            const int height = 3 - grid.across - grid.along;
            const auto z = [&](uint32_t v) { return out.positions[v][height]; };
            const bool rising = std::abs(z(at) - z(above + 1)) <= std::abs(z(at + 1) - z(above));
            Triangle pair[2] = {{at, at + 1, rising ? above + 1 : above},
                                {rising ? at : at + 1, above + 1, above}};
            for (Triangle& t : pair) {
                if (grid.turned)
                    std::swap(t.y, t.z);
                out.triangles.push_back(t);
            }
        }
    }
    if (!mesh.slots.empty())
        out.slots.assign(out.triangles.size(), mesh.slots[0]);
    if (!mesh.normals.empty())
        add_normals(out);
    return out;
}

}  // namespace lodestone::simplify
