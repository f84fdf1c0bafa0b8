// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/triangle_cutter.h"

#include "base/hash.h"
#include "povray_export/mesh/plane_ranges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace lodestone::povray {
namespace {

/// The part of a picture beside it that still counts as within.
/// Taste: texture coordinates are rounded by less; a larger value shows the wrong border.
constexpr double kEdge = 1e-4;
/// A weight nearer to 0 is 0, so that no sliver is cut off.
/// Taste: a thousandth of a texel of a picture of a thousand; a larger value moves corners.
constexpr double kThin = 1e-6;
/// The share of a triangle that may be missing of a whole one.
/// Taste: slivers between repetitions; a larger value fills holes.
constexpr double kWhole = 1e-4;
/// Repetitions of a picture in a triangle from which on all of it counts as seen.
/// Taste: a larger value looks at each of more repetitions.
constexpr double kManyTiles = 16;

bool repeats(const Texture& texture) {
    return texture.extension == TextureExtension::Repeat ||
           texture.extension == TextureExtension::Mirror;
}

/// The first and the last repetition of a picture along an axis that a range meets.
std::pair<int64_t, int64_t> tiles(double low, double high) {
    const auto first = static_cast<int64_t>(std::floor(low + kThin));
    const auto last = static_cast<int64_t>(std::ceil(high - kThin)) - 1;
    return {first, std::max(first, last)};
}

/// Whether a repetition is turned around.
bool mirrored(const Texture& texture, int64_t tile) {
    return texture.extension == TextureExtension::Mirror && (tile & 1) != 0;
}

/// Flags the blocks of one repetition that a triangle meets; `at` is relative to it.
void note_tile(image::SeenTexels& seen, const glm::dvec2 (&at)[3]) {
    const PlaneBox box = box_of(at);
    const auto index = [](double place, int count) {
        return std::clamp(static_cast<int>(std::floor(place * count)), 0, count - 1);
    };
    // Rows are counted from the top.
    for (int row = index(1 - box.high.y, seen.rows); row <= index(1 - box.low.y, seen.rows);
         ++row) {
        const double top = 1 - static_cast<double>(row) / seen.rows;
        const double bottom = 1 - static_cast<double>(row + 1) / seen.rows;
        const PlaneRange range = range_between(at, bottom, top);
        if (!(range.low <= range.high) || range.high < 0 || range.low > 1)
            continue;
        uint8_t* flags =
            seen.blocks.data() + static_cast<size_t>(row) * static_cast<size_t>(seen.columns);
        std::fill(flags + index(range.low, seen.columns),
                  flags + index(range.high, seen.columns) + 1, uint8_t{1});
    }
}

/// A corner of a polygon that is cut, and the edge of the outline's triangle that it is on.
struct CutCorner {
    glm::dvec3 weights;
    uint64_t key;
};

}  // namespace

bool note_seen(image::SeenTexels& seen, const Texture& texture, const glm::dvec2 (&at)[3]) {
    const PlaneBox box = box_of(at);
    if (!repeats(texture)) {
        const bool within = box.low.x >= -kEdge && box.low.y >= -kEdge && box.high.x <= 1 + kEdge &&
                            box.high.y <= 1 + kEdge;
        if (!within && (texture.extension != TextureExtension::Clip || texture.offset.x != 0))
            return false;
        if (box.high.x > 0 && box.low.x < 1 && box.high.y > 0 && box.low.y < 1)
            note_tile(seen, at);
        return true;
    }
    if ((box.high.x - box.low.x) * (box.high.y - box.low.y) > kManyTiles) {
        std::fill(seen.blocks.begin(), seen.blocks.end(), uint8_t{1});
        return true;
    }
    const auto [left, right] = tiles(box.low.x, box.high.x);
    const auto [bottom, top] = tiles(box.low.y, box.high.y);
    if ((right - left + 1) * (top - bottom + 1) > static_cast<int64_t>(4 * kManyTiles)) {
        std::fill(seen.blocks.begin(), seen.blocks.end(), uint8_t{1});
        return true;
    }
    for (int64_t row = bottom; row <= top; ++row) {
        for (int64_t column = left; column <= right; ++column) {
            glm::dvec2 here[3];
            for (int k = 0; k < 3; ++k) {
                here[k] = at[k] - glm::dvec2(column, row);
                if (mirrored(texture, column))
                    here[k].x = 1 - here[k].x;
                if (mirrored(texture, row))
                    here[k].y = 1 - here[k].y;
            }
            note_tile(seen, here);
        }
    }
    return true;
}

