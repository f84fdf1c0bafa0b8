# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes as surfaces and mixtures of them."""

from dataclasses import replace
from typing import Any

from ...core.expression import color_expression as e
from ...core.expression.color_expression import Expression
from ...core.problems import INFO, WARNING
from .. import blender_versions
from . import node_graph
from .node_expressions import NodeExpressions, Note, mean_of
from .shader_surfaces import FLAT, NOTHING, Clear, Mixed, Relief, Shader, Surface, mixed

_MAX_DEPTH = 48
# The roughness at which the principled diffuse lobe is nearest to Lambert's law: rougher ones send
# back more at grazing angles
LAMBERT = e.number(0.45)


class Shaders:
    """The shaders of one material. `viewport` is what it looks like without nodes."""

    def __init__(self, values: NodeExpressions, note: Note, viewport: Surface) -> None:
        self._values = values
        self._note = note
        self._viewport = viewport
        self._found: dict[tuple, Shader] = {}

    def shader(self, socket: Any, groups: tuple = (), depth: int = 0) -> Shader:
        """The shader that is plugged into an input."""
        if depth > _MAX_DEPTH:
            self._note(WARNING, "node_depth", "nests its nodes too deeply; the rest is left out")
            return self._viewport
        found = node_graph.feed(socket, groups)
        if found.node is None:
            return NOTHING
        key = (found.socket.as_pointer(), tuple(group.as_pointer() for group in found.groups))
        if key not in self._found:  # trees share their branches
            self._found[key] = self._output(found, depth)
        return self._found[key]

    def _output(self, found: node_graph.Feed, depth: int) -> Shader:
        node, kind = found.node, found.node.type
        if kind == "MIX_SHADER":
            return self._mix(node, found.groups, depth + 1)
        if kind == "ADD_SHADER":
            return self._add(node, found.groups, depth + 1)
        if kind == "BSDF_PRINCIPLED":
            return self._principled(node, found.groups)
        return self._other(node, kind, found.groups)

    # ---- Mixing ----

    def _mix(self, node: Any, groups: tuple, depth: int) -> Shader:
        share = e.clamp(self._values.number(node.inputs[0], groups))
        first, second = (s for s in node.inputs if s.type == "SHADER")
        if share.constant and share.value[0] <= 0.0:
            return self.shader(first, groups, depth)
        if share.constant and share.value[0] >= 1.0:
            return self.shader(second, groups, depth)
        a, b = self.shader(first, groups, depth), self.shader(second, groups, depth)
        return mixed(a, b, share, self._note, self._values.pictures)

    def _add(self, node: Any, groups: tuple, depth: int) -> Shader:
        a, b = (self.shader(s, groups, depth) for s in node.inputs if s.type == "SHADER")
        for glow, rest in ((a, b), (b, a)):
            if isinstance(glow, Surface) and _only_glows(glow):
                return self._lit(rest, glow.emission)
        if isinstance(a, Clear) or isinstance(b, Clear):
            self._note(WARNING, "added_shaders", "a shader added to transparency is drawn opaque")
            return b if isinstance(a, Clear) else a
        self._note(WARNING, "added_shaders", "added shaders are drawn as the brighter one")
        return a if _brightness(a) >= _brightness(b) else b

    def _lit(self, rest: Shader, emission: Expression) -> Shader:
        if isinstance(rest, Clear):
            text = "light added to transparency hides half of what is behind"
            self._note(WARNING, "added_shaders", text)
            twice = e.multiply(emission, e.number(2.0))
            return replace(NOTHING, emission=twice, alpha=e.number(0.5))
        if isinstance(rest, Mixed):
            first, second = self._lit(rest.first, emission), self._lit(rest.second, emission)
            return replace(rest, first=first, second=second)
        return replace(rest, emission=e.add(rest.emission, emission))

    # ---- Single shaders ----

    def _principled(self, node: Any, groups: tuple) -> Surface:
        def number(default: float, *names: str) -> Expression:
            socket = blender_versions.principled_input(node, *names)
            return e.number(default) if socket is None else self._values.number(socket, groups)

        def color(default: Expression, *names: str) -> Expression:
            socket = blender_versions.principled_input(node, *names)
            return default if socket is None else self._values.color(socket, groups)

        base = color(e.number(0.8), "Base Color")
        subsurface = number(0.0, "Subsurface", "Subsurface Weight")
        if not _zero(subsurface):
            self._note(WARNING, "subsurface", "subsurface scattering is drawn as diffuse")
            base = e.mix(base, color(base, "Subsurface Color"), e.clamp(subsurface))
        self._note_ignored(node, groups)
        emission = color(e.ZERO, "Emission", "Emission Color")
        strength = number(1.0, "Emission Strength")
        coat = number(0.0, "Clearcoat", "Coat Weight")
        ior = number(1.45, "IOR")
        return Surface(
            base_color=base,
            roughness=number(0.5, "Roughness"),
            metallic=number(0.0, "Metallic"),
            specular=self._specular(node, groups, ior),
            emission=e.multiply(emission, strength),
            alpha=number(1.0, "Alpha"),
            transmission=number(0.0, "Transmission", "Transmission Weight"),
            ior=ior,
            clearcoat=coat,
            clearcoat_roughness=number(0.03, "Clearcoat Roughness", "Coat Roughness"),
            relief=self._relief(node.inputs.get("Normal"), groups),
        )

    def _specular(self, node: Any, groups: tuple, ior: Expression) -> Expression:
        """The specular value as until 3.6: 0.5 reflects 4 % straight on. Since 4.0 it scales what
        the IOR reflects."""
        socket = node.inputs.get("Specular")
        if socket is not None:
            return self._values.number(socket, groups)
        socket = node.inputs.get("Specular IOR Level")
        level = e.number(0.5) if socket is None else self._values.number(socket, groups)
        index = mean_of(ior)[0]
        straight = ((index - 1.0) / (index + 1.0)) ** 2 if index > 0.0 else 0.0
        return e.multiply(level, e.number(2.0 * straight / 0.08))

    def _note_ignored(self, node: Any, groups: tuple) -> None:
        for names, severity, code, words in _IGNORED:
            socket = blender_versions.principled_input(node, *names)
            if socket is None or not hasattr(socket, "default_value"):
                continue
            if socket.is_linked or (socket.type == "VALUE" and socket.default_value != 0.0):
                if not _zero(self._values.number(socket, groups)):
                    self._note(severity, code, f"{words} is left out")
        coat_normal = blender_versions.principled_input(node, "Clearcoat Normal", "Coat Normal")
        if coat_normal is not None and coat_normal.is_linked:
            self._note(INFO, "clearcoat_normal", "the clear coat has the surface's own normals")

    def _other(self, node: Any, kind: str, groups: tuple) -> Shader:
        """The other closures, each as the nearest surface."""
        if kind == "BSDF_TRANSPARENT":
            return self._transparent(node, groups)
        if kind == "HOLDOUT":
            self._note(WARNING, "holdout", "a holdout is drawn black")
            return NOTHING
        socket = next(
            (node.inputs.get(n) for n in ("Color", "Base Color") if n in node.inputs), None
        )
        if socket is None:
            self._note(WARNING, "shader", f"{node.bl_label} is drawn in the viewport color")
            return self._viewport
        tint = self._values.color(socket, groups)
        rough_socket = node.inputs.get("Roughness")
        rough = e.number(0.5)
        if rough_socket is not None:
            rough = self._values.number(rough_socket, groups)
        relief = self._relief(node.inputs.get("Normal"), groups)
        words = _INEXACT.get(kind)
        if words is not None:
            self._note(words[0], "shader", f"{node.bl_label} is drawn as {words[1]}")
        if kind == "EMISSION":
            strength = self._values.number(node.inputs["Strength"], groups)
            return replace(NOTHING, emission=e.multiply(tint, strength))
        if kind in {"BSDF_GLOSSY", "BSDF_ANISOTROPIC"}:
            return Surface(tint, rough, e.ONE, relief=relief)
        if kind in {"BSDF_GLASS", "BSDF_REFRACTION"}:
            ior = self._values.number(node.inputs["IOR"], groups)
            return Surface(tint, rough, transmission=e.ONE, ior=ior, relief=relief)
        if kind == "BSDF_DIFFUSE" and not _zero(rough):
            self._note(INFO, "diffuse_roughness", "the roughness of diffuse surfaces is left out")
        if kind in _DIFFUSE:
            return Surface(tint, LAMBERT, specular=e.ZERO, relief=relief)
        if words is None:
            text = f"{node.bl_label} is drawn as a plain surface of its color"
            self._note(WARNING, "shader", text)
        return Surface(tint, rough, relief=relief)

    def _transparent(self, node: Any, groups: tuple) -> Shader:
        tint = self._values.color(node.inputs["Color"], groups)
        if tint.constant and min(tint.value) >= 1.0:
            return Clear()
        self._note(WARNING, "tinted_transparency", "tinted transparency is drawn as gray")
        return replace(NOTHING, alpha=e.clamp(e.subtract(e.ONE, e.luma(tint))))

    # ---- Relief ----

    def _relief(self, socket: Any, groups: tuple, depth: int = 0) -> Relief:
        if socket is None or not socket.is_linked or depth > _MAX_DEPTH:
            return FLAT
        found = node_graph.feed(socket, groups)
        node = found.node
        if node is None or node.type in {"NEW_GEOMETRY", "TEX_COORD"}:
            return FLAT
        if node.type == "NORMAL_MAP":
            return self._normal_map(node, found.groups)
        if node.type == "BUMP":
            under = self._relief(node.inputs["Normal"], found.groups, depth + 1)
            return self._bump(node, found.groups, under)
        self._note(WARNING, "normal", f"normals by {node.bl_label} are left out")
        return FLAT

    def _normal_map(self, node: Any, groups: tuple) -> Relief:
        if node.space != "TANGENT":
            words = f"a normal map in {node.space.lower().replace('_', ' ')} space is left out"
            self._note(WARNING, "normal_map", words)
            return FLAT
        color = self._values.color(node.inputs["Color"], groups)
        strength = mean_of(self._values.number(node.inputs["Strength"], groups))[0]
        if color.constant:
            if max(abs(c - n) for c, n in zip(color.value, (0.5, 0.5, 1.0))) > 1e-3:
                self._note(WARNING, "normal_map", "a normal map without an image is left out")
            return FLAT
        return Relief(color, max(0.0, strength))

    def _bump(self, node: Any, groups: tuple, under: Relief) -> Relief:
        height = self._values.number(node.inputs["Height"], groups)
        strength = e.clamp(self._values.number(node.inputs["Strength"], groups))
        distance = self._values.number(node.inputs["Distance"], groups)
        size = mean_of(strength)[0] * mean_of(distance)[0] * (-1.0 if node.invert else 1.0)
        return self.bumped(under, height, size)

    def bumped(self, under: Relief, height: Expression, size: float) -> Relief:
        """The relief `under` with a height of `size` metres from 0 to 1 on it."""
        if height.constant:
            if not height.exact:
                self._note(WARNING, "bump", "bumps of what is drawn as its mean are left out")
            return under
        if size == 0.0:
            return under
        if under.bump is not None:
            self._note(WARNING, "bump", "of several bumps the last one is drawn")
        return replace(under, bump=height, distance=size)


