# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene as one view layer's render depsgraph shows it, as a model of the backend.

Called inside RenderEngine.render(); keeps no reference to Blender's data afterwards.
"""

import contextlib
import gc
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from itertools import compress
from operator import attrgetter
from typing import Any

import bpy

from ...core.native import lodestone_native as native
from ...core.problems import Problems, Subject
from .. import datablock_ids
from ..datablock_ids import name_of
from ..listed_instances import Listed
from ..motion.motion_sampling import Motion, Still
from ..motion.shutter_motion import Moving
from ..world import scene_lights, world_background
from . import collection_groups, glowing_faces, scene_camera
from .leaf_objects import Leaf, Leaves, override_of
from .material_users import Shown, Users
from .model_parts import Parts
from .ray_visibility import Visibility
from .shown_instances import Instances, report_outside

_TYPE = attrgetter("type")


@dataclass
class Extraction:
    """A model and what went into it. Close the model when done."""

    model: Any
    problems: Problems
    leaves: list[Leaf] = field(default_factory=list)
    shown: int = 0  # instances the depsgraph shows with faces
    lights: int = 0
    parts: Parts = field(default_factory=Parts)
    shown_by: Shown = field(default_factory=Shown)
    moving: list[Moving] = field(default_factory=list)  # the things that an animation moves

    @cached_property
    def users(self) -> dict[Subject, tuple[Subject, ...]]:
        """The objects that show each material."""
        return self.shown_by.found()

    def scope(self, keys: Iterable[datablock_ids.Key] | None) -> list[Any]:
        """The model's objects that these datablocks became; [] (everything) for None."""
        if keys is None:
            return []
        found = {item for key in keys for item in self.parts.get(key, ())}
        return sorted(found, key=lambda item: item.key)


def extract(
    depsgraph: Any,
    tick: Callable[[], None] = lambda: None,
    still: dict[str, list[str]] | None = None,
    structured: bool = True,
    store: str = "",
) -> Extraction:
    """Reads a scene into a model. `tick()` is called between meshes; what it raises stops the
    extraction. `still`: what sample() found out. `structured`: flat collections get groups
    below them, unless the designer wants none. A scene that shows nothing gives a model whose root
    group is empty. `store`: the folder that keeps what was found of pictures; "": none does."""
    with _without_garbage_collection(), _kept_pictures(store):
        return _extract(depsgraph, tick, still, structured, store)


def _extract(
    depsgraph: Any,
    tick: Callable[[], None],
    still: dict[str, list[str]] | None,
    structured: bool,
    store: str,
) -> Extraction:
    scene = depsgraph.scene_eval
    settings = datablock_ids.settings_of(
        depsgraph.scene
    )  # those of the original: writing them tags nothing
    anew = settings is not None and settings.deforming == "FRAME"
    motion = Still() if anew else Motion(still)
    model, problems, uids = native.Model(), Problems(), datablock_ids.Uids()
    try:
        leaves = Leaves(model, depsgraph.scene, uids, problems, override_of(depsgraph))
        walk = walked(depsgraph, leaves, problems, tick, motion)
        tree = collection_groups.Groups(model, uids, walk.roles, motion)
        root = tree.build(walk.found.scene, walk.branch)
        if root is None:
            root = model.add_group(
                uids.claim(datablock_ids.scene_uid(name_of(scene))), name_of(scene)
            )
        model.set_root(root)
        if structured:
            automatic = settings is None or settings.structure == "AUTOMATIC"
            _split_loose_parts(model, leaves, automatic)
            if automatic:
                model.structure(list(tree.collections))
        for name in tree.unplaced:
            report_outside(problems, name)
        surroundings(model, scene, walk.found, problems, store=store)
        _add_cameras(model, depsgraph)
        problems.keep(walk.shown.concerns)
    except BaseException:
        model.close()
        raise
    return Extraction(
        model,
        problems,
        list(leaves),
        walk.found.shown,
        len(walk.found.lights),
        tree.parts,
        walk.shown,
        tree.moving,
    )


