# SPDX-License-Identifier: GPL-3.0-or-later
"""Mean colors and numbers of node sockets: exact where constant, named where not."""

from collections.abc import Callable
from typing import Any

from .images import ImageMeans

Color = tuple[float, float, float]
_MAX_DEPTH = 32
_WEIGHTS = (0.2126, 0.7152, 0.0722)
_PASS_THROUGH = {"HUE_SAT", "GAMMA", "BRIGHTCONTRAST", "CURVE_RGB"}
_BLENDS = {"MIX", "MULTIPLY", "ADD"}


class NodeValues:
    """`note(code, text)` is told about every value that is not exact."""

    def __init__(self, images: ImageMeans, note: Callable[[str, str], None]) -> None:
        self._images = images
        self._note = note
        self.saw_image = False
        self.object_color: tuple | None = None  # of the object the material is drawn on

    def color(self, socket: Any, groups: tuple = (), depth: int = 0) -> Color:
        """The socket's linear color; `groups` are the group nodes around it, outermost first."""
        link = self._link(socket)
        if link is None:
            return _as_color(socket)
        found = self._node_color(link, groups, depth) if depth < _MAX_DEPTH else None
        if found is None:
            label = link.from_node.bl_label
            self._note("node_color", f"{label} is drawn as the color of its input without it")
            found = _as_color(socket)
        return found

    def number(self, socket: Any, groups: tuple = (), depth: int = 0) -> float:
        link = self._link(socket)
        if link is None:
            return _as_number(socket)
        if link.from_node.type == "VALUE":
            return float(link.from_node.outputs[0].default_value)
        return _luma(self.color(socket, groups, depth))

    def look(self, socket: Any, groups: tuple = ()) -> None:
        """Only finds out whether there is an image behind the socket."""
        link = self._link(socket)
        if link is not None and link.from_node.type == "TEX_IMAGE":
            self.saw_image = True

    def group_output(self, node: Any, socket: Any) -> Any | None:
        """The socket inside a group node that feeds this output of it."""
        outputs = [n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT"]
        output = next((n for n in outputs if n.is_active_output), None)
        return _same(output.inputs, socket) if output else None

    def group_input(self, node: Any, socket: Any) -> Any | None:
        """The socket of a group node that its inside sees as this group input."""
        return _same(node.inputs, socket)

    def _link(self, socket: Any) -> Any | None:
        if not socket.is_linked:
            return None
        return next((ln for ln in socket.links if ln.is_valid and not ln.is_muted), None)

    def _node_color(self, link: Any, groups: tuple, depth: int) -> Color | None:
        node, kind, step = link.from_node, link.from_node.type, depth + 1
        if kind == "TEX_IMAGE":
            return self._image(node, link.from_socket)
        if kind == "OBJECT_INFO" and link.from_socket.name == "Color" and self.object_color:
            return self.object_color[:3]
        if kind == "RGB":
            return _as_color(node.outputs[0])
        if kind == "VALUE":
            return (float(node.outputs[0].default_value),) * 3
        if kind == "REROUTE":
            return self.color(node.inputs[0], groups, step)
        if kind == "GROUP" and node.node_tree is not None:
            inner = self.group_output(node, link.from_socket)
            return None if inner is None else self.color(inner, (*groups, node), step)
        if kind == "GROUP_INPUT" and groups:
            outer = self.group_input(groups[-1], link.from_socket)
            return None if outer is None else self.color(outer, groups[:-1], step)
        if kind in {"MIX_RGB", "MIX"}:
            return self._mix(node, groups, step)
        if kind == "INVERT":
            share = self.number(node.inputs["Fac"], groups, step)
            color = self.color(node.inputs["Color"], groups, step)
            return tuple(c + share * (1.0 - 2.0 * c) for c in color)
        if kind == "VALTORGB":
            return self._ramp(node)
        if kind in _PASS_THROUGH:
            self._note("node_color", f"{node.bl_label} is left out")
            return self.color(node.inputs["Color"], groups, step)
        return self._mean_of_inputs(node, groups, step)

    def _image(self, node: Any, socket: Any) -> Color | None:
        self.saw_image = True
        if node.image is None:
            self._note("image_missing", "an image texture has no image")
            return None
        mean = self._images.mean(node.image)
        if mean is None:
            self._note("image_missing", f'image "{node.image.name}" cannot be read')
            return None
        self._note("texture_mean", "textures are drawn as their mean color")
        return (1.0, 1.0, 1.0) if socket.name == "Alpha" else mean

    def _mix(self, node: Any, groups: tuple, depth: int) -> Color | None:
        if node.type == "MIX" and node.data_type != "RGBA":
            return self._mean_of_inputs(node, groups, depth)
        enabled = [socket for socket in node.inputs if socket.enabled]
        colors = [socket for socket in enabled if socket.type == "RGBA"]
        factors = [socket for socket in enabled if socket.type != "RGBA"]
        if len(colors) != 2 or not factors:
            return None
        share = min(1.0, max(0.0, self.number(factors[0], groups, depth)))
        a, b = (self.color(socket, groups, depth) for socket in colors)
        kind = node.blend_type
        if kind not in _BLENDS:
            self._note("node_color", f"mixing by {kind.lower()} is drawn as plain mixing")
        if kind == "MULTIPLY":
            return tuple(x * (1.0 + share * (y - 1.0)) for x, y in zip(a, b))
        if kind == "ADD":
            return tuple(x + share * y for x, y in zip(a, b))
        return tuple(x + share * (y - x) for x, y in zip(a, b))

    def _ramp(self, node: Any) -> Color:
        self._note("node_color", "a color ramp is drawn as its mean color")
        samples = [node.color_ramp.evaluate((i + 0.5) / 16) for i in range(16)]
        return tuple(sum(sample[c] for sample in samples) / 16 for c in range(3))

    def _mean_of_inputs(self, node: Any, groups: tuple, depth: int) -> Color | None:
        """A node we do not know: the mean of the colors that go in."""
        sockets = [s for s in node.inputs if s.type == "RGBA" and s.enabled]
        if not sockets:
            sockets = [s for s in node.inputs if s.is_linked and s.type == "VALUE"]
        if not sockets:
            return None
        self._note("node_color", f"{node.bl_label} is drawn as the mean of its colors")
        colors = [self.color(socket, groups, depth) for socket in sockets]
        return tuple(sum(color[c] for color in colors) / len(colors) for c in range(3))


def _same(sockets: Any, wanted: Any) -> Any | None:
    found = next((s for s in sockets if s.identifier == wanted.identifier), None)
    return found or next((s for s in sockets if s.name == wanted.name), None)


def _as_color(socket: Any) -> Color:
    value = getattr(socket, "default_value", 0.0)
    if isinstance(value, (int, float)):
        return (float(value),) * 3
    try:
        return (float(value[0]), float(value[1]), float(value[2]))
    except (TypeError, IndexError):
        return (0.0, 0.0, 0.0)


def _as_number(socket: Any) -> float:
    value = getattr(socket, "default_value", 0.0)
    return float(value) if isinstance(value, (int, float)) else _luma(_as_color(socket))


def _luma(color: Color) -> float:
    return sum(weight * part for weight, part in zip(_WEIGHTS, color))
