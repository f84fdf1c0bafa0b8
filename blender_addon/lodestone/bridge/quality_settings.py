# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene's controls of quality, between its settings and core/picture/quality_tree.py."""

from typing import Any

from ..core.picture import quality_tree, unseen_detail

AUTOMATIC = "AUTOMATIC"  # the Antialiasing that inherits
OWN = "own_"  # the prefix of a stored number: below 0 the control inherits


def overrides(settings: Any) -> dict[str, quality_tree.Value]:
    """The overrides of `scene.lodestone` (or SceneSettings), by key: controls that do not
    inherit."""
    found: dict[str, quality_tree.Value] = {}
    for control in quality_tree.CONTROLS:
        if control.least is None:
            value = getattr(settings, control.key)
            if value != AUTOMATIC:
                found[control.key] = value
        elif getattr(settings, OWN + control.key) >= 0:
            found[control.key] = getattr(settings, OWN + control.key)
    return found


def pixel_error(settings: Any) -> float:
    """The Pixel Error of renders: 0, the originals, where Levels of Detail are switched off."""
    return settings.pixel_error_render if settings.use_levels else 0.0


def of_scene(settings: Any) -> quality_tree.Quality:
    """The quality that a render is made with."""
    return quality_tree.quality(pixel_error(settings), overrides(settings))


def budget(settings: Any) -> int:
    """The budget of renders, in bytes; 0: none."""
    return settings.budget_render * 1_000_000 if settings.use_levels else 0


def is_exact(settings: Any) -> bool:
    """Whether renders draw the originals alone."""
    return pixel_error(settings) == 0.0 and not budget(settings)


def is_coarser_moving_dark(settings: Any) -> bool:
    """Whether what moves or lies in the dark is drawn coarser."""
    return settings.use_levels and settings.coarser_moving_dark


def ray_classes(settings: Any) -> int:
    """The ray classes of renders, as native.Rays: those that may meet coarser levels than the
    camera's."""
    if not settings.use_levels:
        return 0
    return unseen_detail.mask(
        one.key for one in unseen_detail.CLASSES if getattr(settings, one.key)
    )


def override(settings: Any, key: str, value: quality_tree.Value) -> None:
    """Gives a control a value of its own."""
    control = quality_tree.CONTROL[key]
    setattr(settings, key if control.least is None else OWN + key, value)


def inherit(settings: Any, key: str) -> None:
    """Takes an override back."""
    control = quality_tree.CONTROL[key]
    settings.property_unset(key if control.least is None else OWN + key)


def inherited_word(settings: Any, key: str) -> str:
    """The text in the panel for the value that a control would have."""
    value = quality_tree.inherits(key, pixel_error(settings), overrides(settings))
    if isinstance(value, str):
        return value.title()
    unit = quality_tree.CONTROL[key].unit
    number = f"{value:.2f}" if isinstance(value, float) else str(value)
    return f"{number} {unit}".strip()
