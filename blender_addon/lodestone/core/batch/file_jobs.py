# SPDX-License-Identifier: GPL-3.0-or-later
"""The work that one Blender is asked to do with one file, and how it travels there."""

import hashlib
import json
import os
from collections.abc import Iterator
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from ..file_names import LONGEST, fitting

# Fields of FileJob that change nothing of what is made
OF_A_RUN = ("report", "threads", "program", "skip", "thumbnail", "supervisor", "keep")
# Those that change nothing of one of its pictures either: the store gives the same levels
BESIDE_PICTURES = ("pictures", "frames", "store", "strict")


@dataclass(frozen=True)
class PictureRequest:
    """One picture (or exported scene) of one input. `out`: the picture, or for export the folder;
    `camera` "" and None in the others: as the file has it."""

    out: str
    camera: str = ""
    pixel_error: float | None = None
    antialias: str | None = None
    overrides: dict[str, float] = field(
        default_factory=dict
    )  # by the keys of quality_tree.py's controls
    budget: int | None = None  # bytes of POV-Ray's scene
    off_screen: str | None = None  # these two as unseen_detail.py's words
    ray_classes: str | None = None
    false_color: bool = False
    covered_only: bool = False
    size: tuple[int, int] | None = None

    @property
    def levels(self) -> bool:
        """Whether anything but originals may be drawn."""
        return (self.pixel_error or 0.0) > 0.0 or bool(self.budget)

    def for_frame(self, frame: int) -> "PictureRequest":
        """The request for one frame: out.png becomes out_0001.png."""
        path = Path(self.out)
        name = fitting(f"{path.stem}_{frame:04}", LONGEST - len(os.fsencode(path.suffix)))
        return replace(self, out=str(path.with_name(name + path.suffix)))


@dataclass(frozen=True)
class FileJob:
    """The work of one Blender with one input. `skip` names the `out` of pictures that are there
    already; `report`, `thumbnail` and `supervisor` are those of one run. What OF_A_RUN does not
    name makes --resume do the work again."""

    verb: str
    file: str
    store: str
    report: str
    pictures: tuple[PictureRequest, ...]
    frames: tuple[int, int] | None = None
    threads: int = 0
    program: str = ""
    keep: str = "failed"
    keep_exr: bool = False
    strict: bool = False
    trust_scripts: bool = False
    skip: tuple[str, ...] = ()
    thumbnail: str = ""
    supervisor: int = 0  # process id of batch.py
    version: str = ""  # Lodestone's

    def wanted(self) -> Iterator[tuple[int | None, PictureRequest]]:
        """Each picture with its frame (None: the file's own), in the order of the report."""
        if self.frames is None:
            yield from ((None, picture) for picture in self.pictures)
            return
        for frame in range(self.frames[0], self.frames[1] + 1):
            yield from ((frame, picture.for_frame(frame)) for picture in self.pictures)

    @property
    def many_pictures(self) -> bool:
        """Whether the report has a list of them."""
        return len(self.pictures) > 1 or self.frames is not None

    def key(self) -> str:
        """A text that is equal for jobs that make the same things from the same input."""
        return _hash(self._without(OF_A_RUN))

    def picture_key(self, frame: int | None, picture: PictureRequest) -> str:
        """The same for one picture, whatever else a job makes."""
        return _hash([self._without(OF_A_RUN + BESIDE_PICTURES), frame, asdict(picture)])

    def _without(self, names: tuple[str, ...]) -> dict[str, Any]:
        return {name: value for name, value in asdict(self).items() if name not in names}

    def dump(self) -> str:
        return json.dumps(asdict(self))

    @classmethod
    def load(cls, text: str) -> "FileJob":
        values = _tuples(json.loads(text))
        values["pictures"] = tuple(PictureRequest(**picture) for picture in values["pictures"])
        return cls(**values)


def _tuples(value: Any) -> Any:
    """The same with tuples, which JSON made lists of."""
    if isinstance(value, dict):
        return {key: _tuples(one) for key, one in value.items()}
    return tuple(map(_tuples, value)) if isinstance(value, list) else value


def _hash(value: Any) -> str:
    text = json.dumps(value, sort_keys=True)
    return hashlib.blake2b(text.encode(), digest_size=16).hexdigest()
