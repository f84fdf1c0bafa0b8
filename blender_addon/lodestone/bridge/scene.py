# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene as one view layer's render depsgraph shows it, as a model of the backend.

Called inside RenderEngine.render(); keeps no reference to Blender's data afterwards.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

from ..core.native import lodestone_native as native
from ..core.problems import Problems
from . import groups, ids, lights, world
from .instances import Instances, report_outside
from .leaves import Leaf, Leaves


@dataclass
class Extraction:
    """A model and what went into it. Close the model when done."""

    model: Any
    problems: Problems
    leaves: list[Leaf] = field(default_factory=list)
    shown: int = 0  # instances the depsgraph shows with faces
    lights: int = 0
    parts: dict[ids.Key, set[Any]] = field(default_factory=dict)

    def scope(self, keys: Iterable[ids.Key] | None) -> list[Any]:
        """The model's objects that these datablocks became; [] (everything) for None."""
        if keys is None:
            return []
        found = {item for key in keys for item in self.parts.get(key, ())}
        return sorted(found, key=lambda item: item.key)


def extract(depsgraph: Any, tick: Callable[[], None] = lambda: None) -> Extraction:
    """`tick()` is called between meshes; what it raises stops the extraction. A scene that shows
    nothing gives a model whose root group is empty."""
    scene, view_layer = depsgraph.scene_eval, depsgraph.view_layer_eval
    model, problems, uids = native.Model(), Problems(), ids.Uids()
    try:
        leaves = Leaves(model, depsgraph.scene, uids, problems)
        branch = groups.scene_branch(scene, view_layer)
        found = Instances(leaves, problems, tick)
        found.walk(depsgraph, groups.environment_objects(branch))
        tree = groups.Groups(model, uids)
        root = tree.build(found.scene, branch)
        if root is None:
            root = model.add_group(uids.claim(ids.scene_uid(scene.name)), scene.name)
        model.set_root(root)
        for name in tree.unplaced:
            report_outside(problems, name)
        for light, matrix, name in found.lights:
            lights.add(model, light, matrix, name, problems)
        model.set_world(world.color(scene.world, problems), scene.render.film_transparent)
    except BaseException:
        model.close()
        raise
    lit = len(found.lights)
    return Extraction(model, problems, list(leaves), found.shown, lit, dict(tree.parts))
