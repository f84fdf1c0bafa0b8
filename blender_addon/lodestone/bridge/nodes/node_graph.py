# SPDX-License-Identifier: GPL-3.0-or-later
"""Ways through a node tree: from a socket to the node that really feeds it.

Reroutes, groups and muted nodes are passed through; muted and invalid links do not count.
"""

from dataclasses import dataclass
from typing import Any

MOST_STEPS = 64  # through reroutes and groups: deeper trees are a mistake or an attack


@dataclass(frozen=True)
class Feed:
    """`node` with the output `socket`; without a node the `socket` whose own value counts.
    `groups` are the group nodes around it, outermost first."""

    node: Any | None
    socket: Any
    groups: tuple[Any, ...] = ()


def feed(socket: Any, groups: tuple[Any, ...] = ()) -> Feed:
    """The node that feeds an input socket."""
    for _ in range(MOST_STEPS):
        link = link_to(socket)
        if link is None:
            return Feed(None, socket, groups)
        node, output = link.from_node, link.from_socket
        kind = node.type
        if node.mute:
            inner = next((ln for ln in node.internal_links if ln.to_socket == output), None)
            if inner is None:
                return Feed(None, socket, groups)
            socket = inner.from_socket
        elif kind == "REROUTE":
            socket = node.inputs[0]
        elif kind == "GROUP":
            inside = _group_output(node, output)
            if inside is None:
                return Feed(None, socket, groups)
            socket, groups = inside, (*groups, node)
        elif kind == "GROUP_INPUT" and groups:
            outside = _same(groups[-1].inputs, output)
            if outside is None:
                return Feed(None, socket, groups)
            socket, groups = outside, groups[:-1]
        else:
            return Feed(node, output, groups)
    return Feed(None, socket, groups)


def link_to(socket: Any) -> Any | None:
    """The socket's first link that is valid and not muted."""
    if not socket.is_linked:
        return None
    return next((link for link in socket.links if link.is_valid and not link.is_muted), None)


def has(item: Any, name: str) -> Any | None:
    """The socket of that name that is in use: several nodes have one for each type of data."""
    found = None
    for socket in item:
        if socket.name == name:
            if socket.enabled:
                return socket
            found = found or socket
    return found


def _group_output(node: Any, socket: Any) -> Any | None:
    """The socket inside a group node that feeds this output of it."""
    if node.node_tree is None:
        return None
    outputs = [n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT"]
    output = next((n for n in outputs if n.is_active_output), None)
    return _same(output.inputs, socket) if output else None


def _same(sockets: Any, wanted: Any) -> Any | None:
    found = next((s for s in sockets if s.identifier == wanted.identifier), None)
    return found or next((s for s in sockets if s.name == wanted.name), None)
