# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials: principled, flat values; named as a designer would."""

import bpy

# Name: (red, green, blue as displayed 0..255), roughness, metallic
PALETTE = {
    "Brick Red": ((158, 84, 66), 0.85, 0),
    "Brick Brown": ((126, 88, 68), 0.85, 0),
    "Brick Sand": ((196, 164, 122), 0.85, 0),
    "Mortar": ((178, 170, 158), 0.95, 0),
    "Stone": ((160, 156, 146), 0.9, 0),
    "Plaster White": ((232, 226, 214), 0.8, 0),
    "Plaster Ochre": ((224, 186, 118), 0.8, 0),
    "Plaster Rose": ((222, 170, 152), 0.8, 0),
    "Plaster Sage": ((168, 184, 156), 0.8, 0),
    "Siding Blue": ((112, 140, 166), 0.65, 0),
    "Siding White": ((226, 228, 226), 0.65, 0),
    "Siding Yellow": ((226, 202, 132), 0.65, 0),
    "Siding Green": ((118, 146, 124), 0.65, 0),
    "Interior Wall": ((236, 230, 218), 0.9, 0),
    "Oak Floor": ((170, 124, 80), 0.5, 0),
    "Tile Terracotta": ((184, 94, 62), 0.75, 0),
    "Tile Rust": ((146, 70, 52), 0.75, 0),
    "Slate": ((84, 90, 100), 0.6, 0),
    "Slate Brown": ((98, 82, 74), 0.7, 0),
    "Roof Gravel": ((150, 148, 144), 0.95, 0),
    "Trim White": ((240, 240, 236), 0.45, 0),
    "Trim Dark": ((58, 60, 64), 0.45, 0),
    "Window Glass": ((22, 28, 36), 0.06, 0),
    "Door Red": ((150, 36, 34), 0.35, 0),
    "Door Green": ((38, 86, 64), 0.35, 0),
    "Door Blue": ((40, 66, 112), 0.35, 0),
    "Zinc": ((152, 158, 162), 0.35, 1),
    "Steel": ((190, 192, 194), 0.25, 1),
    "Brass": ((206, 168, 92), 0.3, 1),
    "Iron": ((44, 46, 50), 0.5, 0),
    "Wood Light": ((196, 154, 104), 0.55, 0),
    "Wood Dark": ((98, 64, 42), 0.5, 0),
    "Fence White": ((230, 230, 224), 0.7, 0),
    "Fence Wood": ((150, 112, 76), 0.8, 0),
    "Fabric Blue": ((72, 94, 132), 0.95, 0),
    "Fabric Grey": ((138, 136, 134), 0.95, 0),
    "Fabric Red": ((160, 62, 56), 0.95, 0),
    "Linen": ((236, 232, 224), 0.95, 0),
    "Ceramic": ((244, 244, 242), 0.15, 0),
    "Book Red": ((140, 48, 44), 0.7, 0),
    "Book Blue": ((50, 76, 120), 0.7, 0),
    "Book Green": ((60, 100, 70), 0.7, 0),
    "Lamp Shade": ((250, 238, 206), 0.6, 0),
    "Bark": ((92, 72, 56), 0.95, 0),
    "Birch Bark": ((222, 218, 208), 0.85, 0),
    "Leaves Oak": ((84, 116, 46), 0.9, 0),
    "Leaves Maple": ((182, 106, 44), 0.9, 0),
    "Leaves Linden": ((112, 142, 58), 0.9, 0),
    "Leaves Birch": ((146, 166, 70), 0.85, 0),
    "Leaves Cherry": ((232, 176, 188), 0.85, 0),
    "Needles": ((44, 82, 58), 0.95, 0),
    "Hedge": ((66, 104, 48), 0.95, 0),
    "Flowers": ((214, 84, 112), 0.8, 0),
    "Asphalt": ((88, 88, 92), 0.95, 0),
    "Road Paint": ((236, 236, 230), 0.8, 0),
    "Kerb": ((176, 174, 168), 0.9, 0),
    "Paving": ((186, 180, 170), 0.9, 0),
    "Drive": ((162, 150, 138), 0.9, 0),
    "Lawn": ((116, 146, 72), 0.95, 0),
    "Meadow": ((138, 154, 84), 0.95, 0),
    "Field Wheat": ((196, 178, 110), 0.95, 0),
    "Field Green": ((110, 140, 72), 0.95, 0),
    "Soil": ((132, 108, 82), 0.95, 0),
    "Paint Silver": ((188, 192, 196), 0.25, 0.6),
    "Paint Red": ((168, 30, 32), 0.2, 0.1),
    "Paint Blue": ((34, 70, 140), 0.2, 0.2),
    "Paint White": ((238, 238, 236), 0.2, 0),
    "Paint Green": ((40, 92, 72), 0.2, 0.2),
    "Paint Black": ((30, 32, 36), 0.15, 0.2),
    "Rubber": ((28, 28, 30), 0.9, 0),
    "Lamp Red": ((190, 24, 20), 0.2, 0),
    "Post Red": ((196, 40, 38), 0.4, 0),
}
CAR_PAINTS = [name for name in PALETTE if name.startswith("Paint ")]


def linear(value):
    """Display value 0..255 as scene-linear 0..1."""
    v = value / 255
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4


def get(name):
    """The material of that name, made at first use."""
    material = bpy.data.materials.get(name)
    if material:
        return material
    color, roughness, metallic = PALETTE[name]
    rgba = (*(linear(c) for c in color), 1.0)
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = rgba
    shader.inputs["Roughness"].default_value = roughness
    shader.inputs["Metallic"].default_value = metallic
    material.diffuse_color = rgba
    material.roughness = roughness
    material.metallic = metallic
    return material