TriangleCutter::TriangleCutter(const MaskOutline& outline, const Texture& texture, const Job& job)
    : inside_(outline.inside),
      texture_(texture),
      job_(job),
      visited_(outline.inside.triangles.size(), 0) {
    // The squares along a side.
    // Taste: about two triangles a square; more take longer to make than they save.
    constexpr double kMostSquares = 64;
    side_ = static_cast<int>(
        std::clamp(std::sqrt(static_cast<double>(visited_.size()) / 2), 1.0, kMostSquares));
    squares_.resize(static_cast<size_t>(side_) * static_cast<size_t>(side_));
    const auto index = [&](double place) {
        return std::clamp(static_cast<int>(std::floor(place * side_)), 0, side_ - 1);
    };
    for (uint32_t i = 0; i < visited_.size(); ++i) {
        const glm::uvec3& t = inside_.triangles[i];
        const glm::dvec2 at[3] = {inside_.points[t.x], inside_.points[t.y], inside_.points[t.z]};
        const PlaneBox box = box_of(at);
        for (int row = index(box.low.y); row <= index(box.high.y); ++row) {
            for (int column = index(box.low.x); column <= index(box.high.x); ++column)
                squares_[square(column, row)].push_back(i);
        }
    }
}

const CutTriangle& TriangleCutter::cut(const glm::dvec2 (&at)[3], size_t most) {
    out_.outcome = CutOutcome::Pieces;
    out_.corners.clear();
    out_.triangles.clear();
    pieces_ = 0;
    const glm::dvec2 a = at[1] - at[0];
    const glm::dvec2 b = at[2] - at[0];
    const double twice = a.x * b.y - a.y * b.x;
    const double longest = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(b - a, b - a)});
    // Law: a line, to the rounding of texture coordinates in single precision.
    constexpr double kLine = 1e-7;
    if (!(std::abs(twice) > kLine * longest) || !(std::abs(twice) > 1e-300)) {
        if (longest > kThin * kThin)
            cut_line(at, most);
        else if (inside(at[0]))
            out_.outcome = CutOutcome::Whole;
        return out_;
    }
    // weights = (gradients . place) + constant
    const glm::dvec2 across1(b.y / twice, -b.x / twice);
    const glm::dvec2 across2(-a.y / twice, a.x / twice);
    to_weights_[1] = {across1.x, across1.y, -glm::dot(across1, at[0])};
    to_weights_[2] = {across2.x, across2.y, -glm::dot(across2, at[0])};
    to_weights_[0] = glm::dvec3(0, 0, 1) - to_weights_[1] - to_weights_[2];
    area_ = 0;
    const bool few = each_piece(at, most, [&](uint32_t piece, const PictureTile& tile) {
        cut_piece(piece, tile);
        return out_.triangles.size() <= most;
    });
    if (!few)
        out_.outcome = CutOutcome::TooMany;
    else if (area_ >= 1 - kWhole)
        out_.outcome = CutOutcome::Whole;
    return out_;
}

const CutTriangle& TriangleCutter::join_pieces() {
    if (out_.outcome != CutOutcome::Pieces || out_.triangles.size() < 2)
        return out_;
    double area = 0;  // as a share
    glm::dvec3 center(0.0);
    for (const glm::uvec3& piece : out_.triangles) {
        const glm::dvec3& a = out_.corners[piece.x];
        const glm::dvec3& b = out_.corners[piece.y];
        const glm::dvec3& c = out_.corners[piece.z];
        const double own = std::abs(glm::determinant(glm::dmat3(a, b, c)));
        area += own;
        center += own / 3 * (a + b + c);
    }
    if (!(area > 0))
        return out_;
    // The one is as the triangle, but smaller: each of its corners has its own weight and a third of
    // what is left to go around.
    const double size = std::min(1.0, std::sqrt(area));
    glm::dvec3 rest = glm::max(center / area - size / 3, 0.0);
    const double sum = rest.x + rest.y + rest.z;
    rest = sum > 0 ? rest * ((1 - size) / sum) : glm::dvec3((1 - size) / 3);
    out_.corners.clear();
    for (int k = 0; k < 3; ++k) {
        out_.corners.push_back(rest);
        out_.corners.back()[k] += size;
    }
    out_.triangles = {{0, 1, 2}};
    return out_;
}

