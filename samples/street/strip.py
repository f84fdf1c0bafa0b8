# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture strip: full detail | approximated | which representation | difference times 8."""

from array import array

from core.picture import bitmap_letters

GAP = 4  # pixels between panels
BAR = 12  # height of the line of text under each panel


def _encode(linear: float) -> float:
    """Linear 0...1 -> sRGB."""
    if linear <= 0.0031308:
        return 12.92 * max(0.0, linear)
    return 1.055 * min(1.0, linear) ** (1 / 2.4) - 0.055


def _decode(encoded: float) -> float:
    return encoded / 12.92 if encoded <= 0.04045 else ((encoded + 0.055) / 1.055) ** 2.4


class Canvas:
    """A linear RGBA picture, top row first, to put others and letters on."""

    def __init__(self, width: int, height: int, color: tuple[float, float, float]) -> None:
        self.width, self.height = width, height
        self.pixels = array("f", (*color, 1.0)) * (width * height)

    def put(self, image, left: int, top: int, rows: range) -> None:
        for to, row in enumerate(rows):
            source = image.pixels[4 * row * image.width : 4 * (row + 1) * image.width]
            for alpha in range(3, len(source), 4):
                source[alpha] = 1.0
            at = 4 * ((top + to) * self.width + left)
            self.pixels[at : at + len(source)] = source

    def fill(self, left: int, top: int, width: int, height: int, color) -> None:
        row = array("f", (*color, 1.0)) * width
        for y in range(top, top + height):
            at = 4 * (y * self.width + left)
            self.pixels[at : at + len(row)] = row

    def write(self, text: str, left: int, top: int, color=(0.9, 0.9, 0.9)) -> None:
        for x, y in bitmap_letters.pixels(text):
            if 0 <= left + x < self.width and 0 <= top + y < self.height:
                at = 4 * ((top + y) * self.width + left + x)
                self.pixels[at : at + 3] = array("f", color)


def difference(a, b, times: float):
    """A copy of `a` that shows |a - b| of display values, enlarged."""
    out = array("f", a.pixels)
    for i in range(0, len(out), 4):
        for c in range(i, i + 3):
            far = abs(_encode(a.pixels[c]) - _encode(b.pixels[c])) * times
            out[c] = _decode(min(1.0, far))
    return type(a)(a.width, a.height, out)


def covered_rows(mask, margin: int) -> range:
    """The rows that hold covered pixels, so that empty sky and ground do not fill the strip."""
    rows = [
        y
        for y in range(mask.height)
        if max(mask.pixels[4 * y * mask.width + 3 : 4 * (y + 1) * mask.width : 4]) > 1 / 255
    ]
    if not rows:
        return range(mask.height)
    return range(max(0, rows[0] - margin), min(mask.height, rows[-1] + 1 + margin))


def make_strip(native, panels, legend, mask, columns: int):
    """`panels`: (image, caption); `legend`: (word, linear color), drawn in the third panel.
    Returns a native image."""
    rows = covered_rows(mask, 10)
    width, height = panels[0][0].width, len(rows) + BAR
    lines = (len(panels) + columns - 1) // columns
    canvas = Canvas(columns * (width + GAP) - GAP, lines * (height + GAP) - GAP, (0.02,) * 3)
    for number, (image, caption) in enumerate(panels):
        left = (number % columns) * (width + GAP)
        top = (number // columns) * (height + GAP)
        canvas.put(image, left, top, rows)
        canvas.write(caption, left + 4, top + len(rows) + 3)
        if number == 2:
            canvas.fill(left, top, width, 18, (0.02,) * 3)
            at = left + 6
            for word, color in legend:
                canvas.fill(at, top + 5, 8, 8, color)
                canvas.write(word, at + 11, top + 6, (1.0, 1.0, 1.0))
                at += 11 + bitmap_letters.width(word) + 8
    return native.Image(canvas.width, canvas.height, canvas.pixels)
