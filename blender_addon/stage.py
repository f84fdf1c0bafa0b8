# SPDX-License-Identifier: GPL-3.0-or-later
"""Collects the add-on, the binding and all libraries they need into one folder and one zip."""

import argparse
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

# Found on every Linux with Blender; libtbb.so.12 must be Blender's own copy, never a second one.
SYSTEM_LIBRARIES = (
    "ld-linux-x86-64.so.2",
    "ld-linux-aarch64.so.1",
    "libc.so.6",
    "libdl.so.2",
    "libgcc_s.so.1",
    "libm.so.6",
    "libpthread.so.0",
    "librt.so.1",
    "libstdc++.so.6",
    "libtbb.so.12",
    "libz.so.1",
)


def dynamic_entries(library: Path, tag: str) -> list[str]:
    """The values of one tag (NEEDED, SONAME) in the dynamic section, in order."""
    text = subprocess.run(
        ["readelf", "--dynamic", "--wide", str(library)],
        check=True,
        capture_output=True,
        text=True,
        env={**os.environ, "LC_ALL": "C"},
    ).stdout
    return re.findall(rf"\({tag}\)[^\[]*\[([^\]]+)\]", text)


def resolved_libraries(library: Path) -> dict[str, Path]:
    """soname -> file for everything the loader would load with this library."""
    text = subprocess.run(["ldd", str(library)], check=True, capture_output=True, text=True).stdout
    missing = re.findall(r"^\s*(\S+) => not found", text, re.MULTILINE)
    if missing:
        raise SystemExit(f"stage: {library} needs {', '.join(missing)}, which is not installed")
    return {name: Path(path) for name, path in re.findall(r"(\S+) => (/\S+)", text)}


def collect_libraries(roots: list[Path]) -> dict[str, Path]:
    """soname -> file of the given libraries and of all they need but the system's, recursively."""
    found: dict[str, Path] = {}
    waiting = list(roots)
    while waiting:
        library = waiting.pop()
        name = (dynamic_entries(library, "SONAME") or [library.name])[0]
        if name in found:
            continue
        found[name] = library
        where = resolved_libraries(library)
        waiting += [
            where[needed]
            for needed in dynamic_entries(library, "NEEDED")
            if needed not in SYSTEM_LIBRARIES
        ]
    return found


def package_files(folder: Path, below: str) -> dict[str, Path]:
    """Name in the stage -> source, without what Python and editors leave behind."""
    return {
        below + file.relative_to(folder).as_posix(): file
        for file in sorted(folder.rglob("*"))
        if file.is_file()
        and "__pycache__" not in file.parts
        and not file.name.startswith(".")
        and not file.name.endswith((".pyc", "~"))
    }


def same_content(a: Path, b: Path) -> bool:
    return b.is_file() and a.stat().st_size == b.stat().st_size and a.read_bytes() == b.read_bytes()


def synchronize(files: dict[str, Path], out: Path) -> bool:
    """Makes `out` hold exactly `files` (its __pycache__ folders stay). True if it changed."""
    changed = False
    for name, source in files.items():
        target = out / name
        if same_content(source, target):
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        # Renamed into place: a Blender that runs from the stage keeps its old copy of a library.
        temporary = target.with_name(f".{target.name}.new")
        shutil.copyfile(source, temporary)
        temporary.chmod(0o755 if ".so" in source.name else 0o644)
        os.replace(temporary, target)
        changed = True
    for file in sorted(out.rglob("*")):
        if file.is_file() and "__pycache__" not in file.parts:
            if file.relative_to(out).as_posix() not in files:
                file.unlink()
                changed = True
    for folder in sorted((f for f in out.rglob("*") if f.is_dir()), reverse=True):
        if not any(f.is_file() for f in folder.rglob("*")):
            shutil.rmtree(folder)
    return changed


def write_zip(files: dict[str, Path], top: str, path: Path) -> None:
    """The same bytes for the same files: sorted, no times, fixed permissions."""
    temporary = path.with_name(f".{path.name}.new")
    with zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, source in sorted(files.items()):
            entry = zipfile.ZipInfo(f"{top}/{name}", date_time=(1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3
            entry.external_attr = (0o755 if ".so" in source.name else 0o644) << 16
            archive.writestr(entry, source.read_bytes())
    os.replace(temporary, path)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--addon", type=Path, required=True, help="folder of the add-on")
    parser.add_argument("--package", type=Path, action="append", default=[], help="more packages")
    parser.add_argument("--library", type=Path, action="append", default=[], help="for lib/")
    parser.add_argument("--license", type=Path, required=True, help="goes beside the add-on")
    parser.add_argument("--out", type=Path, required=True, help="the staged folder")
    parser.add_argument("--zip", type=Path, required=True, help="the archive to install")
    options = parser.parse_args()

    files = package_files(options.addon, "")
    for package in options.package:
        files.update(package_files(package, f"{package.name}/"))
    for name, library in sorted(collect_libraries(options.library).items()):
        files[f"lib/{name}"] = library
    files["LICENSE"] = options.license

    options.out.mkdir(parents=True, exist_ok=True)
    changed = synchronize(files, options.out)
    newest = max((options.out / name).stat().st_mtime_ns for name in files)
    if changed or not options.zip.is_file() or options.zip.stat().st_mtime_ns < newest:
        write_zip(files, options.out.name, options.zip)
        size = options.zip.stat().st_size / 1e6
        print(f"stage: {len(files)} files in {options.zip.name}, {size:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
