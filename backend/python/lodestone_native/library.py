# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds liblodestone.so, checks that it speaks our version, and declares its functions."""

import ctypes
import os
from functools import lru_cache
from pathlib import Path

from .enums import Status
from .errors import LodestoneError
from .prototypes import declare
from .structs import text_out

ABI_VERSION = 4
NAME = "liblodestone.so"


def candidates() -> list[Path]:
    """Where the library is looked for, in this order; $LODESTONE_LIBRARY alone when it is set."""
    chosen = os.environ.get("LODESTONE_LIBRARY")
    if chosen:
        return [Path(chosen)]
    package = Path(__file__).resolve().parent
    places = [package.parent / "lib" / NAME]  # staged: addons/lodestone/{lodestone_native,lib}
    if package.parent.name == "python":  # a checkout: backend/python/lodestone_native
        root = package.parents[2]
        stage = os.environ.get("LODESTONE_STAGE") or str(root / "build" / "release" / "stage")
        places.append(Path(stage) / "addons" / "lodestone" / "lib" / NAME)
    return places


@lru_cache(maxsize=None)
def library() -> ctypes.CDLL:
    """The loaded library. CDLL releases the GIL: other threads run during every call."""
    places = candidates()
    path = next((place for place in places if place.is_file()), None)
    if path is None:
        looked = ", ".join(str(place) for place in places)
        raise LodestoneError(Status.IO, f"{NAME} is missing (looked for {looked})")
    try:
        loaded = ctypes.CDLL(str(path))
        abi = loaded.lds_abi_version
    except (OSError, AttributeError) as error:
        raise LodestoneError(Status.IO, f"{path} cannot be loaded: {error}") from None
    abi.restype = ctypes.c_uint32
    abi.argtypes = []
    if abi() != ABI_VERSION:
        raise LodestoneError(
            Status.INTERNAL, f"{path} has ABI {abi()}, this add-on needs {ABI_VERSION}"
        )
    try:
        declare(loaded)
    except AttributeError as error:
        raise LodestoneError(Status.INTERNAL, f"{path} is incomplete: {error}") from None
    loaded.lodestone_path = path
    return loaded


def check(status: int) -> None:
    """Raises the sentence of this thread's last failed call."""
    if status != Status.OK:
        raise LodestoneError(status, text_out(library().lds_last_error_text()))


def library_path() -> Path:
    return library().lodestone_path


def abi_version() -> int:
    return library().lds_abi_version()


def version() -> str:
    return text_out(library().lds_version())


def rays_check() -> None:
    """Raises RAYS_UNAVAILABLE with the reason when Embree cannot be used."""
    check(library().lds_rays_check())