def _split_loose_parts(model: Any, leaves: Leaves, automatic: bool) -> None:
    """Meshes of many parts become groups of these, but stay one object each."""
    ways = {"OBJECTS": native.LooseOptions(always=1)}
    if automatic:
        ways[datablock_ids.AUTOMATIC] = native.LooseOptions()
    for way, options in ways.items():
        items = [leaf.object for leaf in leaves if leaf.loose == way]
        if items:
            model.split_loose_parts(items, options)


@contextlib.contextmanager
def _without_garbage_collection() -> Iterator[None]:
    """Ten thousands of objects are kept and none of them in a ring: looking for rings again and
    again takes Python a quarter of the time. Afterwards they count as old, or the next thing that
    is made would have all of them looked through."""
    before = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if before:
            if gc.get_freeze_count() == 0:
                gc.freeze()
                gc.unfreeze()
            gc.enable()


@contextlib.contextmanager
def _kept_pictures(store: str) -> Iterator[None]:
    """Pictures that an earlier reading met are not decoded again."""
    if store:
        native.keep_pictures(store)
    yield
    if store:
        native.keep_pictures(store)


@dataclass
class Walk:
    """A walk through what a depsgraph shows: by where it comes from, by collection, and who shows
    what."""

    found: Instances
    branch: collection_groups.Branch
    shown: Shown
    roles: datablock_ids.Roles


def walked(
    depsgraph: Any,
    leaves: Any,
    problems: Problems,
    tick: Callable[[], None],
    motion: Motion | None = None,
    listed: Listed | None = None,
) -> Walk:
    """`leaves` are Leaves, or what takes their place where nothing is to be extracted; `listed` is
    what takes the place of all that the depsgraph lists."""
    roles = datablock_ids.Roles(depsgraph.scene)  # those of the original: writing them tags nothing
    branch = collection_groups.scene_branch(depsgraph.scene_eval, depsgraph.view_layer_eval, roles)
    users = Users(leaves)
    visibility = Visibility(depsgraph.view_layer_eval, problems)
    found = Instances(users, visibility, roles, motion or Still(), problems, tick)
    found.walk(listed or Listed(depsgraph), collection_groups.environment_objects(branch))
    return Walk(found, branch, users.shown, roles)


def surroundings(
    model: Any,
    scene: Any,
    found: Instances,
    problems: Problems,
    images: Any | None = None,
    store: str = "",
) -> None:
    """Adds the lights that were found, what glows among them, and the world. `images`, `store`: as
    in world_background.extract()."""
    for light, matrix, name in found.lights:
        scene_lights.add(model, light, matrix, name, problems)
    eye = None if scene.camera is None else scene.camera.matrix_world.translation
    most = max(0, glowing_faces.MOST_LIGHTS - len(found.lights))
    for light in found.glows.lights(eye, problems, most):
        model.add_light(light)
    around = world_background.extract(model, scene.world, problems, images, store)
    model.set_world(
        around.color,
        scene.render.film_transparent,
        around.environment,
        around.turn,
        around.strength,
    )


def _cameras(scene: Any) -> list[Any]:
    """The scene's own camera, then the others by name."""
    own = scene.camera
    if own is not None and own.type == "CAMERA" and sum(c.users for c in bpy.data.cameras) == 1:
        return [own]  # nobody else uses one: no need to look through all objects
    objects = scene.objects[:]
    items = list(compress(objects, map("CAMERA".__eq__, map(_TYPE, objects))))
    return sorted(items, key=lambda item: (item != own, name_of(item)))


def _add_cameras(model: Any, depsgraph: Any) -> None:
    """All of the scene, its own one first, for programs that render the store. Problems of one are
    told when it is used."""
    scene = depsgraph.scene  # the original: an evaluated scene's objects are originals as well
    frame = scene_camera.Frame.of(depsgraph.scene_eval.render)
    for item in _cameras(scene):
        item = item.evaluated_get(depsgraph)
        matrix = item.matrix_world
        if all(math.isfinite(value) for row in matrix for value in row):
            with contextlib.suppress(native.LodestoneError):  # such as one of no size
                model.add_camera(scene_camera.extract(item, frame, Problems()))
