# SPDX-License-Identifier: GPL-3.0-or-later
"""One exception for every failure: a status and the sentence that names the thing."""

from .enums import Status


class LodestoneError(Exception):
    """A call failed. `status` is the cause, `str()` the sentence."""

    def __init__(self, status: int, text: str) -> None:
        super().__init__(text or f"Lodestone failed with status {int(status)}")
        try:
            self.status: int = Status(status)
        except ValueError:
            self.status = int(status)

    @property
    def cancelled(self) -> bool:
        return self.status == Status.CANCELLED
