# SPDX-License-Identifier: GPL-3.0-or-later
"""The texts of progress lines and of numbers, the same in every place that shows them."""


def clock(seconds: float) -> str:
    """A duration: 0:07, 12:30, 1:02:03."""
    total = max(0, int(seconds))
    minutes, second = divmod(total, 60)
    hours, minute = divmod(minutes, 60)
    return f"{hours}:{minute:02}:{second:02}" if hours else f"{minute}:{second:02}"


def count(number: float) -> str:
    """A number in three figures at most: 812, 41.3 k, 1.2 M, 3.4 G."""
    for size, unit in ((1e9, " G"), (1e6, " M"), (1e4, " k")):
        if number >= size:
            value = number / (1e3 if unit == " k" else size)
            return f"{value:.0f}{unit}" if value >= 100 else f"{value:.1f}{unit}"
    return f"{int(number):,}"


def length(metres: float) -> str:
    """An error as artists read it: 0.4 mm, 11 mm, 1.25 m."""
    if metres >= 1.0:
        return f"{metres:.2f} m"
    if metres >= 0.01:
        return f"{metres * 1e3:.0f} mm"
    return f"{metres * 1e3:.2g} mm" if metres > 0.0 else "0 mm"


def memory(size: float) -> str:
    for unit, name in ((1e9, "GB"), (1e6, "MB"), (1e3, "kB")):
        if size >= unit:
            return f"{size / unit:.1f} {name}" if size < 10 * unit else f"{size / unit:.0f} {name}"
    return f"{int(size)} B"


def percent(part: float, whole: float) -> str:
    return f"{100.0 * part / whole:.0f} %" if whole > 0 else "0 %"


class StageClock:
    """Builds lines like `Frame 1 | Levels 0:42 | Parse 0:11 | Trace 64 %, about 0:20 left | 1.2 M
    of 22.4 M triangles`."""

    def __init__(self, frame: int) -> None:
        self._parts = [f"Frame {frame}"]
        self._stage = ""
        self._since = 0.0
        self.tail = ""

    def line(
        self, stage: str, now: float, fraction: float | None = None, left: float | None = None
    ) -> str:
        """The line for a stage. `now` is in seconds of any steady clock; `fraction` is 0...1 of the
        stage and `left` the seconds that it still takes, when they are known. No stage: between
        two of them."""
        stage = stage or self._stage
        if stage != self._stage:
            if self._stage:
                self._parts.append(f"{self._stage} {clock(now - self._since)}")
            self._stage, self._since = stage, now
        running = f"{stage} {percent(fraction, 1.0)}" if fraction else stage
        if left is not None:
            running += f", about {clock(left)} left"
        return " | ".join([*self._parts, running, *([self.tail] if self.tail else [])])


def triangles(drawn: int, placed: int) -> str:
    """The triangles that are drawn, of those that are placed: 48.5 k of 2.9 M triangles."""
    if drawn >= placed:
        return f"{count(drawn)} triangles"
    return f"{count(drawn)} of {count(placed)} triangles"


def building(done: int, total: int) -> str:
    return f"Lodestone: building levels {done:,}/{total:,}   [Esc] Cancel"


def comparing(step: int, steps: int, word: str) -> str:
    return f"Lodestone: comparing, picture {step} of {steps}: {word}   [Esc] Cancel"
