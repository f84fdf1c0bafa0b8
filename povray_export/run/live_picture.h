// SPDX-License-Identifier: GPL-3.0-or-later
// LivePicture: a picture while POV-Ray draws it, for somebody who looks from another thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace lodestone::povray {

/// A rectangle of pixels; `left` and `top` count from the upper left corner of what is drawn.
struct PixelRectangle {
    int left = 0;
    int top = 0;
    int width = 0;
    int height = 0;
};

/// Linear light with associated alpha.
using LivePixel = std::array<float, 4>;

/// A picture, or the part of one that is drawn, while it is drawn: squares of a mosaic first, then
/// finished rectangles. Whatever lies outside is left out. What is drawn is handed out once, in as
/// few rectangles as the order of drawing allows. It may be used from any thread.
class LivePicture {
public:
    /// The side in pixels of the squares whose news are told apart.
    /// Law: POV-Ray's threads finish squares of 32 x 32 pixels.
    static constexpr int kTile = 32;

    /// `part`: what is drawn of the whole picture. Throws Error(InvalidArgument) for a part without
    /// pixels, or of more than 65,536 in a row or a column.
    explicit LivePicture(const PixelRectangle& part);
    LivePicture(const LivePicture&) = delete;
    LivePicture& operator=(const LivePicture&) = delete;

    const PixelRectangle& part() const { return part_; }

    /// Paints a square of a mosaic; `where` counts in the whole picture. Returns the number of
    /// pixels painted.
    uint64_t paint(const PixelRectangle& where, const LivePixel& color);
    /// Takes a finished rectangle; `where` counts in the whole picture, `pixels` has one for each
    /// of it, top row first.
    void finish(const PixelRectangle& where, std::span<const LivePixel> pixels);

    /// The number of finished pixels.
    uint64_t finished() const;
    /// The number of pixels.
    uint64_t pixels() const;

    /// Hands out a rectangle that was drawn since it was handed out last: its pixels, top row first
    /// (or the lowest one), go into `out`. Several tiles that touch come together, as many as there
    /// is room for. Nothing when there is nothing new. Throws Error(InvalidArgument) when `out` has
    /// no room for a tile.
    std::optional<PixelRectangle> take(bool bottom_up, std::span<LivePixel> out);

private:
    /// The pixels of a rectangle that lie in the part, counted in it; nothing when there are none.
    std::optional<PixelRectangle> clipped(const PixelRectangle& where) const;
    void mark(const PixelRectangle& where);
    bool is_new(int column, int row) const;
    LivePixel* row(int y);

    const PixelRectangle part_;
    int columns_ = 0;  // of tiles
    int rows_ = 0;
    mutable std::mutex mutex_;
    std::vector<LivePixel> pixels_;
    std::vector<uint8_t> new_tiles_;
    uint64_t finished_ = 0;
};

}  // namespace lodestone::povray
