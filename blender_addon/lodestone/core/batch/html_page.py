# SPDX-License-Identifier: GPL-3.0-or-later
"""The page of --html: every file of a run, failed ones first. One file without scripts; nothing is
loaded from elsewhere, and names are never more than text."""

import base64
import os
import tempfile
from collections.abc import Iterable
from html import escape
from pathlib import Path
from urllib.parse import quote

from .. import progress_text
from ..exit_codes import ExitCode
from ..printable_text import printable
from ..problems import Problem
from .report_rows import Row, tally

_LARGEST_THUMBNAIL = 200_000
_MOST_PROBLEMS = 200
_STYLE = """
body{font:15px/1.4 system-ui,sans-serif;margin:2em;background:#fff;color:#222}
table{border-collapse:collapse;width:100%}
th,td{text-align:left;vertical-align:top;padding:.5em .7em;border-bottom:1px solid #ddd}
td.n,th.n{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums}
td:first-child{border-left:6px solid #4a4}
tr.failed td:first-child{border-color:#c22}tr.failed{background:#fdeeee}
tr.incomplete td:first-child{border-color:#d90}
tr.cancelled td:first-child,tr.running td:first-child{border-color:#999}
.picture{display:block;width:192px;min-height:24px}.picture img{max-width:192px;max-height:144px}
.file{font-weight:600;overflow-wrap:anywhere}.message{overflow-wrap:anywhere}
.folder,small{color:#666;overflow-wrap:anywhere}summary{cursor:pointer}
@media(prefers-color-scheme:dark){body{background:#1c1c1c;color:#ddd}tr.failed{background:#3a2020}
a{color:#8bf}th,td{border-bottom-color:#444}.folder,small{color:#999}}
"""


def page(rows: Iterable[Row], title: str, about: str, target: Path, running: int = 0) -> str:
    """The page as text. `about` is one line on the run; `target` is where the page will lie, which
    links are relative to; `running`: how many files are still to come."""
    rows = list(rows)
    compared = any(row.compared for row in rows)
    still = f" Still running: {running} to come." if running else ""
    head = "".join(
        f'<th{" class=n" if number else ""}>{text}</th>'
        for text, number in (
            ("Picture", False),
            ("File", False),
            ("Status", False),
            ("Time", True),
            ("Memory", True),
            ("Triangles", True),
            ("Largest error", True),
            *((("Difference", True), ("POV-Ray", True)) if compared else ()),
            ("Log", False),
        )
    )
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">\n'
        '<meta http-equiv="Content-Security-Policy" '
        "content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'\">\n"
        '<meta name="viewport" content="width=device-width">\n'
        f"<title>{_text(title)}</title>\n<style>{_STYLE}</style></head><body>\n"
        f"<h1>{_text(title)}</h1>\n<p>{_text(tally(rows))}.{still} {_text(about)}</p>\n"
        f"<table><thead><tr>{head}</tr></thead><tbody>\n"
        + "\n".join(_row(row, target, compared) for row in rows)
        + "\n</tbody></table>\n</body></html>\n"
    )


def write(path: str, text: str) -> None:
    """Whole or not at all. Raises OSError."""
    target = Path(path)
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=".page-")
    try:
        with os.fdopen(handle, "w", encoding="utf-8", errors="replace") as file:
            file.write(text)
        os.chmod(name, 0o644)
        os.replace(name, target)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def _row(row: Row, target: Path, compared: bool) -> str:
    path = Path(row.file)
    numbers = (
        "" if row.wall_s is None else progress_text.clock(row.wall_s),
        "" if row.peak_bytes is None else progress_text.memory(row.peak_bytes),
        _triangles(row),
        _error(row),
        *((_difference(row), _seconds(row)) if compared else ()),
    )
    log = f'<a href="{_link(row.log, target)}">log</a>' if row.log else ""
    return (
        f'<tr class="{_class(row)}"><td>{_picture(row, target)}</td>'
        f'<td><span class="file"><bdi>{_text(path.name)}</bdi></span><br>'
        f'<span class="folder"><bdi>{_text(str(path.parent))}</bdi></span></td>'
        f"<td>{_text(row.status)}{_again(row)}{_message(row)}{_problems(row)}</td>"
        + "".join(f'<td class="n">{number}</td>' for number in numbers)
        + f"<td>{log}</td></tr>"
    )


def _class(row: Row) -> str:
    if row.failed:
        return "failed"
    names = {ExitCode.CANCELLED: "cancelled", ExitCode.INCOMPLETE: "incomplete"}
    return names.get(row.code, "done")


def _picture(row: Row, target: Path) -> str:
    image = ""
    try:
        if row.thumbnail and os.path.getsize(row.thumbnail) <= _LARGEST_THUMBNAIL:
            data = base64.b64encode(Path(row.thumbnail).read_bytes()).decode()
            image = f'<img alt="" src="data:image/jpeg;base64,{data}">'
    except OSError:
        pass
    if not row.pictures:
        return ""
    more = f"<br><small>{len(row.pictures)} pictures</small>" if len(row.pictures) > 1 else ""
    link = _link(row.pictures[0], target)
    return f'<a class="picture" href="{link}">{image or "picture"}</a>{more}'


def _again(row: Row) -> str:
    return " <small>(by an earlier run)</small>" if row.resumed else ""


def _message(row: Row) -> str:
    return f'<div class="message"><bdi>{_text(row.message)}</bdi></div>' if row.message else ""


def _problems(row: Row) -> str:
    if not row.problems:
        return ""
    items = "".join(
        f"<li>{_text(p['severity'])}: <bdi>{_text(Problem(**p).sentence)}</bdi></li>"
        for p in row.problems[:_MOST_PROBLEMS]
    )
    left = len(row.problems) - _MOST_PROBLEMS
    more = f"<li>and {left} more: see the report</li>" if left > 0 else ""
    count = f"{len(row.problems)} problem{'s' if len(row.problems) > 1 else ''}"
    return f"<details><summary>{count}</summary><ul>{items}{more}</ul></details>"


def _triangles(row: Row) -> str:
    if row.triangles is None:
        return "" if row.triangles_placed is None else progress_text.count(row.triangles_placed)
    placed = "" if row.triangles_placed is None else progress_text.count(row.triangles_placed)
    return progress_text.count(row.triangles) + (
        f"<br><small>of {placed}</small>" if placed else ""
    )


def _error(row: Row) -> str:
    if row.error_px is None:
        return ""
    name = f"<br><small><bdi>{_text(row.error_name)}</bdi></small>" if row.error_name else ""
    return f"{row.error_px:.2f} px{name}"


def _difference(row: Row) -> str:
    found = row.compared
    if found is None:
        return ""
    name = f"<br><small>most: <bdi>{_text(found.worst)}</bdi></small>" if found.worst else ""
    return "<br>".join(found.difference.split(", ")) + name


def _seconds(row: Row) -> str:
    if row.compared is None:
        return ""
    before, after = row.compared.seconds
    return f"{after:.1f} s<br><small>of {before:.1f} s</small>"


def _text(text: str) -> str:
    return escape(printable(text), quote=True)


def _link(path: str, target: Path) -> str:
    """A relative address, so that the folder can be moved; no path can become another scheme."""
    relative = os.path.relpath(path, os.path.abspath(target.parent))
    try:
        name = os.fsencode(relative)
    except UnicodeEncodeError:  # no file of this system has such a name
        name = relative.encode("utf-8", "replace")
    return escape("./" + quote(name), quote=True)
