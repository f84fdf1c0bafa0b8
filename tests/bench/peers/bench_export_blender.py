# SPDX-License-Identifier: GPL-3.0-or-later
"""The half of bench_export.py inside Blender: exports the open file once and says what it took.

    blender -b --factory-startup FILE --python bench_export_blender.py -- KIND FOLDER JSON ADDONS

KIND is `bundled` (Blender's render_povray) or `lodestone` (of the folder ADDONS). Both are enabled
and loaded before anything is measured.
"""

import json
import resource
import sys
import time
from pathlib import Path

import bpy


def cpu_seconds() -> float:
    """User and system, all threads."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def forget_peak() -> None:
    try:
        Path("/proc/self/clear_refs").write_text("5")
    except OSError:
        pass  # then the peak is that since Blender started


def memory(field: str) -> int:
    """Bytes: `VmRSS` now, `VmHWM` at the peak."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(field + ":"):
            return 1024 * int(line.split()[1])
    return 0


def bundled(folder: Path) -> dict:
    bpy.ops.preferences.addon_enable(module="render_povray")
    import render_povray.render as addon

    scene = bpy.context.scene
    scene.render.engine = "POVRAY_RENDER"
    scene.pov.tempfiles_enable = True  # as it is: no comments, no indentation
    target = folder / "scene.pov"
    before = memory("VmRSS")
    forget_peak()
    start = cpu_seconds()
    addon.write_pov(str(target), scene, None)
    return {
        "cpu_s": cpu_seconds() - start,
        "memory_bytes": memory("VmHWM") - before,
        "bytes": target.stat().st_size,
    }


def lodestone(folder: Path, addons: Path) -> dict:
    """Extraction and export of one picture at full detail, as at Pixel Error 0; then the same
    again, as the next frame of an animation in which nothing changes does. What Blender takes to
    make the depsgraph that render() is given counts for neither add-on, and is told apart."""
    sys.path.insert(0, str(addons))
    import lodestone as addon

    addon.register()
    from lodestone.bridge.scene import scene_extraction as extraction
    from lodestone.core.native import lodestone_native as native
    from lodestone.core.picture.picture_maker import Settings, cut_and_export
    from lodestone.engines import extract_engine

    native.version()  # loads the library
    spent, before = 0.0, 0
    extract = extraction.extract

    def clocked(*arguments):
        nonlocal spent, before
        before = memory("VmRSS")
        forget_peak()
        start = cpu_seconds()
        try:
            return extract(*arguments)
        finally:
            spent = cpu_seconds() - start

    extraction.extract = clocked
    found = {}
    for name in ("first", "second"):
        request = extract_engine.Request(cameras=[("", None)], structured=False)
        start = cpu_seconds()
        made = extract_engine.extract_now(bpy.context.scene, request)
        whole = cpu_seconds() - start
        with made.model as model:
            totals = model.totals()
            view, size = request.frames[0]
            start = cpu_seconds()
            settings = Settings(pixel_error=0.0)
            parts, _ = cut_and_export(model, view, size, settings, folder, native.Job())
            written = cpu_seconds() - start
        found[name] = {
            "cpu_s": spent + written,
            "extract_cpu_s": spent,
            "write_cpu_s": written,
            "depsgraph_cpu_s": whole - spent,
            "memory_bytes": memory("VmHWM") - before,
            "bytes": parts["export"]["bytes"],
            "files": parts["export"]["files"],
            "files_written": parts["export"]["written"],
        }
    first = found["first"]
    first["triangles"] = totals.triangles_unique
    first["occurrences"] = totals.occurrences
    first["second_frame"] = found["second"]
    return first


def main() -> None:
    kind, folder, out, addons = sys.argv[sys.argv.index("--") + 1 :]
    began = time.monotonic()
    target = Path(folder)
    target.mkdir(parents=True)
    made = bundled(target) if kind == "bundled" else lodestone(target, Path(addons))
    made["wall_s"] = time.monotonic() - began
    Path(out).write_text(json.dumps(made), "utf-8")


main()
