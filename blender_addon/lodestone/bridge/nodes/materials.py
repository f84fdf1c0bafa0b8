# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender materials as the backend's.

A value that cannot be said exactly gets the nearest one that can, and a problem naming the
material: nothing turns gray silently. Cycles' picture counts: EEVEE's blend modes do nothing.
"""

from dataclasses import dataclass, replace
from typing import Any

from ...core import object_random
from ...core.expression import color_expression as e
from ...core.expression.color_expression import Expression, Op
from ...core.native import lodestone_native as native
from ...core.problems import WARNING, Problems
from .. import datablock_ids
from ..datablock_ids import name_of
from . import material_looks, node_graph
from .expression_textures import Textures, main_coordinates
from .material_looks import CONSTANTS, DEFAULT, Look, Value, VertexColors, gray
from .node_expressions import NodeExpressions, Setting, mean_of
from .shader_nodes import Shaders
from .shader_surfaces import Clear, Shader, Surface, each_surface, surfaces
from .texture_coordinates import Coordinates
from .texture_pictures import NoPictures, Pictures

AlphaMode = native.AlphaMode
Color = tuple[float, ...]
_CLEAR = 0.1  # roughness up to which nobody misses the blur of what is behind glass


@dataclass(frozen=True)
class Wanted:
    """The data that a mesh has to carry for the material of a slot."""

    coordinates: Coordinates | None = None
    vertex_colors: VertexColors | None = None


class Materials:
    """Adds each material once to a model (None: nowhere, nothing of an image is read); remembers
    what it could not say exactly. `frame`: the scene's, for images that change."""

    def __init__(
        self, model: Any, problems: Problems, pictures: Any = None, frame: int = 1
    ) -> None:
        self._model = model
        self._problems = problems
        self._pictures = pictures or (NoPictures() if model is None else Pictures(model))
        self._frame = frame
        self._indices: dict[tuple, int] = {}
        self._looks: dict[tuple, Look] = {}
        self._wanted: dict[tuple, Wanted] = {}
        self._varying: dict[int, tuple[bool, bool]] = {}

    def index(self, material: Any | None, color: Color | None = None) -> int:
        """The model's index of an evaluated material, or of Blender's default for None; `color` is
        that (RGBA, and perhaps Random) of the object that shows it."""
        key = self._key(material, color)
        if key not in self._indices:
            look = self.look(material, color)
            name = "" if material is None else name_of(material)
            if self._model is None:
                self._indices[key] = len(self._indices)
            else:
                self._indices[key] = material_looks.add(self._model, self._pictures, name, look)
        return self._indices[key]

    def look(self, material: Any | None, color: Color | None = None) -> Look:
        key = self._key(material, color)
        if key not in self._looks:
            self._looks[key] = DEFAULT if material is None else self.translate(material, color)
        return self._looks[key]

    def wanted(self, material: Any | None, color: Color | None = None) -> Wanted:
        key = self._key(material, color)
        if key not in self._wanted:
            look = self.look(material, color)
            self._wanted[key] = Wanted(look.coordinates, next(iter(_vertex_colors(look)), None))
        return self._wanted[key]

    def textured(self, material: Any | None) -> bool:
        """True when its meshes keep their texture coordinates."""
        return self.look(material).coordinates is not None

    def varies(self, material: Any | None) -> tuple[bool, bool]:
        """Whether it looks different on objects of different colors, and of different Random."""
        if material is None:
            return False, False
        self.look(material)
        return self._varying[material.as_pointer()]

    def translate(self, material: Any, color: Color | None = None) -> Look:
        translator = _Translator(material, self._problems, self._pictures, self._frame, color)
        look = translator.look()
        values = translator.values
        self._varying[material.as_pointer()] = values.depends_on_color, values.depends_on_random
        return look

    def _key(self, material: Any | None, color: Color | None) -> tuple:
        if material is None:
            return (0, None)
        pointer = material.as_pointer()
        if color is not None and (pointer, None) not in self._looks:
            self.look(material)  # tells whether the color matters
        return (pointer, color if any(self._varying.get(pointer, ())) else None)


