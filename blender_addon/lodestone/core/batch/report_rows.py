# SPDX-License-Identifier: GPL-3.0-or-later
"""One row for each file of a run, for the table on the terminal and the page."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from .. import progress_text
from ..exit_codes import ExitCode
from ..printable_text import printable

_ORDER = {ExitCode.CANCELLED: 1, ExitCode.INCOMPLETE: 2, ExitCode.DONE: 3}  # any failure: 0


class Compared(NamedTuple):
    """The numbers of the picture that differs most from that of the originals: differences of
    display values 0...1, triangles drawn, wall seconds of POV-Ray. Pairs are of originals and
    levels."""

    mean: float
    max: float
    ssim: float
    worst: str
    triangles: tuple[int, int]
    seconds: tuple[float, float]

    @classmethod
    def of(cls, pictures: Iterable[dict[str, Any]]) -> "Compared | None":
        found = (picture for picture in pictures if "compare" in picture)
        most = min(found, key=lambda picture: float(picture["compare"]["ssim"]), default=None)
        if most is None:
            return None
        difference, before = most["compare"], most["originals"]
        worst = difference["worst"]
        return cls(
            difference["mean"],
            difference["max"],
            difference["ssim"],
            worst[0]["object"].rsplit("/", 1)[-1] if worst else "",
            (before["cut"]["triangles"], most["cut"]["triangles"]),
            (before["povray"]["wall_s"], most["povray"]["wall_s"]),
        )

    @property
    def difference(self) -> str:
        return (
            f"mean {255 * self.mean:.2f}, largest {255 * self.max:.0f} of 255, SSIM {self.ssim:.4f}"
        )

    @property
    def sentence(self) -> str:
        placed, drawn = map(progress_text.count, self.triangles)
        before, after = self.seconds
        return (
            f"{self.difference}; {drawn} of {placed} triangles, "
            f"POV-Ray {after:.1f} of {before:.1f} s"
        )


@dataclass(frozen=True)
class Row:
    """One file in the table and on the page. `status` is the report's, or why it was stopped;
    numbers are None where there is none."""

    file: str
    code: ExitCode
    status: str
    message: str = ""
    wall_s: float | None = None
    peak_bytes: int | None = None
    triangles: int | None = None  # drawn, of the picture with most
    triangles_placed: int | None = None
    error_px: float | None = None  # the largest of all pictures
    error_name: str = ""
    compared: Compared | None = None
    pictures: tuple[str, ...] = ()
    problems: tuple[dict[str, str], ...] = ()
    log: str = ""
    thumbnail: str = ""
    resumed: bool = False

    @classmethod
    def of(cls, report: dict[str, Any]) -> "Row":
        made = report.get("pictures", [report])
        cuts = [picture["cut"] for picture in made if "cut" in picture]
        worst = max(cuts, key=lambda cut: float(cut["largest_error_px"]), default=None)
        code = ExitCode(report["exit_code"])
        return cls(
            file=report["input"],
            code=code,
            status=report.get("cause") or report["status"],
            message=report.get("message", ""),
            wall_s=report.get("wall_s"),
            peak_bytes=report.get("memory", {}).get("peak_bytes"),
            triangles=max((cut["triangles"] for cut in cuts), default=None),
            triangles_placed=report.get("model", {}).get("triangles_placed"),
            error_px=worst["largest_error_px"] if worst else None,
            error_name=worst["largest_error_name"] if worst else "",
            compared=Compared.of(made),
            pictures=tuple(picture["picture"] for picture in made if picture.get("picture")),
            problems=tuple(report.get("problems", ())),
            log=report.get("log", ""),
            thumbnail=report.get("thumbnail", ""),
            resumed=bool(report.get("resumed")),
        )

    @property
    def failed(self) -> bool:
        return self.code not in _ORDER


def rows_of(reports: Iterable[dict[str, Any]]) -> list[Row]:
    """Failed ones first, then what is not done, incomplete and done; else in their order."""
    return sorted(map(Row.of, reports), key=lambda row: _ORDER.get(row.code, 0))


def table(rows: Iterable[Row]) -> str:
    """The rows as text, for a terminal of any width: the file comes last."""
    rows = list(rows)
    compared = any(row.compared for row in rows)
    head = ("status", "time", "memory", "triangles", "of", "error")
    lines = [(*head, *(("mean", "SSIM") if compared else ()), "file")]
    for row in rows:
        found = row.compared
        differs = (f"{255 * found.mean:.2f}", f"{found.ssim:.4f}") if found else ("", "")
        lines.append(
            (
                printable(row.status),
                "" if row.wall_s is None else progress_text.clock(row.wall_s),
                "" if row.peak_bytes is None else progress_text.memory(row.peak_bytes),
                "" if row.triangles is None else progress_text.count(row.triangles),
                "" if row.triangles_placed is None else progress_text.count(row.triangles_placed),
                "" if row.error_px is None else f"{row.error_px:.2f} px",
                *(differs if compared else ()),
                printable(Path(row.file).name),
            )
        )
    widths = [max(map(len, column)) for column in list(zip(*lines))[:-1]]
    return "\n".join(
        "  ".join([status.ljust(widths[0]), *map(str.rjust, numbers, widths[1:]), name])
        for status, *numbers, name in lines
    )


def tally(rows: Iterable[Row]) -> str:
    """The sum in words, as "20 files: 3 failed, 1 incomplete, 16 done"."""
    found = list(rows)
    numbers = {
        "failed": sum(row.failed for row in found),
        "not done": sum(row.code == ExitCode.CANCELLED for row in found),
        "incomplete": sum(row.code == ExitCode.INCOMPLETE for row in found),
        "done": sum(row.code == ExitCode.DONE for row in found),
    }
    parts = [f"{count} {name}" for name, count in numbers.items() if count]
    return f"{len(found)} files: {', '.join(parts)}" if parts else "0 files"
