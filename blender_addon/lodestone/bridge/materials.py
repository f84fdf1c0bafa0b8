# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender materials as the backend's: base color, roughness, metallic, specular, emission.

What cannot be said exactly gets the nearest thing that can, and a problem naming the material:
nothing turns grey silently.
"""

from dataclasses import asdict, dataclass, replace
from typing import Any

from . import compat, ids
from ..core.problems import WARNING, Problems
from .images import ImageMeans
from .node_values import NodeValues

_TRANSPARENT = {"BSDF_TRANSPARENT", "HOLDOUT"}
_GLASS = {"BSDF_GLASS", "BSDF_REFRACTION", "BSDF_TRANSLUCENT"}
_GLOSSY = {"BSDF_GLOSSY", "BSDF_ANISOTROPIC"}
_MAX_DEPTH = 32

# Principled inputs beyond what is translated: names, the value that means "off", code, words
_IGNORED = (
    (("Subsurface", "Subsurface Weight"), 0.0, "subsurface", "subsurface scattering"),
    (("Clearcoat", "Coat Weight"), 0.0, "clearcoat", "clearcoat"),
    (("Sheen", "Sheen Weight"), 0.0, "sheen", "sheen"),
    (("Anisotropic",), 0.0, "anisotropic", "anisotropic highlights"),
    (("Normal",), None, "normal_map", "normal or bump mapping"),
)


@dataclass(frozen=True)
class Surface:
    """What the backend's material holds, without its name."""

    base_color: tuple[float, float, float] = (0.8, 0.8, 0.8)
    roughness: float = 0.5
    metallic: float = 0.0
    specular: float = 0.5
    emission: tuple[float, float, float] = (0.0, 0.0, 0.0)


DEFAULT = Surface(roughness=0.4)  # Blender's own for an empty slot


class Materials:
    """Adds each material once to a model; remembers what it could not say exactly."""

    def __init__(self, model: Any, problems: Problems, images: ImageMeans | None = None) -> None:
        self._model = model
        self._problems = problems
        self._images = images or ImageMeans()
        self._indices: dict[tuple, int] = {}
        self._textured: set[int] = set()

    def index(self, material: Any | None, object_color: tuple | None = None) -> int:
        """The model's index of an evaluated material, or of Blender's default for None.
        `object_color`: of the objects it is drawn on, when its nodes ask for it."""
        key = (0 if material is None else material.as_pointer(), object_color)
        if key not in self._indices:
            surface = DEFAULT if material is None else self.translate(material, object_color)
            self._indices[key] = self._model.add_material(
                "" if material is None else material.name, **asdict(surface)
            )
        return self._indices[key]

    def textured(self, material: Any | None) -> bool:
        """True when index() found an image behind it: its meshes keep their uvs."""
        return material is not None and material.as_pointer() in self._textured

    def translate(self, material: Any, object_color: tuple | None = None) -> Surface:
        translator = _Translator(material, self._problems, self._images)
        translator.values.object_color = object_color
        surface = translator.surface()
        if translator.values.saw_image:
            self._textured.add(material.as_pointer())
        return surface


