# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture that somebody looks at while POV-Ray draws it: what is new, how often to show it, and
how long it still takes."""

import time
from collections.abc import Callable, Iterator

from ..native import lodestone_native as native

# Taste: seconds between two looks at what is new; shorter looks smoother and costs more.
_INTERVAL_S = 0.25
# Taste: the share of the time that showing may take where it is slow; a larger one is smoother.
# Each pixel is shown about four times, so that all of it costs far less.
_MOST_SHARE = 0.1
# Taste: seconds after which no more of what is new is shown in one look.
_MOST_S = 0.5
# Taste: before so much of a picture is finished, nobody knows how long the rest takes.
_LEAST_SHARE = 0.03
_LEAST_S = 2.0
# Taste: pixels of a picture that is too large to be shown while it is drawn: its copy would take
# 1 GB, and Blender's own as much.
_MOST_PIXELS = 64_000_000


class WatchedPicture:
    """`live` is drawn into by make_picture() on one thread; the rest is asked from another one.
    `part`: left, top, width, height of what is drawn. `clock`: seconds that never go back."""

    def __init__(
        self, part: tuple[int, int, int, int], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.live = native.LivePicture(part)
        self._clock = clock
        self._next = 0.0  # when to show something again
        self._first: tuple[float, float] | None = None  # a time, and the share finished by then

    def news(self) -> Iterator[native.DrawnPart]:
        """What was drawn since the last time, lowest row first; nothing when that was shown just
        now. Showing it counts until the last part was asked for."""
        start = self._clock()
        if start < self._next:
            return
        shown = False
        for part in self.live.take(bottom_up=True):
            shown = True
            yield part
            if self._clock() - start > _MOST_S:
                break  # the window is to answer; the rest comes the next time
        end = self._clock()
        if shown:
            self._next = end + max(_INTERVAL_S, (end - start) / _MOST_SHARE)

    def rest(self) -> Iterator[native.DrawnPart]:
        """All that was drawn and not shown yet."""
        return self.live.take(bottom_up=True)

    @property
    def finished(self) -> float:
        """The share of the pixels that are finished, 0...1."""
        return self.live.finished

    def seconds_left(self) -> float | None:
        """The time that the rest of the pixels takes if they take as long as those before; None
        while too few are finished to tell. What comes before the first finished pixels does not
        count: gathering light and the mosaic."""
        now, share = self._clock(), self.finished
        if share <= 0.0:
            return None
        if self._first is None:
            self._first = (now, share)
        since, before = self._first
        done, took = share - before, now - since
        if done < _LEAST_SHARE or took < _LEAST_S:
            return None
        return took * (1.0 - share) / done


def watched(part: tuple[int, int, int, int]) -> WatchedPicture | None:
    """A picture to look at while it is drawn; None: it is too large for that, or there is no memory
    for it."""
    if part[2] * part[3] > _MOST_PIXELS:
        return None
    try:
        return WatchedPicture(part)
    except native.LodestoneError:
        return None
