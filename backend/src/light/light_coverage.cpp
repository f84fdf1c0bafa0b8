// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/light_coverage.h"

#include "base/parallel.h"
#include "base/random.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace lodestone::light {
namespace {

// The looks at a picture.
// Taste: more find smaller parts that have no point, more slowly.
constexpr double kMostLooks = 524288;
// The looks along a pixel of small pictures.
// Taste: more find thinner edges, more slowly.
constexpr double kFiner = 1;
// The looks that are added beside one that is alone.
// Fitted: by tests/bench/speed/bench_lights.py, pixels that are off in the corridor.
constexpr int kCloser = 4;
// The cosine between surfaces that face about the same way.
// Taste: a larger one makes more points alone.
constexpr double kSameWay = 0.25;

using Cells = std::vector<std::vector<uint32_t>>;  // the points of each cell of a grid

class CoverageSearch {
public:
    CoverageSearch(const LitScene& scene, const View& view, std::span<const uint8_t> divisible,
                   std::span<const uint8_t> wanted, LitGrid& grid)
        : scene_(scene), view_(view), divisible_(divisible), wanted_(wanted), grid_(grid) {
        const double pixels = static_cast<double>(view.width) * view.height;
        const double part = std::min(kFiner, std::sqrt(kMostLooks / pixels));
        rows_ = std::max(grid.rows, static_cast<size_t>(view.height * part));
        columns_ = std::max(grid.columns, static_cast<size_t>(view.width * part));
    }

    std::vector<PointSighting> run(const Job& job) {
        std::vector<std::vector<CoverageLook>> looks(rows_);
        parallel_for(rows_, [&](size_t row) {
            job.check();
            look(row, looks[row]);
        });
        std::vector<CoverageLook> alone;
        std::vector<PointSighting> sightings;
        for (std::vector<CoverageLook>& some : looks) {
            for (CoverageLook& one : some) {
                if (one.speaker == kNobody)
                    alone.push_back(std::move(one));
                else if (divisible_[one.point.region] != 0)
                    sightings.push_back({one.point.position, one.point.region, one.speaker});
            }
            some = {};
        }
        add(alone, sightings, job);
        return sightings;
    }

private:
    static constexpr uint32_t kNobody = ~uint32_t{0};

    struct CoverageLook {
        LitPoint point;
        size_t cell = 0;
        uint32_t speaker = kNobody;
    };

    /// Looks once in every part of a row; where a look is alone, some more times, at most twice as
    /// many in all.
    void look(size_t row, std::vector<CoverageLook>& out) const {
        PcgRandom random(2, row);
        size_t more = columns_;
        for (size_t column = 0; column < columns_; ++column) {
            const size_t before = out.size();
            look(row, column, random, out);
            const auto alone = [](const CoverageLook& one) { return one.speaker == kNobody; };
            if (std::none_of(out.begin() + static_cast<ptrdiff_t>(before), out.end(), alone))
                continue;
            for (int i = 0; i < kCloser && more > 0; ++i, --more)
                look(row, column, random, out);
        }
    }

    void look(size_t row, size_t column, PcgRandom& random, std::vector<CoverageLook>& out) const {
        const double x =
            (static_cast<double>(column) + random.uniform()) / static_cast<double>(columns_);
        const double y = (static_cast<double>(row) + random.uniform()) / static_cast<double>(rows_);
        const size_t cell = cell_at(x, y);
        if (wanted_[cell] == 0)
            return;
        for (LitPoint& point : scene_.seen(view_, x, y)) {
            CoverageLook one{std::move(point), cell, kNobody};
            one.speaker = speaker_of(one, [&](size_t there, const auto& speaks) {
                for (uint32_t i = grid_.first[there]; i < grid_.first[there + 1]; ++i) {
                    if (speaks(i))
                        return i;
                }
                return kNobody;
            });
            out.push_back(std::move(one));
        }
    }

    size_t cell_at(double x, double y) const {
        const auto column = static_cast<size_t>(x * static_cast<double>(grid_.columns));
        const auto row = static_cast<size_t>(y * static_cast<double>(grid_.rows));
        return std::min(row, grid_.rows - 1) * grid_.columns + std::min(column, grid_.columns - 1);
    }