TriangleCutter::PictureTile TriangleCutter::tile_of(int64_t column, int64_t row) const {
    PictureTile tile{glm::dvec2(column, row), glm::dvec2(1.0)};
    if (mirrored(texture_, column)) {
        tile.origin.x += 1;
        tile.sign.x = -1;
    }
    if (mirrored(texture_, row)) {
        tile.origin.y += 1;
        tile.sign.y = -1;
    }
    return tile;
}

/// Visits what of the outline may meet a triangle, in every repetition that it meets. False: these
/// are too many, or a visit was false.
template <typename Visit>
bool TriangleCutter::each_piece(const glm::dvec2 (&at)[3], size_t most, const Visit& visit) {
    // The pieces of the outline that are looked at for each triangle that may be left.
    // Taste: a larger value cuts nets of which little is seen, for time.
    constexpr size_t kPiecesEach = 16;
    const size_t most_pieces = kPiecesEach * (most + inside_.triangles.size());
    size_t tiles_left = most + 1;
    const PlaneBox box = box_of(at);
    const bool once = !repeats(texture_);
    const auto [bottom, top] = once ? std::pair<int64_t, int64_t>() : tiles(box.low.y, box.high.y);
    for (int64_t row = bottom; row <= top; ++row) {
        int64_t left = 0;
        int64_t right = 0;
        if (!once) {
            const PlaneRange range =
                range_between(at, static_cast<double>(row), static_cast<double>(row + 1));
            if (!(range.low <= range.high))
                continue;
            std::tie(left, right) = tiles(range.low, range.high);
        }
        for (int64_t column = left; column <= right; ++column) {
            job_.check();
            if (tiles_left-- == 0)
                return false;
            ++visit_;
            known_count_ = 0;
            bool go_on = true;
            const PictureTile tile = tile_of(column, row);
            each_piece_of(tile, at, [&](uint32_t piece) {
                go_on = go_on && ++pieces_ <= most_pieces && visit(piece, tile);
            });
            if (!go_on)
                return false;
        }
    }
    return true;
}

template <typename Visit>
void TriangleCutter::each_piece_of(const PictureTile& tile, const glm::dvec2 (&at)[3],
                                   const Visit& visit) {
    glm::dvec2 here[3];
    for (int k = 0; k < 3; ++k)
        here[k] = (at[k] - tile.origin) / tile.sign;
    const PlaneBox box = box_of(here);
    const auto index = [&](double place) {
        return static_cast<int>(std::clamp(std::floor(place * side_), 0.0, side_ - 1.0));
    };
    for (int y = index(box.low.y - kThin); y <= index(box.high.y + kThin); ++y) {
        const PlaneRange range = range_between(here, static_cast<double>(y) / side_ - kThin,
                                               static_cast<double>(y + 1) / side_ + kThin);
        if (!(range.low <= range.high))
            continue;
        for (int x = index(range.low - kThin); x <= index(range.high + kThin); ++x) {
            for (const uint32_t piece : squares_[square(x, y)]) {
                if (std::exchange(visited_[piece], visit_) != visit_)
                    visit(piece);
            }
        }
    }
}

