# SPDX-License-Identifier: GPL-3.0-or-later
"""The requirements of a picture besides the scene: a camera, POV-Ray, a folder, the libraries."""

import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from ...core.native import lodestone_native as native
from ...core.problems import ERROR, INFO, WARNING, Problems
from ...core.store import store_path
from ..datablock_ids import name_of
from ..scene.leaf_objects import DRAWN, GREASE_PENCIL

NO_CAMERA = 'Scene "{}" has no camera: add one, or choose one in Scene > Camera'
NOTHING = "Nothing to render: no object with faces is visible in renders"
NOTHING_HERE = "A picture shows the world alone: no object with faces is visible in it"


def camera(scene: Any, problems: Problems) -> Any | None:
    """The scene's camera object, or a problem."""
    found = scene.camera
    if found is None or found.type != "CAMERA":
        problems.add("", ERROR, "no_camera", NO_CAMERA.format(name_of(scene)))
        return None
    return found


def something(scene: Any, problems: Problems) -> bool:
    """Whether a picture of the world alone may be meant by a view layer's frame that shows nothing,
    since objects of the scene could be seen in another frame or layer. Either is told."""
    kinds = {*DRAWN, GREASE_PENCIL}
    if any(item.type in kinds or item.instance_type != "NONE" for item in scene.objects):
        problems.add("", WARNING, "nothing_shown", NOTHING_HERE)
        return True
    problems.add("", ERROR, "nothing_to_render", NOTHING)
    return False


def post_processing(scene: Any, problems: Problems) -> None:
    """Names what Blender does to a finished picture, and nobody does to those of batch jobs."""
    render, name = scene.render, name_of(scene)
    if render.use_compositing and scene.use_nodes:
        text = f'The compositor of scene "{name}" is left out: it works in F12 alone'
        problems.add(name, WARNING, "compositor", text)
    if render.use_sequencer and scene.sequence_editor and scene.sequence_editor.sequences:
        text = f'The sequencer of scene "{name}" is left out: it works in F12 alone'
        problems.add(name, WARNING, "sequencer", text)


def grease_pencil(problems: Problems) -> None:
    """Names grease pencil where Blender draws nothing over the picture: it is left out."""
    for name in [item.object for item in problems if item.code == "grease_pencil"]:
        text = f'Object "{name}" is left out: grease pencil cannot be drawn'
        problems.add(name, ERROR, "object_kind", text)


def povray(program: str, problems: Problems) -> None:
    """Looks for POV-Ray; `program` as in the preferences."""
    try:
        native.povray_find(program or None)
    except native.LodestoneError as error:
        problems.add("", ERROR, "povray_missing", str(error))


def folder(store: Path, problems: Problems) -> None:
    """Looks at the folder where levels and scene files go."""
    for needed in (store, store.parent):  # the scene files lie beside the levels
        if not store_path.writable(needed):
            text = f"Cannot write into {needed}: levels and scene files have no place"
            problems.add("", ERROR, "folder_unwritable", text)
            return


def names(data: Any, problems: Problems) -> None:
    """Looks for names that cannot be read; `data` is Blender's."""
    for item in unreadable(data):
        name_unreadable(item, problems)


def unreadable(data: Any) -> Iterator[Any]:
    """Datablocks whose names are bytes that are no UTF-8."""
    for item in datablocks(data):
        try:
            item.name
        except UnicodeDecodeError:
            yield item


def name_unreadable(item: Any, problems: Problems) -> None:
    name = name_of(item)
    text = f'"{name}" has a name that is not valid text (UTF-8) in the file'
    problems.add(name, INFO, "unreadable_name", text)


def datablocks(data: Any) -> Iterator[Any]:
    for value in data.bl_rna.properties:
        if value.type == "COLLECTION":
            yield from getattr(data, value.identifier)


def libraries(found: Iterable[Any], blend: str, problems: Problems) -> None:
    """Looks for libraries that are missing. `blend` is the path of the open file, to which Blender
    keeps library paths relative."""
    for library in found:
        path = library.filepath
        if path.startswith("//"):
            path = os.path.join(os.path.dirname(blend), path[2:])
        if not os.path.exists(path):
            text = f'Library "{name_of(library)}" is missing ({path}): what it holds is left out'
            problems.add(name_of(library), ERROR, "library_missing", text)
