# SPDX-License-Identifier: GPL-3.0-or-later
"""The floors: who may include or import what. Every function returns sentences, empty = right."""

import ast
import re
from pathlib import Path

# From the ground up. A file may include its own floor and those before it.
FLOORS = (
    "base",
    "model",
    "image",
    "geometry",
    "ray",
    "measure",
    "format",
    "simplify",
    "deform",
    "solids",
    "cards",
    "prune",
    "group",
    "choose",
    "light",
    "segment",
    "view",
    "hierarchy",
    "povray_export",
    "capi",
)

# Third-party headers: (what the name begins with, the only files of ours that may see it).
THIRD_PARTY = (
    (r"embree\d?/|[a-z]+mmintrin\.h|immintrin\.h", r"backend/src/ray/"),
    (
        r"(lib)?png|jpeglib|jerror|turbojpeg|OpenEXR/|Imf|Imath|Iex|IlmThread|half",
        r"backend/src/image/",
    ),
    (r"tiny_?gltf|stb|meshoptimizer", r"backend/src/format/"),
    (r"(tbb|oneapi)/", r"backend/src/base/parallel\.cpp$"),
    (r"OpenMesh/", r"backend/src/geometry/repair"),
    (r"curl/", r"backend/src/segment/fetch"),
    (r"nlohmann/", r".*\.cpp$|backend/src/segment/json_values\.h$"),
    (r"glm/", r"(backend/src|povray_export)/"),
)

# Headers of one folder's .cpp files alone, which may show them a library.
FOLDER_HEADERS = ("segment/json_values.h", "segment/store_payloads.h")