def _only_glows(surface: Surface) -> bool:
    dark = (surface.base_color, surface.specular, surface.transmission, surface.metallic)
    return all(_zero(value) for value in dark)


def _zero(value: Expression) -> bool:
    return value.constant and value.exact and value.value == (0.0, 0.0, 0.0)


def _brightness(shader: Shader) -> float:
    if isinstance(shader, Clear):
        return 0.0
    if isinstance(shader, Mixed):
        return max(_brightness(shader.first), _brightness(shader.second))
    return sum(mean_of(shader.base_color)) + sum(mean_of(shader.emission))


# Inputs of the principled shader that are not translated: names, severity, code, words
_IGNORED = (
    (("Sheen", "Sheen Weight"), WARNING, "sheen", "sheen"),
    (("Anisotropic",), INFO, "anisotropic", "the stretch of anisotropic highlights"),
    (("Specular Tint",), INFO, "specular_tint", "specular tint"),
    (("Transmission Roughness",), INFO, "transmission_roughness", "transmission roughness"),
    (("Thin Film Thickness",), WARNING, "thin_film", "thin film"),
)
_INEXACT = {
    "BSDF_ANISOTROPIC": (INFO, "glossy without its stretch"),
    "BSDF_REFRACTION": (INFO, "glass"),
    "BSDF_TRANSLUCENT": (WARNING, "diffuse"),
    "SUBSURFACE_SCATTERING": (WARNING, "diffuse"),
    "BSDF_VELVET": (WARNING, "diffuse"),
    "BSDF_TOON": (WARNING, "diffuse"),
    "BSDF_HAIR": (INFO, "a plain surface"),
    "BSDF_HAIR_PRINCIPLED": (INFO, "a plain surface"),
    "EEVEE_SPECULAR": (WARNING, "a plain surface"),
}
_DIFFUSE = {
    "BSDF_DIFFUSE",
    "BSDF_TRANSLUCENT",
    "SUBSURFACE_SCATTERING",
    "BSDF_VELVET",
    "BSDF_TOON",
}