    /// Finds a point of the look's cell, else of the cells around it, that is near it and sees it.
    /// `among(cell, speaks)` tries the points of one cell.
    template <typename Among>
    uint32_t speaker_of(const CoverageLook& one, const Among& among) const {
        const double most = reach_beside(view_, grid_, one.point);
        const auto speaks = [&](uint32_t index) {
            const LitPoint& a = grid_.points[index];
            const LitPoint& b = one.point;
            const double facing = glm::dot(a.aside, b.aside);
            return a.region == b.region && glm::length(a.position - b.position) <= most &&
                   facing > kSameWay * glm::length(a.aside) * glm::length(b.aside) &&
                   scene_.clear(a.position + a.aside, b.position + b.aside);
        };
        const uint32_t own = among(one.cell, speaks);
        if (own != kNobody)
            return own;
        for (const size_t there :
             around(grid_, one.cell / grid_.columns, one.cell % grid_.columns)) {
            const uint32_t found = there == one.cell ? kNobody : among(there, speaks);
            if (found != kNobody)
                return found;
        }
        return kNobody;
    }

    void find_beside(CoverageLook& one) const {
        const double most = reach_beside(view_, grid_, one.point);
        for (const size_t cell :
             around(grid_, one.cell / grid_.columns, one.cell % grid_.columns)) {
            for (uint32_t i = grid_.first[cell]; i < grid_.first[cell + 1]; ++i) {
                if (glm::length(grid_.points[i].position - one.point.position) <= most)
                    one.point.beside.push_back(i);
            }
        }
    }

    void add(std::vector<CoverageLook>& alone, std::vector<PointSighting>& sightings,
             const Job& job) {
        const size_t most = std::max<size_t>(1, grid_.points.size());
        const size_t step = (alone.size() + most - 1) / most;
        std::vector<std::vector<uint32_t>> added(grid_.first.size());
        for (size_t i = 0; i < alone.size(); i += step) {
            if ((i & 1023u) < step)
                job.check();
            CoverageLook& one = alone[i];
            const uint32_t region = one.point.region;
            const glm::dvec3 at = one.point.position;
            uint32_t speaker = speaker_of(one, [&](size_t there, const auto& speaks) {
                for (const uint32_t index : added[there]) {
                    if (speaks(index))
                        return index;
                }
                return kNobody;
            });
            if (speaker == kNobody) {
                speaker = static_cast<uint32_t>(grid_.points.size());
                added[one.cell].push_back(speaker);
                find_beside(one);
                grid_.points.push_back(std::move(one.point));
            }
            if (divisible_[region] != 0)
                sightings.push_back({at, region, speaker});
        }
    }

    const LitScene& scene_;
    const View& view_;
    std::span<const uint8_t> divisible_;
    std::span<const uint8_t> wanted_;  // by cell of the grid
    LitGrid& grid_;
    size_t rows_ = 0;
    size_t columns_ = 0;
};

}  // namespace

std::vector<PointSighting> add_missing_lit_points(const LitScene& scene, const View& view,
                                                  std::span<const uint8_t> divisible,
                                                  std::span<const uint8_t> wanted, LitGrid& grid,
                                                  const Job& job) {
    return CoverageSearch(scene, view, divisible, wanted, grid).run(job);
}

std::vector<Box3> spoken_boxes(std::span<const PointSighting> sightings, size_t count) {
    std::vector<Box3> out(count);
    for (const PointSighting& seen : sightings)
        out[seen.point].add(seen.position);
    return out;
}

void lend_lit_points(std::span<const PointSighting> sightings, const LightRegions& regions,
                     std::vector<LitPoint>& points, LightShares& shares) {
    // Pieces are in the order of the drawn things.
    std::vector<size_t> first;
    for (size_t i = 0; i < regions.pieces.size(); ++i) {
        if (regions.pieces[i].drawn == first.size())
            first.push_back(i);
    }
    first.push_back(regions.pieces.size());
    // The sighting that is nearest to the point, by region and point.
    std::map<std::pair<uint32_t, uint32_t>, glm::dvec3> lent;
    for (const PointSighting& seen : sightings) {
        for (size_t i = first[seen.drawn]; i < first[seen.drawn + 1]; ++i) {
            const LitPiece& piece = regions.pieces[i];
            if (!piece.within || !piece.within->contains(seen.position))
                continue;
            if (piece.group != points[seen.point].region) {
                const auto [at, fresh] = lent.try_emplace({piece.group, seen.point}, seen.position);
                const glm::dvec3& point = points[seen.point].position;
                if (!fresh && glm::length(seen.position - point) < glm::length(at->second - point))
                    at->second = seen.position;
            }
            break;
        }
    }
    for (const auto& [key, position] : lent) {
        const auto& [region, index] = key;
        points.push_back(points[index]);
        points.back().region = region;
        points.back().position = position;
        shares.push_back(shares[index]);
    }
}

}  // namespace lodestone::light
