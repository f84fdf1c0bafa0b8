# SPDX-License-Identifier: GPL-3.0-or-later
"""A long call's progress and its off switch, shared with the library by reference."""

from . import structs


class Job(structs.Job):
    """Give it to a long call; read `stage` and `fraction` and call `stop` from any thread."""

    def __init__(self) -> None:
        super().__init__()

    def stop(self) -> None:
        """The call raises CANCELLED within about 0.1 s."""
        self.cancel = 1
