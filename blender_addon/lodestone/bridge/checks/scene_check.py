# SPDX-License-Identifier: GPL-3.0-or-later
"""Check Scene: what F12 would report of a scene, without a render and without reading a mesh.

It takes the way of the extraction (shown_instances.py, materials.py, ...) with a stand-in
for the leaves and one for the model, so that there is one set of rules. It walks the depsgraph of
the viewport, less what renders hide; what only renders show is added as it is stored.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import compress
from operator import attrgetter
from typing import Any

from ...core.problems import Problems
from ...core.session.last_check import Check
from ..listed_instances import Listed, Rows, by_itself, rows
from ..nodes.image_means import ImageHeads
from ..nodes.materials import Materials
from ..scene import hair_strands, quality_lenses, scene_camera, scene_extraction
from ..scene.glowing_faces import Glow, glow_of
from ..scene.leaf_objects import material_slots, override_of
from . import picture_requirements

_ORIGINAL = attrgetter("original")


def check(
    original: Any,
    view_layer: Any,
    depsgraph: Any,
    problems: Problems,
    tick: Callable[[], None] = lambda: None,
) -> Check:
    """The check of an original scene as the view layers show it that a render would draw;
    `view_layer` is the current one, which `depsgraph` is of. `problems` are those known already."""
    recorder, heads = Recorder(), ImageHeads()
    shown = Shown(depsgraph, rendered_objects(rendered_layers(original, view_layer)))
    evaluated = depsgraph.scene_eval
    override = override_of(depsgraph)
    glances = Glances(Materials(None, problems, frame=original.frame_current), override)
    walk = scene_extraction.walked(depsgraph, glances, problems, tick, None, shown)
    scene_extraction.surroundings(recorder, evaluated, walk.found, problems, heads)
    if walk.found.shown == 0:
        picture_requirements.something(original, problems)
    eye = picture_requirements.camera(evaluated, problems)
    if eye is not None:
        scene_camera.extract(eye, scene_camera.Frame.of(evaluated.render), problems)
    scene_camera.report_render(evaluated, problems)
    problems.keep(walk.shown.concerns)
    quality_lenses.detail(evaluated.objects, lambda collection: (), problems)
    return Check(tuple(problems), walk.shown.found())


class Recorder:
    """Stands where a model is filled: takes everything, keeps nothing, numbers what it is given."""

    def __init__(self) -> None:
        self._given = -1

    def __getattr__(self, name: str) -> Callable[..., int]:
        if name.startswith("_"):
            raise AttributeError(name)
        return self._take

    def _take(self, *_: Any, **__: Any) -> int:
        self._given += 1
        return self._given


@dataclass(frozen=True, eq=False)
class Glance:
    """A stand-in for a leaf."""

    glow: Glow | None
    deforms = False
    settled = True


class Glances:
    """Stands where Leaves does: translates materials, looks at most at whether there are faces."""

    def __init__(self, materials: Materials, override: Any = None) -> None:
        self._materials = materials
        self.override = override
        self._found: dict[tuple, Any] = {}

    def leaf(self, shown: Any, *_: Any) -> Any | None:
        """Stands for Leaves.leaf(): None when there is nothing to draw."""
        slots = material_slots(shown, self.override)
        key = (shown.data, *slots)
        if key not in self._found:
            self._found[key] = self._look(shown, slots)
        return self._found[key]

    def hair(self, shown: Any, owner: Any, *how: Any) -> Any | None:
        """Stands for Leaves.hair(). The viewport may show fewer hairs, but none where there are
        some."""
        drawn = any(
            hair_strands.drawn_particles(m.particle_system)
            for m in hair_strands.hair_modifiers(shown)
        )
        return self._of_materials(shown) if drawn else None

    def point(self, shown: Any, owner: Any, *how: Any) -> Any:
        return self._of_materials(shown)

    def _of_materials(self, shown: Any, slots: list[Any] | None = None) -> Any:
        faces = slots is not None
        slots = material_slots(shown, self.override) if slots is None else slots
        for material in slots:
            self._materials.index(material)
        looks = map(self._materials.look, slots)
        return Glance(glow_of(shown, slots, looks, faces))

    def _look(self, shown: Any, slots: list[Any]) -> Any | None:
        if shown.type == "MESH" and not _has_faces(shown):
            return None
        if shown.type == "CURVES" and not len(shown.data.curves):
            return None
        return self._of_materials(shown, slots)


def _has_faces(shown: Any) -> bool:
    # In Edit Mode the evaluated mesh is still BMesh and seems empty
    return len(shown.data.polygons) > 0 or shown.mode == "EDIT"


class Shown(Listed):
    """The instances that a viewport's depsgraph lists, as if it were that of a render."""

    def __init__(self, depsgraph: Any, rendered: dict[Any, Any]) -> None:
        """`rendered`: see rendered_objects()."""
        super().__init__(depsgraph)
        self._rendered = rendered
        self._met: set[Any] = set()  # originals of what the depsgraph shows
        self._stored: list[Any] = []  # transforms of what is added, by -1 - its number

    def __iter__(self) -> Iterator[tuple[int, Any]]:
        rendered, met = self._rendered, self._met
        for number, instance in super().__iter__():
            if instance.is_instance:
                host = instance.parent.original
                if host not in rendered or self._hidden(instance, host):
                    continue
                met.add(host)
            else:
                original = instance.object.original
                if original not in rendered:
                    continue
                met.add(original)
            yield number, instance
        seen: set[int] = set()
        for original, item in rendered.items():
            if original not in met:
                for instance in _as_stored(item, seen):
                    self._stored.append(instance.matrix_world)
                    yield -len(self._stored), instance

    def objects(self) -> tuple[Sequence[int], list[Any]]:
        numbers, objects = super().objects()
        originals = list(map(_ORIGINAL, objects))
        kept = list(map(self._rendered.__contains__, originals))
        self._met.update(compress(originals, kept))
        return list(compress(numbers, kept)), list(compress(objects, kept))

    def place(self, number: int) -> Rows | None:
        if number >= 0:
            return super().place(number)
        place = rows(self._stored[-1 - number])
        return place if math.isfinite(sum(place)) else None

    def _hidden(self, instance: Any, host: Any) -> bool:
        """Whether a member of an instanced collection is left out of renders."""
        if host.instance_type != "COLLECTION" or host.instance_collection is None:
            return False
        return instance.instance_object.original.hide_render


def _as_stored(item: Any, seen: set[int]) -> Iterator[Any]:
    """Instances of an object that only renders show, from its stored data: without modifiers. Each
    collection once, in however many places it is: `seen` holds those that were."""
    yield by_itself(item)
    collection = item.instance_collection if item.instance_type == "COLLECTION" else None
    if collection is not None and collection.as_pointer() not in seen:
        seen.add(collection.as_pointer())
        for member in collection.all_objects:
            if not member.hide_render:
                yield from _as_stored(member, seen)


def rendered_layers(original: Any, view_layer: Any) -> list[Any]:
    """The view layers that a render started in `view_layer` draws."""
    chosen = [layer for layer in original.view_layers if layer.use]
    return [view_layer] if original.render.use_single_layer or not chosen else chosen


def rendered_objects(layers: list[Any]) -> dict[Any, Any]:
    """The view layers' own objects that a render shows, by themselves, in order."""
    found: dict[Any, Any] = {}

    def walk(layer: Any) -> None:
        if layer.collection.hide_render:
            return
        if not layer.exclude:
            for item in layer.collection.objects:
                if not item.hide_render:
                    found[item] = item
        for child in layer.children:
            walk(child)

    for view_layer in layers:
        walk(view_layer.layer_collection)
    return found