/// Cuts a triangle that shows a line of the picture into strips across it.
void TriangleCutter::cut_line(const glm::dvec2 (&at)[3], size_t most) {
    int from = 0;
    for (int k = 1; k < 3; ++k) {
        const auto length = [&](int i) { return glm::length(at[(i + 1) % 3] - at[i]); };
        if (length(k) > length(from))
            from = k;
    }
    const glm::dvec2 begin = at[from];
    const glm::dvec2 end = at[(from + 1) % 3];
    std::vector<PlaneRange> ranges;
    const bool few = each_piece(at, most, [&](uint32_t piece, const PictureTile& tile) {
        glm::dvec2 corners[3];
        for (int k = 0; k < 3; ++k)
            corners[k] = inside_.points[inside_.triangles[piece][k]];
        const PlaneRange range = range_inside((begin - tile.origin) / tile.sign,
                                              (end - tile.origin) / tile.sign, corners);
        if (range.low <= range.high)
            ranges.push_back(range);
        return ranges.size() <= most;
    });
    std::sort(ranges.begin(), ranges.end(), [](const PlaneRange& a, const PlaneRange& b) {
        return std::tie(a.low, a.high) < std::tie(b.low, b.high);
    });
    size_t count = 0;  // of ranges that are apart
    for (const PlaneRange& range : ranges) {
        if (count > 0 && range.low <= ranges[count - 1].high + kThin)
            ranges[count - 1].high = std::max(ranges[count - 1].high, range.high);
        else
            ranges[count++] = range;
    }
    if (count == 1 && ranges[0].high - ranges[0].low >= 1 - kWhole) {
        out_.outcome = CutOutcome::Whole;
        return;
    }
    const glm::dvec2 along = (end - begin) / glm::dot(end - begin, end - begin);
    glm::dvec3 places(0.0);
    for (int k = 0; k < 3; ++k)
        places[k] = std::clamp(glm::dot(at[k] - begin, along), 0.0, 1.0);
    for (size_t i = 0; i < count; ++i)
        add_strip(places, ranges[i].low, ranges[i].high);
    if (!few || out_.triangles.size() > most)
        out_.outcome = CutOutcome::TooMany;
}

/// Adds what of the triangle lies between two places along its line, at which its corners are
/// `along`.
void TriangleCutter::add_strip(const glm::dvec3& along, double low, double high) {
    std::vector<glm::dvec3> polygon{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const double sign : {1.0, -1.0}) {
        const double border = sign > 0 ? low : high;
        std::vector<glm::dvec3> next;
        for (size_t i = 0; i < polygon.size(); ++i) {
            const glm::dvec3& a = polygon[i];
            const glm::dvec3& b = polygon[(i + 1) % polygon.size()];
            const double wa = sign * (glm::dot(a, along) - border);
            const double wb = sign * (glm::dot(b, along) - border);
            if (wa >= 0)
                next.push_back(a);
            if ((wa > 0 && wb < 0) || (wa < 0 && wb > 0))
                next.push_back(a + wa / (wa - wb) * (b - a));
        }
        polygon = std::move(next);
    }
    const auto first = static_cast<uint32_t>(out_.corners.size());
    out_.corners.insert(out_.corners.end(), polygon.begin(), polygon.end());
    for (uint32_t i = 2; i < polygon.size(); ++i)
        out_.triangles.emplace_back(first, first + i - 1, first + i);
}

