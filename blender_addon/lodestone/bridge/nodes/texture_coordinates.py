# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture coordinates: which ones a node's Vector input asks for, and how they are mapped."""

import math
from dataclasses import dataclass
from typing import Any

from mathutils import Euler, Matrix, Vector

from ...core.native import lodestone_native as native
from ..datablock_ids import name_of
from . import node_graph

Rows = tuple[float, ...]
Projection = native.Projection
PROJECTIONS = {
    "FLAT": Projection.FLAT,
    "BOX": Projection.BOX,
    "SPHERE": Projection.SPHERE,
    "TUBE": Projection.TUBE,
}
IDENTITY_2D: Rows = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)
IDENTITY_3D: Rows = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
_MOST_NODES = 32


@dataclass(frozen=True)
class Coordinates:
    """The texture coordinates that the corners of a slot's triangles carry.

    UV: the mesh's uv layer `name` ("": the one active for rendering). GENERATED, OBJECT: positions
    in the bound or the frame of the object itself; FRAME: in the frame of the object that is
    `frame` (its original; None: the world). Those are projected after `rows` (3x4).
    """

    kind: str = "UV"
    name: str = ""
    frame: Any = None
    projection: int = Projection.FLAT
    rows: Rows = IDENTITY_3D


@dataclass(frozen=True)
class Mapped:
    """Coordinates, and the 2x3 from them to the picture."""

    coordinates: Coordinates
    to_picture: Rows = IDENTITY_2D


class Unknown(Exception):
    """Says in words what coordinates cannot be followed."""


def of_image_node(node: Any, groups: tuple) -> Mapped:
    """The coordinates at which an image texture node looks its image up. Raises Unknown."""
    base, matrix = _follow(node.inputs["Vector"], groups, Matrix())
    matrix = _texture_mapping(node.texture_mapping) @ matrix
    projection = PROJECTIONS.get(node.projection, Projection.FLAT)
    if not all(math.isfinite(v) for row in matrix for v in row):
        raise Unknown("numbers that are not finite")
    if projection == Projection.FLAT and not (matrix[0][2] or matrix[1][2]):
        rows = (*_planar(matrix[0]), *_planar(matrix[1]))
        return Mapped(base, rows)
    if base.kind == "UV" and projection == Projection.FLAT:  # a uv has no third number
        return Mapped(base, (*_planar(matrix[0]), *_planar(matrix[1])))
    if base.kind == "UV":
        raise Unknown(f"{node.projection.lower()} projection of uvs")
    rows = (*matrix[0], *matrix[1], *matrix[2])
    return Mapped(Coordinates(base.kind, base.name, base.frame, projection, rows))


def _planar(row: Any) -> Rows:
    return (row[0], row[1], row[3])


def _follow(socket: Any, groups: tuple, matrix: Matrix) -> tuple[Coordinates, Matrix]:
    """The coordinates behind a vector socket, and `matrix` times all mappings between."""
    for _ in range(_MOST_NODES):
        found = node_graph.feed(socket, groups)
        node, groups = found.node, found.groups
        if node is None:
            if found.socket.node.type == "TEX_IMAGE":
                return Coordinates(), matrix  # nothing said: the uvs
            raise Unknown(f'a "{found.socket.node.bl_label}" node without coordinates')
        if node.type == "MAPPING":
            matrix = matrix @ _mapping_node(node, groups)
            socket = node.inputs["Vector"]
        elif node.type == "VECT_MATH":
            step, socket = _vector_math(node, groups)
            matrix = matrix @ step
        else:
            return _source(node, found.socket), matrix
    raise Unknown("too many nodes")


def _source(node: Any, output: Any) -> Coordinates:
    name = output.name
    if node.type == "UVMAP":
        _not_of_instancer(node)
        return Coordinates(name=name_of(node, "uv_map"))
    if node.type == "TEX_COORD":
        if name == "UV":
            _not_of_instancer(node)
            return Coordinates()
        if name == "Generated":
            _not_of_instancer(node)
            return Coordinates("GENERATED")
        if name == "Object":
            if node.object is None:
                return Coordinates("OBJECT")
            return Coordinates("FRAME", name_of(node.object), node.object)
    if node.type == "NEW_GEOMETRY" and name == "Position":
        return Coordinates("FRAME")
    if node.type == "ATTRIBUTE" and node.attribute_type == "GEOMETRY" and name != "Alpha":
        return Coordinates(name=name_of(node, "attribute_name"))
    label = f"{name} coordinates" if node.type == "TEX_COORD" else node.bl_label
    raise Unknown(label)


