# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene's files of the render that is running: one folder for all its frames and view layers,
so that what does not change is written once. In a window the next render uses them again."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType

from .picture_maker import SceneFolder, remove_others, used_files


class RenderFolder:
    """Lives as long as the process; end_render() when a render begins and when it is over, close()
    when another file is opened and in the end. `lasting`: from one render to the next one, which
    then starts sooner."""

    def __init__(self, lasting: bool = False) -> None:
        self.lasting = lasting
        self._held: SceneFolder | None = None
        self._made_for: tuple[Path, str] | None = None
        self._frame: int | None = None
        self._used: tuple[set[str], set[str]] = (set(), set())  # in the frame before, in this one

    @contextmanager
    def use(self, kept: Path, keep: str, frame: int) -> Iterator[SceneFolder]:
        """Gives the folder for one picture, as SceneFolder(kept, keep). After a failure it is kept
        or removed as that says, and the next picture gets a new one; so it is when a picture is
        stopped and the folder does not last."""
        if self._held is None or self._made_for != (kept, keep) or not self._held.path.is_dir():
            self.close()
            self._held = SceneFolder(kept, keep).__enter__()
            self._made_for = (kept, keep)
        try:
            yield self._held
        except BaseException as error:
            if not (self.lasting and getattr(error, "cancelled", False)):
                self._end(*sys.exc_info())
            raise
        if not self._held.stays:
            self._tidy(self._held.path, frame)

    def end_render(self) -> None:
        """Removes the files, unless they are the user's, or last; then the next render is to them
        as another frame. The user's own folder is free for other processes."""
        if self.lasting and self._held is not None and not self._held.stays:
            self._frame = None
        else:
            self._end()

    def close(self) -> None:
        """Removes the files, unless they are the user's."""
        self._end()

    def _end(
        self,
        kind: type[BaseException] | None = None,
        error: BaseException | None = None,
        trace: TracebackType | None = None,
    ) -> None:
        held, self._held = self._held, None
        self._frame, self._used = None, (set(), set())
        if held is not None:
            held.__exit__(kind, error, trace)

    def _tidy(self, folder: Path, frame: int) -> None:
        """Removes what neither this frame nor the one before uses: what changes its shape would
        fill the disk. In one frame a view layer may use what the one before it used."""
        before, now = self._used
        if frame != self._frame:
            before, now = now, set()
        self._frame, self._used = frame, (before, now | used_files(folder))
        remove_others(folder, set.union(*self._used))
