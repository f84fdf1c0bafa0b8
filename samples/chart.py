# SPDX-License-Identifier: GPL-3.0-or-later
"""Line charts side by side, as SVG: each has its own ordinate, all share names and abscissae."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

COLORS = ("#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22")
PANEL = (220, 180)
GAP, LEFT, TOP = 62, 46, 28  # between panels, left of the first, above them
NAME_HEIGHT = 16


@dataclass(frozen=True)
class Chart:
    title: str
    low: float  # of the ordinate
    high: float
    marks: Sequence[float]  # lines across
    lines: dict[str, Sequence[float]]  # by name, one value for each abscissa

    def height_of(self, value: float) -> float:
        """From the upper edge; what is beyond an end is drawn at it."""
        share = (value - self.low) / (self.high - self.low)
        return PANEL[1] * (1 - min(1.0, max(0.0, share)))


def svg(charts: Sequence[Chart], abscissae: Sequence[str], label: str) -> str:
    """The abscissae are as far from each other as they are given; `label` stands below them."""
    names = list(dict.fromkeys(name for chart in charts for name in chart.lines))
    colors = {name: COLORS[number % len(COLORS)] for number, name in enumerate(names)}
    columns = 4
    width = LEFT + len(charts) * (PANEL[0] + GAP) - GAP + 14
    below = TOP + PANEL[1] + 40
    height = below + NAME_HEIGHT * -(-len(names) // columns) + 8
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="11">',
        f'<rect width="{width}" height="{height}" fill="#fff"/>',
    ]
    for number, chart in enumerate(charts):
        left = LEFT + number * (PANEL[0] + GAP)
        parts += _panel(chart, left, abscissae, label, colors)
    for number, name in enumerate(names):
        left = LEFT + number % columns * (width - LEFT) // columns
        top = below + NAME_HEIGHT * (number // columns)
        parts.append(
            f'<path d="M{left} {top}h18" stroke="{colors[name]}" stroke-width="2"/>'
            f'<text x="{left + 24}" y="{top + 4}">{escape(name)}</text>'
        )
    return "\n".join((*parts, "</svg>", ""))


def _panel(
    chart: Chart, left: int, abscissae: Sequence[str], label: str, colors: dict[str, str]
) -> list[str]:
    wide, high = PANEL
    step = wide / max(1, len(abscissae) - 1)
    parts = [
        f'<text x="{left}" y="{TOP - 10}" font-weight="bold">{escape(chart.title)}</text>',
        f'<rect x="{left}" y="{TOP}" width="{wide}" height="{high}" fill="none" stroke="#999"/>',
        f'<text x="{left + wide / 2:g}" y="{TOP + high + 28}" text-anchor="middle">'
        f"{escape(label)}</text>",
    ]
    for mark in chart.marks:
        y = TOP + chart.height_of(mark)
        parts.append(
            f'<path d="M{left} {y:.1f}h{wide}" stroke="#ddd"/>'
            f'<text x="{left - 5}" y="{y + 4:.1f}" text-anchor="end">{mark:g}</text>'
        )
    for number, text in enumerate(abscissae):
        x = left + number * step
        parts.append(
            f'<text x="{x:.1f}" y="{TOP + high + 14}" text-anchor="middle">{escape(text)}</text>'
        )
    for name, values in chart.lines.items():
        points = " ".join(
            f"{left + number * step:.1f},{TOP + chart.height_of(value):.1f}"
            for number, value in enumerate(values)
        )
        parts.append(
            f'<polyline points="{points}" fill="none" stroke="{colors[name]}" stroke-width="1.6"/>'
        )
    return parts