bool TriangleCutter::inside(const glm::dvec2& at) const {
    glm::dvec2 place = at;
    for (int i = 0; i < 2; ++i) {
        if (!repeats(texture_)) {
            if (texture_.extension == TextureExtension::Clip && (at[i] < 0 || at[i] > 1))
                return false;
            place[i] = std::clamp(at[i], 0.0, 1.0);
            continue;
        }
        const double tile = std::floor(at[i]);
        place[i] = at[i] - tile;
        if (mirrored(texture_, static_cast<int64_t>(tile)))
            place[i] = 1 - place[i];
    }
    const auto index = [&](double along) {
        return std::clamp(static_cast<int>(std::floor(along * side_)), 0, side_ - 1);
    };
    const auto turn = [](const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    const std::vector<uint32_t>& near = squares_[square(index(place.x), index(place.y))];
    return std::any_of(near.begin(), near.end(), [&](uint32_t i) {
        const glm::uvec3& t = inside_.triangles[i];
        const glm::dvec2& a = inside_.points[t.x];
        const glm::dvec2& b = inside_.points[t.y];
        const glm::dvec2& c = inside_.points[t.z];
        return turn(a, b, place) >= 0 && turn(b, c, place) >= 0 && turn(c, a, place) >= 0;
    });
}

uint32_t TriangleCutter::corner(uint64_t key, const glm::dvec3& weights) {
    if (2 * known_count_ >= known_.size()) {
        std::vector<KnownCorner> larger(2 * known_.size());
        for (const KnownCorner& old : known_) {
            size_t at = old.key & (larger.size() - 1);
            while (old.visit == visit_ && larger[at].visit == visit_)
                at = (at + 1) & (larger.size() - 1);
            if (old.visit == visit_)
                larger[at] = old;
        }
        known_ = std::move(larger);
    }
    size_t at = key & (known_.size() - 1);
    while (known_[at].visit == visit_ && known_[at].key != key)
        at = (at + 1) & (known_.size() - 1);
    if (known_[at].visit != visit_) {
        known_[at] = {key, visit_, static_cast<uint32_t>(out_.corners.size())};
        out_.corners.push_back(weights);
        ++known_count_;
    }
    return known_[at].number;
}

/// Cuts one triangle of the outline by the three sides of the triangle (Sutherland and Hodgman
/// 1974), in its weights: a side is where one of them is 0.
void TriangleCutter::cut_piece(uint32_t piece, const PictureTile& tile) {
    // Law: three corners, and one more for each side that cuts.
    constexpr size_t kMostPolygon = 9;
    std::array<CutCorner, kMostPolygon> polygon;
    std::array<CutCorner, kMostPolygon> next;
    size_t count = 3;
    for (int k = 0; k < 3; ++k) {
        const uint32_t point = inside_.triangles[piece][k];
        const glm::dvec2 at = tile.origin + tile.sign * inside_.points[point];
        glm::dvec3 weights;
        for (int i = 0; i < 3; ++i) {
            weights[i] = to_weights_[i].x * at.x + to_weights_[i].y * at.y + to_weights_[i].z;
            if (std::abs(weights[i]) < kThin)
                weights[i] = 0;
        }
        polygon[static_cast<size_t>(k)] = {weights, Hasher().value(point).result()};
    }
    for (int side = 0; side < 3; ++side) {  // most are far from most triangles
        if (polygon[0].weights[side] <= 0 && polygon[1].weights[side] <= 0 &&
            polygon[2].weights[side] <= 0)
            return;
    }
    for (int side = 0; side < 3; ++side) {
        size_t left = 0;
        for (size_t i = 0; i < count; ++i) {
            const CutCorner& a = polygon[i];
            const CutCorner& b = polygon[(i + 1) % count];
            const double wa = a.weights[side];
            const double wb = b.weights[side];
            if (wa >= 0)
                next[left++] = a;
            if ((wa > 0 && wb < 0) || (wa < 0 && wb > 0)) {
                // Neighbors find the same corner, to the bit: the edge has one direction.
                const CutCorner& from = a.key < b.key ? a : b;
                const CutCorner& to = a.key < b.key ? b : a;
                const double part = from.weights[side] / (from.weights[side] - to.weights[side]);
                glm::dvec3 weights = from.weights + part * (to.weights - from.weights);
                weights[side] = 0;
                next[left++] = {weights,
                                Hasher().value(from.key).value(to.key).value(side).result()};
            }
        }
        std::swap(polygon, next);
        count = left;
        if (count < 3)
            return;
    }
    double twice = 0;
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec3& a = polygon[i].weights;
        const glm::dvec3& b = polygon[(i + 1) % count].weights;
        twice += a.y * b.z - a.z * b.y;
    }
    if (!(std::abs(twice) > kThin * kThin))
        return;
    area_ += std::abs(twice);
    if (twice < 0)
        std::reverse(polygon.begin(), polygon.begin() + static_cast<ptrdiff_t>(count));
    std::array<uint32_t, kMostPolygon> numbers;
    for (size_t i = 0; i < count; ++i)
        numbers[i] = corner(polygon[i].key, polygon[i].weights);
    for (size_t i = 2; i < count; ++i) {
        if (numbers[0] != numbers[i - 1] && numbers[i - 1] != numbers[i] &&
            numbers[i] != numbers[0])
            out_.triangles.emplace_back(numbers[0], numbers[i - 1], numbers[i]);
    }
}

}  // namespace lodestone::povray
