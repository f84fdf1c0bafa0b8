// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/run/live_picture.h"

#include "base/error.h"

#include <algorithm>

namespace lodestone::povray {
namespace {

/// The most pixels of a row or a column.
/// Law: larger pictures are neither Blender's nor PNG writers'.
constexpr int kMostSide = 65536;

int tiles(int pixels) {
    return (pixels + LivePicture::kTile - 1) / LivePicture::kTile;
}

const PixelRectangle& checked_part(const PixelRectangle& part) {
    if (part.width < 1 || part.height < 1 || part.width > kMostSide || part.height > kMostSide)
        fail(Status::InvalidArgument, "a live picture of ", part.width, " x ", part.height,
             " pixels");
    return part;
}

}  // namespace

LivePicture::LivePicture(const PixelRectangle& part)
    : part_(checked_part(part)),
      columns_(tiles(part.width)),
      rows_(tiles(part.height)),
      pixels_(static_cast<size_t>(part.width) * static_cast<size_t>(part.height)),
      new_tiles_(static_cast<size_t>(columns_) * static_cast<size_t>(rows_)) {}

std::optional<PixelRectangle> LivePicture::clipped(const PixelRectangle& where) const {
    // The corners of what was read from a file may be any number.
    const auto within = [](int64_t value, int most) {
        return static_cast<int>(std::clamp<int64_t>(value, 0, most));
    };
    const int64_t x = int64_t{where.left} - part_.left;
    const int64_t y = int64_t{where.top} - part_.top;
    PixelRectangle out;
    out.left = within(x, part_.width);
    out.top = within(y, part_.height);
    out.width = within(x + std::max(where.width, 0), part_.width) - out.left;
    out.height = within(y + std::max(where.height, 0), part_.height) - out.top;
    if (out.width < 1 || out.height < 1)
        return std::nullopt;
    return out;
}

void LivePicture::mark(const PixelRectangle& where) {
    const int right = tiles(where.left + where.width);
    const int bottom = tiles(where.top + where.height);
    for (int y = where.top / kTile; y < bottom; ++y) {
        const auto begin = new_tiles_.begin() + static_cast<std::ptrdiff_t>(y) * columns_;
        std::fill(begin + where.left / kTile, begin + right, uint8_t{1});
    }
}

bool LivePicture::is_new(int column, int row) const {
    return new_tiles_[static_cast<size_t>(row) * static_cast<size_t>(columns_) +
                      static_cast<size_t>(column)] != 0;
}

LivePixel* LivePicture::row(int y) {
    return pixels_.data() + static_cast<size_t>(y) * static_cast<size_t>(part_.width);
}

uint64_t LivePicture::paint(const PixelRectangle& where, const LivePixel& color) {
    const std::lock_guard lock(mutex_);
    const auto inside = clipped(where);
    if (!inside)
        return 0;
    for (int y = 0; y < inside->height; ++y)
        std::fill_n(row(inside->top + y) + inside->left, inside->width, color);
    mark(*inside);
    return static_cast<uint64_t>(inside->width) * static_cast<uint64_t>(inside->height);
}

void LivePicture::finish(const PixelRectangle& where, std::span<const LivePixel> pixels) {
    if (where.width < 1 || where.height < 1 ||
        pixels.size() != static_cast<size_t>(where.width) * static_cast<size_t>(where.height))
        fail(Status::InvalidArgument, pixels.size(), " pixels for ", where.width, " x ",
             where.height);
    const std::lock_guard lock(mutex_);
    const auto inside = clipped(where);
    if (!inside)
        return;
    const int64_t skipped_columns = int64_t{inside->left} + part_.left - where.left;
    const int64_t skipped_rows = int64_t{inside->top} + part_.top - where.top;
    for (int y = 0; y < inside->height; ++y) {
        const LivePixel* from = pixels.data() + (skipped_rows + y) * where.width + skipped_columns;
        std::copy_n(from, inside->width, row(inside->top + y) + inside->left);
    }
    mark(*inside);
    const uint64_t more =
        static_cast<uint64_t>(inside->width) * static_cast<uint64_t>(inside->height);
    finished_ = std::min<uint64_t>(finished_ + more, pixels_.size());
}

uint64_t LivePicture::finished() const {
    const std::lock_guard lock(mutex_);
    return finished_;
}

uint64_t LivePicture::pixels() const {
    return pixels_.size();
}

std::optional<PixelRectangle> LivePicture::take(bool bottom_up, std::span<LivePixel> out) {
    const std::lock_guard lock(mutex_);
    const auto first = std::find(new_tiles_.begin(), new_tiles_.end(), uint8_t{1});
    if (first == new_tiles_.end())
        return std::nullopt;
    const int at = static_cast<int>(first - new_tiles_.begin());
    const int column = at % columns_;
    const int top = at / columns_;
    PixelRectangle taken{column * kTile, top * kTile, 0, 0};
    // The rectangle of so many tiles, as far as the picture goes.
    const auto sized = [&](int wide, int high) {
        taken.width = std::min(wide * kTile, part_.width - taken.left);
        taken.height = std::min(high * kTile, part_.height - taken.top);
        return static_cast<size_t>(taken.width) * static_cast<size_t>(taken.height) <= out.size();
    };
    if (!sized(1, 1))
        fail(Status::InvalidArgument, "room for ", out.size(),
             " pixels, which is less than a tile");
    int wide = 1;
    while (column + wide < columns_ && is_new(column + wide, top) && sized(wide + 1, 1))
        ++wide;
    const auto whole_row_is_new = [&](int y) {
        for (int x = column; x < column + wide; ++x) {
            if (!is_new(x, y))
                return false;
        }
        return true;
    };
    int high = 1;
    while (top + high < rows_ && whole_row_is_new(top + high) && sized(wide, high + 1))
        ++high;
    sized(wide, high);
    for (int y = top; y < top + high; ++y) {
        const auto begin = new_tiles_.begin() + static_cast<std::ptrdiff_t>(y) * columns_;
        std::fill_n(begin + column, wide, uint8_t{0});
    }
    for (int y = 0; y < taken.height; ++y) {
        const int to = bottom_up ? taken.height - 1 - y : y;
        std::copy_n(row(taken.top + y) + taken.left, taken.width,
                    out.data() + static_cast<ptrdiff_t>(to) * taken.width);
    }
    return taken;
}

}  // namespace lodestone::povray
