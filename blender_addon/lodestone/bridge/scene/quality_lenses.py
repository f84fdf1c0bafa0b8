# SPDX-License-Identifier: GPL-3.0-or-later
"""The lenses that bend quality, from Blender: detail lenses are Empties, screen lenses and depth
are the camera's."""

import math
from collections.abc import Callable, Iterable
from typing import Any

from ...core.native import lodestone_native as native
from ...core.problems import WARNING, Problems
from .. import datablock_ids, quality_settings
from ..datablock_ids import name_of
from ..listed_instances import rows
from . import scene_camera as cameras

DISPLAY = {"SPHERE": native.LensShape.SPHERE, "CUBE": native.LensShape.BOX}
MOST = 1024  # the backend takes no more
MOST_FILTERED = 64

# The model's objects that a collection became
PartsOf = Callable[[Any], Iterable[Any]]


def is_lens(item: Any) -> bool:
    if item.type != "EMPTY" or not datablock_ids.has_settings(item):
        return False
    return item.lodestone.lens.enabled


def detail(
    objects: Iterable[Any], parts_of: PartsOf, problems: Problems
) -> tuple[native.Lens, ...]:
    """The detail lenses among these objects (evaluated, or originals for the viewport's state) that
    renders see, in their order; what makes no sense is left out and named."""
    found: list[native.Lens] = []
    filtered, too_many = 0, 0
    for item in objects:
        if item.type != "EMPTY":
            continue
        # The evaluated ones count: an animation being rendered writes no keys into originals
        if not is_lens(item) or item.hide_render:
            continue
        lens = item.lodestone.lens
        listed = lens.filter != "ALL"
        if listed and lens.collection is None:
            text = f'Lens "{name_of(item)}" works on a collection, but none is chosen'
            problems.add(name_of(item), WARNING, "lens_without_collection", text, "object")
            continue
        place = rows(item.matrix_world)
        if not all(map(math.isfinite, place)):
            text = f'Lens "{name_of(item)}" has no finite place'
            problems.add(name_of(item), WARNING, "lens_not_finite", text, "object")
            continue
        if len(found) >= MOST or (listed and filtered >= MOST_FILTERED):
            too_many += 1
            continue
        filtered += listed
        found.append(
            native.Lens(
                name=name_of(item),
                transform=tuple(place),
                shape=DISPLAY.get(item.empty_display_type, native.LensShape.SPHERE),
                radius=item.empty_display_size,
                strength=lens.strength,
                falloff=lens.falloff,
                filter=native.LensFilter[lens.filter],
                objects=tuple(parts_of(lens.collection)) if listed else (),
            )
        )
    if too_many:
        text = (
            f"{too_many:,} detail lenses have no effect: at most {MOST:,} count, "
            f"{MOST_FILTERED} of them with a collection"
        )
        problems.add("", WARNING, "lenses_too_many", text)
    return tuple(found)


def screen(camera: Any) -> tuple[native.ScreenLens, ...]:
    """The screen lenses of a camera object (as in detail()); as many as the backend takes."""
    settings = datablock_ids.settings_of(camera.data)
    if settings is None:
        return ()
    used = [lens for lens in settings.screen_lenses if lens.enabled]
    return tuple(
        native.ScreenLens(
            name=name_of(lens),
            center=(lens.x, 1.0 - lens.y),
            radius=lens.radius,
            strength=lens.strength,
            falloff=lens.falloff,
        )
        for lens in used[:MOST]
    )


def modifiers(
    settings: Any, lenses: tuple[native.Lens, ...], camera: Any, closing: Any | None = None
) -> native.Modifiers | None:
    """All that bends the quality of a picture: SceneSettings, the scene's detail lenses and what a
    camera object has; None: nothing does. `closing`: the camera as the shutter closes, None: it
    rests."""
    screen_lenses = screen(camera)
    own = datablock_ids.settings_of(camera.data)
    depth = 1.0 if own is None else own.depth_exaggeration
    coarser = quality_settings.is_coarser_moving_dark(settings)
    ray_classes = quality_settings.ray_classes(settings)
    bent = native.Modifiers(
        lenses=lenses,
        screen_lenses=screen_lenses,
        depth=depth,
        depth_focus=cameras.focus_distance(camera) if depth != 1.0 else 10.0,
        when_moving=coarser,
        when_dark=coarser,
        closing=closing if coarser else None,
        off_screen=native.OffScreen[settings.off_screen],
        ray_classes=ray_classes,
    )
    return None if bent == native.Modifiers() else bent


def parts_in(extraction: Any) -> PartsOf:
    """A function that gives a collection's parts of a scene that was read: anything with its
    `parts`."""

    def parts_of(collection: Any) -> Iterable[Any]:
        return extraction.parts.get(datablock_ids.key_of("collection", collection), ())

    return parts_of


def parts_stored(model: Any) -> PartsOf:
    """A function that gives a collection's parts of a model that was read from a store."""

    def parts_of(collection: Any) -> Iterable[Any]:
        found = model.find_object(datablock_ids.uid_of("collection", collection))
        return () if found is None else (found,)

    return parts_of