STANDARD_C = (
    "assert ctype dlfcn errno fcntl float inttypes limits locale malloc math poll pwd sched setjmp "
    "signal spawn stdarg stdbool stddef stdint stdio stdlib string strings time unistd"
).split()

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)[">]', re.MULTILINE)

# Add-on modules from the ground up; everything else of the add-on stands on top.
ADDON_FLOORS = ("lodestone_native", "core", "bridge")
# The rooms of a floor, from the ground up; "" are the files of the floor itself, which serve all.
ADDON_ROOMS = {
    "core": ("", "expression", "store", "picture", "preview", "batch", "session"),
    "bridge": ("", "motion", "nodes", "world", "scene", "checks", "live"),
}
# Those on top, where Blender's own classes are.
TOP_ROOMS = ("", "properties", "viewport", "engines", "operators", "panels", "batch_blender")
BLENDER_MODULES = ("bpy", "bpy_extras", "bmesh", "mathutils", "gpu", "gpu_extras", "bl_ui", "blf")


def is_standard(header: str) -> bool:
    if re.fullmatch(r"[a-z_0-9]+", header) or header.startswith("sys/"):
        return True
    return header.endswith(".h") and header[:-2] in STANDARD_C


def floor_of(name: str) -> str | None:
    """The floor of a C++ file of the backend; None for tools, tests and the public header."""
    parts = name.split("/")
    if parts[:2] == ["backend", "src"] and len(parts) > 3:
        return parts[2]
    return "povray_export" if parts[0] == "povray_export" else None


def check_own_include(name: str, header: str, root: Path) -> str | None:
    """What is wrong with `#include "header"` in the file `name`, if anything."""
    floor = floor_of(name)
    if ".." in header.split("/"):
        return f'{name}: "{header}" climbs out of its folder; name the floor instead'
    if header == "lodestone/lodestone.h":
        sees_it = floor == "capi" or name.startswith(("backend/tools/", "tests/"))
        return None if sees_it else f"{name}: only capi and tools see the C interface"
    if (root / name).parent.joinpath(header).is_file() and "/" not in header:
        return None
    if floor is None:
        return f'{name}: may include lodestone/lodestone.h and its own folder only, not "{header}"'
    target = header.split("/")[0]
    if target not in FLOORS or "/" not in header:
        return f'{name}: "{header}" is on no floor'
    if header in FOLDER_HEADERS and target != floor:
        return f'{name}: "{header}" is for the files of its own folder only'
    if FLOORS.index(target) > FLOORS.index(floor):
        return f'{name}: "{header}" is above {floor}'
    return None


def check_foreign_include(name: str, header: str) -> str | None:
    """What is wrong with `#include <header>` in the file `name`, if anything."""
    if is_standard(header):
        return None
    for pattern, where in THIRD_PARTY:
        if re.match(pattern, header):
            if not re.match(where, name):
                return f"{name}: may not see <{header}>"
            ours_alone = name.removeprefix("backend/src/") in FOLDER_HEADERS
            if name.endswith(".h") and not header.startswith("glm/") and not ours_alone:
                return f"{name}: <{header}> does not belong in a header; move it to the .cpp"
            return None
    return f"{name}: <{header}> is a library that no rule of check_layers.py allows"


def check_cpp(name: str, text: str, root: Path) -> list[str]:
    """All wrong includes of one C or C++ file below backend/, povray_export/ or tests/capi/."""
    floor = floor_of(name)
    if floor is not None and floor not in FLOORS:
        return [f"{name}: backend/src/{floor} is no floor of the design"]
    found = []
    for mark, header in INCLUDE.findall(text):
        if mark == '"':
            found.append(check_own_include(name, header, root))
        elif name.startswith("tests/"):
            continue
        else:
            found.append(check_foreign_include(name, header))
    return [sentence for sentence in found if sentence]


def imported_modules(name: str, text: str) -> list[str]:
    """Absolute dotted names of everything a Python file imports, anywhere in it.

    Relative imports are resolved from the folder of the file, whose top package is `lodestone`
    for the add-on and `lodestone_native` for the binding.
    """
    package = list(Path(name).parent.parts)
    for start in (["blender_addon"], ["backend", "python"]):
        if package[: len(start)] == start:
            package = package[len(start) :]
    found = []
    for node in ast.walk(ast.parse(text, name)):
        if isinstance(node, ast.Import):
            found += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            prefix = ".".join(base + ([node.module] if node.module else []))
            found += [f"{prefix}.{alias.name}" for alias in node.names]
    return found


def addon_height(module: str) -> tuple[int, int]:
    """Floor of a dotted module name of the add-on, 0 the binding ... 3 the panels, and its room."""
    parts = module.split(".")
    if parts[0] == "lodestone_native":
        return (0, 0)
    floor = parts[1] if len(parts) > 1 else ""
    if floor not in ADDON_FLOORS:
        return (len(ADDON_FLOORS), TOP_ROOMS.index(floor) if floor in TOP_ROOMS else 0)
    rooms = ADDON_ROOMS.get(floor, ("",))
    room = parts[2] if len(parts) > 2 else ""
    return (ADDON_FLOORS.index(floor), rooms.index(room) if room in rooms else 0)


def unknown_room(name: str) -> str | None:
    """The folder of a file of the add-on, when it is no room that has a height."""
    if not name.startswith("blender_addon/lodestone/"):
        return None
    parts = name.removeprefix("blender_addon/lodestone/").split("/")
    if len(parts) > 1 and parts[0] not in (*ADDON_FLOORS, *TOP_ROOMS):
        return parts[0]
    known = ADDON_ROOMS.get(parts[0])
    folder = parts[1] if len(parts) > 2 else ""
    return folder if known is not None and folder not in known else None


def check_python(name: str, text: str) -> list[str]:
    """All wrong imports of one Python file of the add-on or the binding."""
    own = name.removeprefix("blender_addon/").removeprefix("backend/python/")
    height = addon_height(own.removesuffix(".py").replace("/", "."))
    found = []
    room = unknown_room(name)
    if room is not None:
        found.append(f"{name}: {room} is no room of check_layers.py")
    for module in imported_modules(name, text):
        top = module.split(".")[0]
        if top == "numpy":
            found.append(f"{name}: imports numpy, which Debian's Blender does not bring")
        elif top in BLENDER_MODULES and height[0] < ADDON_FLOORS.index("bridge"):
            found.append(f"{name}: imports {top}; bpy does not appear below bridge")
        elif top in ("lodestone", "lodestone_native") and addon_height(module) > height:
            found.append(f"{name}: imports {module}, which is above it")
    return found


def check_tree(root: Path, names: list[str]) -> list[str]:
    """All broken rules in these files (relative to root)."""
    found = []
    for name in names:
        cpp_places = ("backend/src/", "backend/tools/", "backend/include/", "povray_export/")
        if name.endswith((".h", ".cpp", ".c")) and name.startswith((*cpp_places, "tests/capi/")):
            found += check_cpp(name, (root / name).read_text(encoding="utf-8"), root)
        if name.endswith(".py") and name.startswith(
            ("blender_addon/lodestone/", "backend/python/")
        ):
            found += check_python(name, (root / name).read_text(encoding="utf-8"))
    return found