def _not_of_instancer(node: Any) -> None:
    if node.from_instancer:
        raise Unknown("coordinates of the instancer")


def _value(socket: Any, groups: tuple) -> Vector:
    """A vector input that nothing but constants feeds."""
    found = node_graph.feed(socket, groups)
    if found.node is None:
        value = found.socket.default_value
    elif found.node.type in {"VALUE", "RGB"}:
        value = found.node.outputs[0].default_value
    elif found.node.type == "COMBXYZ":
        value = [_value(s, found.groups)[0] for s in found.node.inputs]
    else:
        raise Unknown(f"mapping by {found.node.bl_label}")
    if isinstance(value, (int, float)):
        return Vector((value, value, value))
    return Vector(value[:3])


def _mapping_node(node: Any, groups: tuple) -> Matrix:
    def value(name: str) -> Vector:
        socket = node.inputs.get(name)
        return Vector() if socket is None else _value(socket, groups)

    kind = node.vector_type
    turn = Euler(value("Rotation")).to_matrix().to_4x4()
    scale = value("Scale")
    if kind == "NORMAL":
        raise Unknown("a mapping of normals")
    return _mapping(kind, value("Location") if kind != "VECTOR" else Vector(), turn, scale)


def _mapping(kind: str, place: Vector, turn: Matrix, scale: Vector) -> Matrix:
    """source: Blender's Mapping node; TEXTURE is the inverse, 0 where a scale is 0."""
    if kind == "TEXTURE":
        inverse = Vector(1.0 / s if s else 0.0 for s in scale)
        return Matrix.Diagonal((*inverse, 1.0)) @ turn.transposed() @ Matrix.Translation(-place)
    return Matrix.Translation(place) @ turn @ Matrix.Diagonal((*scale, 1.0))


def _texture_mapping(mapping: Any) -> Matrix:
    """The mapping of the texture node itself, seldom used."""
    if (mapping.mapping_x, mapping.mapping_y, mapping.mapping_z) != ("X", "Y", "Z"):
        raise Unknown("swapped axes")
    place, scale = Vector(mapping.translation), Vector(mapping.scale)
    if mapping.vector_type not in {"POINT", "TEXTURE", "VECTOR"}:
        raise Unknown("a mapping of normals")
    if mapping.vector_type == "VECTOR":
        place = Vector()
    if not any(place) and not any(mapping.rotation) and tuple(scale) == (1.0, 1.0, 1.0):
        return Matrix()
    turn = Euler(mapping.rotation).to_matrix().to_4x4()
    return _mapping(mapping.vector_type, place, turn, scale)


def _vector_math(node: Any, groups: tuple) -> tuple[Matrix, Any]:
    """The matrix of sums and products with constants, and the input that is not constant."""
    kind, (first, second) = node.operation, node.inputs[:2]
    if kind == "SCALE":
        scale = _value(node.inputs["Scale"], groups)
        return Matrix.Diagonal((*scale, 1.0)), first
    if kind not in {"ADD", "SUBTRACT", "MULTIPLY", "DIVIDE"}:
        raise Unknown(f"{node.bl_label} ({kind.lower()})")
    moving = node_graph.feed(first, groups).node is not None
    if not moving and kind in {"SUBTRACT", "DIVIDE"}:
        raise Unknown(f"{node.bl_label} ({kind.lower()})")
    variable, fixed = (first, second) if moving else (second, first)
    value = _value(fixed, groups)
    if kind in {"ADD", "SUBTRACT"}:
        return Matrix.Translation(value if kind == "ADD" else -value), variable
    if kind == "DIVIDE":
        value = Vector(1.0 / v if v else 0.0 for v in value)
    return Matrix.Diagonal((*value, 1.0)), variable


def between(base: Rows, other: Rows) -> Rows | None:
    """The transform from the pictures' coordinates of one 2x3 to those of another; None when it is
    singular."""
    determinant = base[0] * base[4] - base[1] * base[3]
    if abs(determinant) < 1e-12:
        return None
    a, b = base[4] / determinant, -base[1] / determinant
    c, d = -base[3] / determinant, base[0] / determinant
    x, y = -(a * base[2] + b * base[5]), -(c * base[2] + d * base[5])
    return (
        other[0] * a + other[1] * c,
        other[0] * b + other[1] * d,
        other[0] * x + other[1] * y + other[2],
        other[3] * a + other[4] * c,
        other[3] * b + other[4] * d,
        other[3] * x + other[4] * y + other[5],
    )