class _Translator:
    """One material's way from its output node to a Surface."""

    def __init__(self, material: Any, problems: Problems, images: ImageMeans) -> None:
        self.material = material
        self.problems = problems
        self.values = NodeValues(images, self.note)

    def note(self, code: str, text: str) -> None:
        name = self.material.name
        text = f'Material "{name}": {text}'
        self.problems.add(name, WARNING, code, text, library=ids.library_of(self.material))

    def surface(self) -> Surface:
        material = self.material
        if not material.use_nodes or material.node_tree is None:
            return self._viewport()
        output = material.node_tree.get_output_node("ALL")
        link = _link(output.inputs["Surface"]) if output else None
        if link is None:
            self.note("no_surface", "has no surface shader; drawn in its viewport color")
            return self._viewport()
        found = self._shader(link, (), 0)
        if found is None:
            self.note("transparent", "is transparent; drawn opaque in its viewport color")
            return self._viewport()
        return _clamped(found)

    def _viewport(self) -> Surface:
        material = self.material
        return _clamped(
            Surface(
                tuple(material.diffuse_color[:3]),
                material.roughness,
                material.metallic,
                material.specular_intensity,
            )
        )

    def _shader(self, link: Any, groups: tuple, depth: int) -> Surface | None:
        """The shader a link comes from; None when it is nothing but transparency."""
        if depth > _MAX_DEPTH:
            self.note("node_depth", "nests its nodes too deeply; drawn in its viewport color")
            return self._viewport()
        node, kind = link.from_node, link.from_node.type
        step = depth + 1
        if kind == "REROUTE":
            inner = _link(node.inputs[0])
            return self._shader(inner, groups, step) if inner else Surface(base_color=(0, 0, 0))
        if kind == "GROUP" and node.node_tree is not None:
            outer = self.values.group_output(node, link.from_socket)
            inner = _link(outer) if outer is not None else None
            return self._shader(inner, (*groups, node), step) if inner else None
        if kind == "GROUP_INPUT" and groups:
            outer = self.values.group_input(groups[-1], link.from_socket)
            inner = _link(outer) if outer is not None else None
            return self._shader(inner, groups[:-1], step) if inner else None
        if kind in {"MIX_SHADER", "ADD_SHADER"}:
            return self._mix(node, kind, groups, step)
        if kind == "BSDF_PRINCIPLED":
            return self._principled(node, groups)
        if kind in _TRANSPARENT:
            return None
        return self._plain(node, kind, groups)

    def _mix(self, node: Any, kind: str, groups: tuple, depth: int) -> Surface | None:
        first, second = (_link(s) for s in node.inputs if s.type == "SHADER")
        black = Surface(base_color=(0.0, 0.0, 0.0), specular=0.0)
        a = self._shader(first, groups, depth) if first else black
        b = self._shader(second, groups, depth) if second else black
        if a is None or b is None:
            self.note("transparency", "transparency is left out; drawn opaque")
            return a or b
        if kind == "ADD_SHADER":
            emission = tuple(x + y for x, y in zip(a.emission, b.emission))
            main = a if sum(a.base_color) >= sum(b.base_color) else b
            if min(sum(a.base_color), sum(b.base_color)) > 0.0:
                self.note("added_shaders", "added shaders are drawn as the brighter one")
            return replace(main, emission=emission)
        share = min(1.0, max(0.0, self.values.number(node.inputs[0], groups)))
        if 0.0 < share < 1.0:
            self.note("mixed_shaders", "mixed shaders are drawn as one mean surface")
        return _between(a, b, share)

    def _principled(self, node: Any, groups: tuple) -> Surface:
        get = compat.principled_input
        color, number = self.values.color, self.values.number

        def scalar(default: float, *names: str) -> float:
            socket = get(node, *names)
            return default if socket is None else number(socket, groups)

        for names, off, code, words in _IGNORED:
            socket = get(node, *names)
            if socket is None:
                continue
            if socket.is_linked or (off is not None and socket.default_value != off):
                self.note(code, f"{words} is left out")
        alpha = get(node, "Alpha")
        if alpha is not None and (alpha.is_linked or alpha.default_value < 1.0):
            self.values.look(alpha, groups)
            self.note("transparency", "transparency is left out; drawn opaque")
        transmission = get(node, "Transmission", "Transmission Weight")
        if transmission is not None and (transmission.is_linked or transmission.default_value > 0):
            self.note("transmission", "transmission is left out; drawn opaque")
        strength = scalar(1.0, "Emission Strength")
        emission_socket = get(node, "Emission", "Emission Color")
        emission = (0.0, 0.0, 0.0)
        if strength > 0.0 and emission_socket is not None:
            emission = tuple(strength * c for c in color(emission_socket, groups))
        return Surface(
            color(get(node, "Base Color"), groups),
            scalar(0.5, "Roughness"),
            scalar(0.0, "Metallic"),
            scalar(0.5, "Specular", "Specular IOR Level"),
            emission,
        )

    def _plain(self, node: Any, kind: str, groups: tuple) -> Surface:
        """The other closures, each as the nearest opaque surface."""
        socket = node.inputs.get("Color")
        tint = self.values.color(socket, groups) if socket is not None else None
        roughness_socket = node.inputs.get("Roughness")
        rough = (
            self.values.number(roughness_socket, groups) if roughness_socket is not None else 0.5
        )
        if kind == "BSDF_DIFFUSE" and tint is not None:
            return Surface(tint, 1.0, 0.0, 0.0)
        if kind == "EMISSION" and tint is not None:
            strength = self.values.number(node.inputs["Strength"], groups)
            glow = tuple(strength * c for c in tint)
            return Surface((0.0, 0.0, 0.0), 1.0, 0.0, 0.0, glow)
        if kind in _GLOSSY and tint is not None:
            return Surface(tint, rough, 1.0, 0.5)
        if kind in _GLASS and tint is not None:
            self.note("transmission", "transmission is left out; drawn opaque")
            return Surface(tint, rough)
        if tint is not None:
            self.note("shader", f"{node.bl_label} is drawn as a plain surface of its color")
            return Surface(tint, rough)
        self.note("shader", f"{node.bl_label} is not known; drawn in its viewport color")
        return self._viewport()


def _link(socket: Any) -> Any | None:
    """The socket's first link that is valid and not muted."""
    if not socket.is_linked:
        return None
    return next((ln for ln in socket.links if ln.is_valid and not ln.is_muted), None)


def _between(a: Surface, b: Surface, share: float) -> Surface:
    def mix(x: Any, y: Any) -> Any:
        if isinstance(x, tuple):
            return tuple(mix(p, q) for p, q in zip(x, y))
        return x + share * (y - x)

    return Surface(*(mix(getattr(a, f), getattr(b, f)) for f in Surface.__dataclass_fields__))


def _clamped(surface: Surface) -> Surface:
    def unit(value: float) -> float:
        return min(1.0, max(0.0, value)) if value == value else 0.0

    def positive(value: float) -> float:
        return min(1e9, max(0.0, value)) if value == value else 0.0

    return Surface(
        tuple(positive(c) for c in surface.base_color),
        unit(surface.roughness),
        unit(surface.metallic),
        unit(surface.specular),
        tuple(positive(c) for c in surface.emission),
    )
