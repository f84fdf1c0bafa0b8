# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds liblodestone.so, checks that it speaks our version, and declares its functions."""

import ctypes
import os
from functools import lru_cache
from pathlib import Path

from .base import text_out
from .enums import ABI_VERSION, Status
from .errors import LodestoneError
from .functions import PROTOTYPES, Functions

NAME = "liblodestone.so"


class Library(Functions):
    """The loaded library. Its calls release the GIL: other threads run during every one."""

    path: Path

    def declare(self) -> None:
        """Raises AttributeError naming the first function the library lacks."""
        for name, result, arguments in PROTOTYPES:
            function = getattr(self, name)
            function.restype = result
            function.argtypes = arguments


def candidates() -> list[Path]:
    """Where the library is looked for, in this order; $LODESTONE_LIBRARY alone when it is set."""
    chosen = os.environ.get("LODESTONE_LIBRARY")
    if chosen:
        return [Path(chosen)]
    package = Path(__file__).resolve().parent
    places = [package.parent / "lib" / NAME]  # staged: addons/lodestone/{lodestone_native,lib}
    if package.parent.name == "python":  # built: build/release/python/lodestone_native
        stage = os.environ.get("LODESTONE_STAGE") or str(package.parents[1] / "stage")
        places.append(Path(stage) / "addons" / "lodestone" / "lib" / NAME)
    return places


@lru_cache(maxsize=None)
def library() -> Library:
    places = candidates()
    path = next((place for place in places if place.is_file()), None)
    if path is None:
        looked = ", ".join(str(place) for place in places)
        raise LodestoneError(Status.IO, f"{NAME} is missing (looked for {looked})")
    try:
        loaded = Library(str(path))
        abi = getattr(loaded, "lds_abi_version")
    except (OSError, AttributeError) as error:
        raise LodestoneError(Status.IO, f"{path} cannot be loaded: {error}") from None
    abi.restype = ctypes.c_uint32
    abi.argtypes = []
    if abi() != ABI_VERSION:
        raise LodestoneError(
            Status.INTERNAL, f"{path} has ABI {abi()}, this add-on needs {ABI_VERSION}"
        )
    try:
        loaded.declare()
    except AttributeError as error:
        raise LodestoneError(Status.INTERNAL, f"{path} is incomplete: {error}") from None
    loaded.path = path
    return loaded


def check(status: int) -> None:
    """Raises the sentence of this thread's last failed call."""
    if status != Status.OK:
        raise LodestoneError(status, text_out(library().lds_last_error_text()))


def library_path() -> Path:
    return library().path


def abi_version() -> int:
    return library().lds_abi_version()


def version() -> str:
    return text_out(library().lds_version())


def rays_check() -> None:
    """Raises RAYS_UNAVAILABLE with the reason when Embree cannot be used."""
    check(library().lds_rays_check())
