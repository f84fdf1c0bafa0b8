# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether two folders hold the same bits, up to the names of their files.

Files of stores and scenes are named by hashes. A name that only one side has may stand for a name
that only the other has, if one mapping, the same for all files, makes every file equal. A name
that both sides have stands for itself.
"""

import hashlib
import re
import struct
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

HASH = r"[0-9a-f]{16}"
# Not within a longer word or number: 0.1234567890123456 and 7.439450655510882e-08 are none
TOKEN = re.compile(rf"(?<![0-9A-Za-z.+-]){HASH}(?![0-9A-Za-z])")
IDENTIFIER = re.compile(rf"\bLDS_[A-Z]+_({HASH})\b")
STEM = re.compile(rf"{HASH}\Z")
GLB_HEADER = struct.Struct("<4sIIII")
SHOWN_DIFFERENCES = 3
SHOWN_COLUMNS = 120
SHOWN_BYTES = 16


@dataclass(frozen=True)
class Content:
    """A file: the text that may name other files, and the bytes around it."""

    before: bytes
    text: str
    after: bytes


@dataclass
class Verdict:
    """The differences of two folders; each text tells of one file."""

    files: int = 0
    renamed: int = 0
    differences: list[str] = field(default_factory=list)


def content_of(data: bytes) -> Content:
    """The parts of a file. Text is all of a text file and the JSON of a GLB."""
    if data[:4] == b"glTF" and len(data) >= GLB_HEADER.size:
        length = GLB_HEADER.unpack_from(data)[3]
        end = GLB_HEADER.size + length
        return Content(
            data[: GLB_HEADER.size],
            data[GLB_HEADER.size : end].decode("utf-8", "surrogateescape"),
            data[end:],
        )
    if b"\0" in data:
        return Content(data, "", b"")
    try:
        return Content(b"", data.decode("utf-8"), b"")
    except UnicodeDecodeError:
        return Content(data, "", b"")


def joined(content: Content) -> bytes:
    return content.before + content.text.encode("utf-8", "surrogateescape") + content.after


def lines_of(text: str) -> list[str]:
    """The lines of a text. JSON, which is one long line, is cut after commas and brackets."""
    if text[:1] not in ("{", "["):
        return text.split("\n")
    return re.sub(r'("(?:[^"\\]|\\.)*")|([,{}\[\]])', _cut, text).split("\n")


def _cut(found: re.Match) -> str:
    return found[1] if found[2] is None else found[2] + "\n"


def listed(folder: Path) -> dict[str, Path]:
    """{name below the folder: file}"""
    return {
        path.relative_to(folder).as_posix(): path
        for path in sorted(folder.rglob("*"))
        if path.is_file() or path.is_symlink()
    }


def compare(before: Path, after: Path, ignore: re.Pattern | None = None) -> Verdict:
    """Compares all files below two folders. Lines that `ignore` finds may differ."""
    ours, theirs = listed(before), listed(after)
    if ours.keys() == theirs.keys():
        pairs = [(name, name) for name in ours if not _same(ours[name], theirs[name])]
        if not pairs:
            return Verdict(files=len(ours))
    return compared(_read(ours), _read(theirs), ignore)


def _same(one: Path, other: Path) -> bool:
    return one.stat().st_size == other.stat().st_size and one.read_bytes() == other.read_bytes()


def _read(files: dict[str, Path]) -> dict[str, bytes]:
    return {name: path.read_bytes() for name, path in files.items()}


def compared(
    before: dict[str, bytes], after: dict[str, bytes], ignore: re.Pattern | None = None
) -> Verdict:
    """Compares {name: content} with {name: content}."""
    sides = [{name: content_of(data) for name, data in files.items()} for files in (before, after)]
    mapping = matched(*sides)
    verdict = Verdict(files=len(before))
    left = dict(sides[1])
    for name, content in sides[0].items():
        target = renamed_path(name, mapping)
        other = left.pop(target, None)
        if other is None:
            verdict.differences.append(f"{name}: only in BEFORE")
            continue
        verdict.renamed += target != name
        told = difference(renamed(content, mapping), other, ignore)
        if told:
            both = name if target == name else f"{name} (AFTER: {target})"
            verdict.differences.append(f"{both}: {told}")
    verdict.differences += [f"{name}: only in AFTER" for name in left]
    return verdict


# ---- Names ----


def stem_of(name: str) -> str | None:
    """The hash that a file is named by."""
    stem = name.rsplit("/", 1)[-1].split(".", 1)[0]
    return stem if STEM.match(stem) else None


def names_in(files: dict[str, Content]) -> set[str]:
    """The hashes that files and what scenes declare are named by."""
    stems = {stem for stem in map(stem_of, files) if stem is not None}
    declared = (IDENTIFIER.findall(content.text) for content in files.values())
    return stems.union(*declared)


def renamed_path(name: str, mapping: dict[str, str]) -> str:
    stem = stem_of(name)
    if stem is None or stem not in mapping:
        return name
    folder, slash, last = name.rpartition("/")
    return folder + slash + mapping[stem] + last[len(stem) :]


def renamed(content: Content, mapping: dict[str, str]) -> Content:
    if not mapping:
        return content
    text = TOKEN.sub(lambda found: mapping.get(found[0], found[0]), content.text)
    return Content(content.before, text, content.after)


def matched(before: dict[str, Content], after: dict[str, Content]) -> dict[str, str]:
    """A bijection of the names that only `before` has to those that only `after` has.

    Names go together when the files that they name are equal but for names, and stand at the same
    places in equal texts; then, where texts differ, by their own files alone.
    """
    ours, theirs = names_in(before), names_in(after)
    free = [ours - theirs, theirs - ours]
    mapping: dict[str, str] = {}
    if not all(free):
        return mapping
    seen = [Occurrences(before, free[0]), Occurrences(after, free[1])]
    for signature in (Occurrences.everywhere, Occurrences.own):
        groups = [_grouped(signature(side), names) for side, names in zip(seen, free)]
        for key, names in groups[0].items():
            others = groups[1].get(key, [])
            if len(names) == len(others):  # several: nothing tells them apart
                mapping.update(zip(sorted(names), sorted(others)))
        free = [free[0] - mapping.keys(), free[1] - set(mapping.values())]
    return mapping


def _grouped(signatures: dict[str, tuple], names: set[str]) -> dict[tuple, list[str]]:
    groups = defaultdict(list)
    for name in names:
        groups[signatures[name]].append(name)
    return groups


class Occurrences:
    """Where the free names of one side stand."""

    def __init__(self, files: dict[str, Content], free: set[str]) -> None:
        self._own: dict[str, list] = {name: [] for name in free}
        self._places: dict[str, list] = {name: [] for name in free}
        for path, content in files.items():
            found = [token for token in TOKEN.findall(content.text) if token in free]
            label = self._label(path, content, free)
            stem = stem_of(path)
            if stem in free:
                self._own[stem].append(label)
            for number, token in enumerate(found):
                self._places[token].append((label, number))

    @staticmethod
    def _label(path: str, content: Content, free: set[str]) -> tuple[str, str]:
        """A file without its free names."""
        blank = renamed(content, dict.fromkeys(free, "#" * 16))
        digest = hashlib.blake2b(joined(blank), digest_size=16).hexdigest()
        stem = stem_of(path)
        return (renamed_path(path, {stem: "#" * 16}) if stem in free else path, digest)

    def everywhere(self) -> dict[str, tuple]:
        return {
            name: (tuple(sorted(own)), tuple(sorted(self._places[name])))
            for name, own in self._own.items()
        }

    def own(self) -> dict[str, tuple]:
        """A name without a file goes with none."""
        return {name: tuple(sorted(own)) or (name,) for name, own in self._own.items()}


# ---- What differs ----


def difference(before: Content, after: Content, ignore: re.Pattern | None = None) -> str:
    """The first differences of two files; empty when there is none that counts."""
    if before == after:
        return ""
    told = list(_of_texts(before.text, after.text, ignore))
    if before.before != after.before and not (ignore and before.text != after.text):
        told.append(_of_bytes(before.before, after.before))  # else a GLB's lengths may differ
    if before.after != after.after:
        told.append(_of_bytes(before.after, after.after))
    return "".join(f"\n    {line}" for line in told)


def _of_texts(before: str, after: str, ignore: re.Pattern | None) -> Iterator[str]:
    if before == after:
        return
    ours, theirs = (
        [
            (number, line)
            for number, line in enumerate(lines_of(text), 1)
            if not _found(ignore, line)
        ]
        for text in (before, after)
    )
    shown = 0
    for (number, one), (_, other) in zip(ours, theirs):
        if one != other:
            yield from _of_lines(number, one, other)
            shown += 1
            if shown == SHOWN_DIFFERENCES:
                break
    if len(ours) != len(theirs):
        yield f"{len(ours):,} lines, then {len(theirs):,}"


def _found(ignore: re.Pattern | None, line: str) -> bool:
    return ignore is not None and ignore.search(line) is not None


def _of_lines(number: int, one: str, other: str) -> Iterator[str]:
    column = next((i for i, (a, b) in enumerate(zip(one, other)) if a != b), 0)
    start = max(0, column - SHOWN_COLUMNS // 2)
    for sign, line in (("-", one), ("+", other)):
        yield f"{number:,} {sign} {line[start:start + SHOWN_COLUMNS]}"


def _of_bytes(one: bytes, other: bytes) -> str:
    end = min(len(one), len(other))
    at = next((i for i in range(end) if one[i] != other[i]), end)
    shown = " then ".join(
        data[at : at + SHOWN_BYTES].hex(" ") or "the end" for data in (one, other)
    )
    return f"byte {at:,} of {len(one):,} and {len(other):,}: {shown}"


def summary(scene: str, verdict: Verdict) -> str:
    if verdict.differences:
        return f"{scene}: {len(verdict.differences):,} of {verdict.files:,} files differ"
    names = f", {verdict.renamed:,} of them renamed" if verdict.renamed else ""
    return f"{scene}: {verdict.files:,} files, the same bits{names}"


def suffixes(verdict: Verdict) -> str:
    """Which kinds of files differ: 2 .glb, 1 .json"""
    kinds = Counter(
        Path(text.split(":", 1)[0].split(" ", 1)[0]).suffix for text in verdict.differences
    )
    return ", ".join(f"{count:,} {kind or 'others'}" for kind, count in kinds.most_common())
