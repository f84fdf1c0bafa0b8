# SPDX-License-Identifier: GPL-3.0-or-later
"""Nodes in a panel, as the stock ones show them, but only the inputs that make a difference."""


def shader_behind(output, name):
    """The node that feeds an input of an output node; None when nothing does."""
    socket = output.inputs.get(name) if output is not None else None
    if socket is None or not socket.is_linked:
        return None
    return socket.links[0].from_node


def draw_node(layout, tree, output, name, inputs=None):
    """The tree behind an input of its output node. `inputs`: names of the inputs to show of the
    node right behind it; None shows all."""
    socket = output.inputs.get(name) if output is not None else None
    if socket is None:
        layout.label(text="No output node")
        return
    shader = shader_behind(output, name)
    if inputs is None or shader is None:
        layout.template_node_view(tree, output, socket)
        return
    split = layout.split(factor=0.4)
    label = split.row()
    label.alignment = "RIGHT"
    label.label(text=name)
    split.template_node_link(tree, output, socket)
    layout.separator()
    for wanted in inputs:
        found = shader.inputs.get(wanted)
        if found is not None and found.enabled:
            layout.template_node_view(tree, shader, found)