class _Translator:
    """The way of one material from its output node to a look."""

    def __init__(
        self, material: Any, problems: Problems, pictures: Any, frame: int, color: Color | None
    ) -> None:
        self.material = material
        self.problems = problems
        self.pictures = pictures
        random = color[4] if color is not None and len(color) > 4 else object_random.MEAN
        setting = Setting(frame, color and color[:4], material.pass_index, random)
        self.values = NodeExpressions(pictures, self.note, setting)

    def note(self, severity: str, code: str, text: str) -> None:
        name = name_of(self.material)
        text = f'Material "{name}": {text}'
        self.problems.add(
            name, severity, code, text, library=datablock_ids.library_of(self.material)
        )

    def look(self) -> Look:
        mixed = surfaces(self._shader())
        first = [value for surface, _ in mixed for value in _in_order(surface)]
        shares = [share for _, share in mixed]
        main = main_coordinates([*first, *shares])
        textures = Textures(self.pictures, self.note, main)
        look = None
        for surface, share in reversed(mixed):  # each holds what is mixed with it
            made = self._look(surface, textures)
            if look is not None:
                made = replace(made, other=look, mix=textures.number(share))
            look = made
        if len(set(_vertex_colors(look))) > 1:
            self.note(WARNING, "vertex_colors", "of its several vertex colors one is drawn")
        coordinates = main if _has_texture(look) else None
        return replace(look, coordinates=coordinates, radiance=self._radiance(mixed))

    def _radiance(self, mixed: list[tuple[Surface, Expression]]) -> tuple[float, float, float]:
        """The radiance of all surfaces together, in the mean."""
        found, left = [0.0, 0.0, 0.0], 1.0
        for surface, share in mixed:
            rest = min(1.0, max(0.0, mean_of(share, self.pictures)[0]))
            seen = (
                left * (1.0 - rest) * min(1.0, max(0.0, mean_of(surface.alpha, self.pictures)[0]))
            )
            for i, value in enumerate(mean_of(surface.emission, self.pictures)[:3]):
                found[i] += seen * (value if 0.0 < value < float("inf") else 0.0)
            left *= rest
        return tuple(found)

    # ---- From the output node to surfaces ----

    def _shader(self) -> Shader:
        material = self.material
        viewport = self._viewport()
        if not material.use_nodes or material.node_tree is None:
            return viewport
        output = material.node_tree.get_output_node("CYCLES")
        if output is None:
            self.note(WARNING, "no_surface", "has no output node; drawn in its viewport color")
            return viewport
        if node_graph.link_to(output.inputs["Surface"]) is None:
            if node_graph.link_to(output.inputs["Volume"]) is not None:
                self.note(WARNING, "volume", "its volume is left out")
                return Clear()
            text = "has no surface shader; drawn in its viewport color"
            self.note(WARNING, "no_surface", text)
            return viewport
        if node_graph.link_to(output.inputs["Volume"]) is not None:
            self.note(WARNING, "volume", "its volume is left out")
        shaders = Shaders(self.values, self.note, viewport)
        return self._displaced(shaders, shaders.shader(output.inputs["Surface"]), output)

    def _viewport(self) -> Surface:
        material = self.material
        return Surface(
            base_color=e.constant(material.diffuse_color[:3]),
            roughness=e.number(material.roughness),
            metallic=e.number(material.metallic),
            specular=e.number(material.specular_intensity),
        )

    def _displaced(self, shaders: Shaders, shader: Shader, output: Any) -> Shader:
        """Displacement as bumps: Cycles' own default."""
        found = node_graph.feed(output.inputs["Displacement"])
        if found.node is None:
            return shader
        if found.node.type != "DISPLACEMENT":
            self.note(WARNING, "displacement", f"displacement by {found.node.bl_label} is left out")
            return shader
        cycles = getattr(self.material, "cycles", None)
        if getattr(cycles, "displacement_method", "BUMP") != "BUMP":
            self.note(WARNING, "displacement", "displacement is drawn as bumps")
        height = self.values.number(found.node.inputs["Height"], found.groups)
        size = mean_of(self.values.number(found.node.inputs["Scale"], found.groups))[0]

        def bumped(surface: Surface) -> Surface:
            return replace(surface, relief=shaders.bumped(surface.relief, height, size))

        return each_surface(shader, bumped)

    # ---- From a surface to a look ----

    def _look(self, surface: Surface, textures: Textures) -> Look:
        base, alpha, vertex = textures.vertex_colors(surface.base_color, surface.alpha)
        value, mode, cutoff = self._alpha(alpha, textures)
        if mode == AlphaMode.OPAQUE and vertex is not None and vertex.alpha:
            mode = AlphaMode.BLEND
        relief = surface.relief
        normal = None if relief.normal is None else textures.color(relief.normal).texture
        bump = None if relief.bump is None else textures.number(relief.bump).texture
        if relief.normal is not None and normal is None:
            self.note(WARNING, "normal_map", "its normal map is left out")
        if relief.bump is not None and bump is None:
            self.note(WARNING, "bump", "its bumps are left out")
        roughness, metallic = textures.number(surface.roughness), textures.number(surface.metallic)
        constants = {
            key: textures.constant(getattr(surface, key), one.words)
            for key, one in CONSTANTS.items()
        }
        if constants["transmission"] > 0.0 and metallic.number < 1.0 and roughness.number > _CLEAR:
            self.note(WARNING, "rough_glass", "its rough glass is drawn clear")
        return Look(
            base_color=textures.color(base),
            roughness=roughness,
            metallic=metallic,
            emission=textures.color(surface.emission),
            alpha=value,
            alpha_mode=mode,
            alpha_cutoff=cutoff,
            normal=normal,
            normal_strength=relief.strength,
            bump=bump,
            bump_distance=relief.distance,
            vertex_colors=vertex,
            **constants,
        )

    def _alpha(self, alpha: Expression, textures: Textures) -> tuple[Value, int, float]:
        """The alpha as value, mode and cutoff: what is compared with a constant is cut there."""
        if alpha.op == Op.GREATER:
            value, limit = alpha.args
            if value.constant:  # below: turned over
                value, limit = e.subtract(e.ONE, limit), e.subtract(e.ONE, value)
            found = textures.number(value) if limit.constant else gray(0.0)
            if found.texture is not None and 0.0 <= limit.value[0] <= 1.0:
                return found, AlphaMode.CLIP, limit.value[0]
        found = textures.number(alpha)
        if found.texture is None and found.number >= 1.0:
            return gray(1.0), AlphaMode.OPAQUE, 0.5
        return found, AlphaMode.BLEND, 0.5


def _in_order(surface: Surface) -> list[Expression]:
    """The one whose texture coordinates count comes first."""
    relief = [surface.relief.normal, surface.relief.bump]
    found = [surface.base_color, surface.alpha, surface.emission, surface.roughness]
    return [*found, surface.metallic, *(value for value in relief if value is not None)]


def _has_texture(look: Look) -> bool:
    if any(getattr(look, key).texture is not None for key in material_looks.TEXTURED):
        return True
    if look.normal is not None or look.bump is not None:
        return True
    return look.other is not None and _has_texture(look.other)


def _vertex_colors(look: Look | None) -> list[VertexColors]:
    """The vertex colors of all surfaces that are mixed."""
    found = []
    while look is not None:
        if look.vertex_colors is not None:
            found.append(look.vertex_colors)
        look = look.other
    return found
