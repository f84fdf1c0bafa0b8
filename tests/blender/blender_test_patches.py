# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards surfaces: patches of every kind of material look as Cycles (direct light only) shows them.

Both engines draw the same grid of squares and balls under one sun and a gray world. What is left
per patch (root mean square of the display-encoded picture, in 255ths, without its border) is
bounded by what was measured; povray_export/README.md lists it. With LODESTONE_PATCHES=FOLDER the
pictures stay in that folder (both.png beside each other, Cycles left), and what is left is printed;
LODESTONE_PATCH_CELL is the width of a patch in pixels.
"""

import math
import os
import tempfile
import unittest
from array import array
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import mathutils

import blender_scenes as scenes

CELL = int(os.environ.get("LODESTONE_PATCH_CELL", "32"))  # pixels
COLUMNS, ROWS = 5, 4
SUN = (0.35, 0.3, 0.8)  # the direction to it
POWER = 2.5
WORLD = 0.25


@dataclass
class Patch:
    name: str
    bound: float
    fields: dict = field(default_factory=dict)  # of the native material
    inputs: dict = field(default_factory=dict)  # of the principled node, where they differ
    ball: bool = False
    behind: bool = False  # half of what lies behind glows


def principled(name, bound, ball=False, behind=False, color=(0.8, 0.8, 0.8), **fields):
    """The same values under both names."""
    titles = {
        "base_color": "Base Color",
        "clearcoat_roughness": "Clearcoat Roughness",
        "ior": "IOR",
        **{key: key.title() for key in ("roughness", "metallic", "specular", "alpha")},
        **{key: key.title() for key in ("transmission", "clearcoat", "emission")},
    }
    fields = {"base_color": color, "specular": 0.0, **fields}
    inputs = {}
    for key, value in fields.items():
        if key in titles:
            inputs[titles[key]] = (*value, 1.0) if isinstance(value, tuple) else value
    return Patch(name, bound, fields, inputs, ball, behind)


def waves(width):
    """Rows of gray: hills that repeat."""
    for y in range(width):
        for x in range(width):
            turn = 2 * math.pi / width
            value = 0.5 + 0.25 * (math.sin(2 * turn * x) + math.sin(3 * turn * y))
            yield (value, value, value, 1.0)


def normals(width):
    """Of the hills of waves(), in a square of 1.8 m, .4 m high, as a normal map (green up)."""
    per_metre = 2 * math.pi / 1.8
    for y in range(width):
        for x in range(width):
            turn = 2 * math.pi / width
            across = 0.4 * 0.25 * 2 * per_metre * math.cos(2 * turn * (x + 0.5))
            along = 0.4 * 0.25 * 3 * per_metre * math.cos(3 * turn * (y + 0.5))
            length = math.sqrt(across**2 + along**2 + 1)
            yield (*(0.5 + 0.5 * v / length for v in (-across, -along, 1)), 1.0)


def spots(width, holes):
    """Colors, with holes or without (Cycles shows holes black where alpha is not used)."""
    for y in range(width):
        for x in range(width):
            inside = (x - width / 2) ** 2 + (y - width / 2) ** 2 < width**2 / 9
            yield (
                0.1 + 0.8 * x / width,
                0.2,
                0.1 + 0.8 * y / width,
                1.0 if inside or not holes else 0.0,
            )


PATCHES = [
    principled("albedo", 3, color=(0.6, 0.3, 0.1)),
    principled("dark", 3, color=(0.02, 0.05, 0.2)),
    principled("textured", 3),
    principled("vertex_color", 3),
    principled("emission", 3, color=(0.0, 0.0, 0.0), emission=(0.2, 0.5, 0.1)),
    principled("alpha", 3, color=(0.7, 0.2, 0.2), alpha=0.4, alpha_mode=1),
    principled("clip", 3, alpha_mode=2),
    principled("matte_ball", 6, ball=True),
    principled("plastic", 6, ball=True, color=(0.1, 0.3, 0.6), specular=0.5),
    principled("gloss", 6, ball=True, color=(0.6, 0.1, 0.1), specular=0.5, roughness=0.1),
    principled("metal", 10, ball=True, color=(0.9, 0.6, 0.3), metallic=1.0, roughness=0.15),
    principled("rough_metal", 12, ball=True, color=(0.9, 0.6, 0.3), metallic=1.0),
    principled("half_metal", 7, ball=True, color=(0.6, 0.6, 0.7), metallic=0.5, roughness=0.6),
    principled("rough", 6, ball=True, color=(0.5, 0.5, 0.5), specular=0.5, roughness=1.0),
    principled("coat", 6, ball=True, color=(0.3, 0.05, 0.05), clearcoat=1.0),
    principled(
        "glass",
        14,
        ball=True,
        behind=True,
        color=(0.9, 1.0, 0.9),
        specular=0.5,
        roughness=0.0,
        transmission=1.0,
    ),
    principled("bump", 9, color=(0.5, 0.5, 0.5)),
    principled("normal", 7, color=(0.5, 0.5, 0.5)),
    principled("mixed", 3, color=(0.8, 0.1, 0.1)),
]


def center(i):
    return (2.0 * (i % COLUMNS) - COLUMNS + 1, ROWS - 1 - 2.0 * (i // COLUMNS))


def square(size=0.9):
    corners = [(-size, -size, 0), (size, -size, 0), (size, size, 0), (-size, size, 0)]
    return corners, [(0, 1, 2, 3)], [(0, 0), (1, 0), (1, 1), (0, 1)]


def sphere(radius=0.9, around=64, high=32):
    points = [(0, 0, -radius)]
    for j in range(1, high):
        b = math.pi * j / high
        ring, z = radius * math.sin(b), -radius * math.cos(b)
        for i in range(around):
            a = 2 * math.pi * i / around
            points.append((ring * math.cos(a), ring * math.sin(a), z))
    points.append((0, 0, radius))
    top = len(points) - 1
    at = lambda j, i: 1 + (j - 1) * around + i % around  # noqa: E731
    faces = [(0, at(1, i + 1), at(1, i)) for i in range(around)]
    for j in range(1, high - 1):
        faces += [(at(j, i), at(j, i + 1), at(j + 1, i + 1), at(j + 1, i)) for i in range(around)]
    faces += [(at(high - 1, i), at(high - 1, i + 1), top) for i in range(around)]
    return points, faces, None


COLORS = [(1.0, 0.0, 0.2, 1.0), (0.0, 1.0, 0.2, 1.0), (0.5, 0.5, 1.0, 1.0), (0.0, 0.0, 0.0, 1.0)]


# ---- Blender ----


def blender_image(name, texels, linear):
    width = math.isqrt(len(texels))
    image = bpy.data.images.new(name, width, width, alpha=True, is_data=linear)
    image.pixels.foreach_set([value for texel in texels for value in texel])
    image.pack()
    return image


def blender_material(patch):
    material = scenes.material(patch.name)
    tree = material.node_tree
    node = tree.nodes["Principled BSDF"]
    for name, value in patch.inputs.items():
        node.inputs[name].default_value = value

    def made(kind, **values):
        item = tree.nodes.new(kind)
        for key, value in values.items():
            setattr(item, key, value)
        return item

    if patch.name in ("textured", "clip"):
        texels = list(spots(16, patch.name == "clip"))
        image = made("ShaderNodeTexImage", image=blender_image("Spots", texels, False))
        tree.links.new(image.outputs["Color"], node.inputs["Base Color"])
        if patch.name == "clip":
            image.interpolation = "Closest"
            tree.links.new(image.outputs["Alpha"], node.inputs["Alpha"])
    if patch.name == "vertex_color":
        colors = made("ShaderNodeVertexColor", layer_name="Color")
        tree.links.new(colors.outputs["Color"], node.inputs["Base Color"])
    if patch.name == "bump":
        image = made("ShaderNodeTexImage", image=blender_image("Waves", list(waves(32)), True))
        bump = made("ShaderNodeBump")
        bump.inputs["Strength"].default_value = 1.0
        bump.inputs["Distance"].default_value = 0.4
        tree.links.new(image.outputs["Color"], bump.inputs["Height"])
        tree.links.new(bump.outputs["Normal"], node.inputs["Normal"])
    if patch.name == "normal":
        image = made("ShaderNodeTexImage", image=blender_image("Normals", list(normals(64)), True))
        bump = made("ShaderNodeNormalMap")
        tree.links.new(image.outputs["Color"], bump.inputs["Color"])
        tree.links.new(bump.outputs["Normal"], node.inputs["Normal"])
    if patch.name == "mixed":
        other = made("ShaderNodeBsdfPrincipled")
        other.inputs["Base Color"].default_value = (0.1, 0.1, 0.8, 1.0)
        other.inputs["Specular"].default_value = 0.0
        mix = made("ShaderNodeMixShader")
        mix.inputs["Fac"].default_value = 0.3
        tree.links.new(node.outputs[0], mix.inputs[1])
        tree.links.new(other.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    return material


def blender_scene():
    scene = scenes.fresh()
    scene.render.engine = "CYCLES"
    scene.cycles.use_denoising = False
    scene.cycles.samples = 48
    scene.cycles.seed = 1
    scene.cycles.max_bounces = 8
    scene.cycles.diffuse_bounces = 0
    scene.cycles.glossy_bounces = 1
    scene.cycles.transmission_bounces = 8
    scene.cycles.pixel_filter_type = "BOX"
    scene.render.resolution_x, scene.render.resolution_y = CELL * COLUMNS, CELL * ROWS
    scene.render.image_settings.file_format = "PNG"
    scene.camera.data.type = "ORTHO"
    scene.camera.data.ortho_scale = 2 * COLUMNS
    sun = scenes.sun(energy=POWER)
    sun.rotation_euler = mathutils.Vector(SUN).to_track_quat("Z", "Y").to_euler()
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (WORLD, WORLD, WORLD, 1)
    for i, patch in enumerate(PATCHES):
        points, faces, uvs = sphere() if patch.ball else square()
        mesh = scenes.mesh(patch.name, points, faces)
        if patch.ball:
            mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
        if uvs is not None:
            layer = mesh.uv_layers.new()
            for loop in mesh.loops:
                layer.data[loop.index].uv = uvs[loop.vertex_index]
            colors = mesh.color_attributes.new("Color", "FLOAT_COLOR", "POINT")
            for k, color in enumerate(COLORS):
                colors.data[k].color = color
        mesh.materials.append(blender_material(patch))
        made = scenes.link(bpy.data.objects.new(patch.name, mesh))
        made.location = (*center(i), 0)
        if patch.behind:
            points, faces, _ = square(0.5)
            plate = scenes.mesh("Plate", points, faces)
            glow = principled("Plate", 0, color=(0.0, 0.0, 0.0), emission=(0.6, 0.2, 0.0))
            plate.materials.append(blender_material(glow))
            made = scenes.link(bpy.data.objects.new("Plate", plate))
            made.location = (center(i)[0] - 0.5, center(i)[1], -2)
    return scene


# ---- Lodestone ----


def native_mesh(native, shape, smooth):
    points, faces, uvs = shape
    positions = array("f", [value for point in points for value in point])
    triangles = array("I")
    for face in faces:
        for k in range(2, len(face)):
            triangles.extend((face[0], face[k - 1], face[k]))
    buffers = native.MeshBuffers(positions, triangles)
    if smooth:
        radius = max(points[0], key=abs)
        buffers.corner_normals = array("f", [value / abs(radius) for value in positions])
    if uvs is not None:
        buffers.corner_uvs = array("f", [value for uv in uvs for value in uv])
        buffers.corner_colors = array("f", [value for color in COLORS for value in color])
    return buffers


def native_material(native, model, patch):
    fields = dict(patch.fields)

    def picture(texels, linear):
        width = math.isqrt(len(texels))
        pixels = array("f", [value for texel in texels for value in texel])
        return model.add_picture("p", pixels=pixels, size=(width, width), linear=linear)

    if patch.name in ("textured", "clip"):
        closest = patch.name == "clip"
        spotted = picture(list(spots(16, closest)), False)
        fields["base_color_texture"] = native.texture(spotted, closest=closest)
        if closest:
            fields["alpha_texture"] = native.texture(spotted, native.Channel.ALPHA, closest=True)
    if patch.name == "vertex_color":
        fields.update(vertex_colors=1, base_color=(1.0, 1.0, 1.0))
    if patch.name == "bump":
        fields["bump_texture"] = native.texture(picture(list(waves(32)), True))
        fields["bump_distance"] = 0.4
    if patch.name == "normal":
        fields["normal_texture"] = native.texture(picture(list(normals(64)), True))
    if patch.name == "mixed":
        other = model.add_material("other", base_color=(0.1, 0.1, 0.8), specular=0.0)
        fields.update(other=1 + other, mix=0.3)
    return model.add_material(patch.name, **fields)


def render_ours(folder):
    from lodestone.core.native import lodestone_native as native

    with native.Model() as model:
        root = model.add_group("root", "root")
        model.set_root(root)
        model.set_world((WORLD, WORLD, WORLD))
        travels = tuple(-v for v in SUN)
        model.add_light(native.Light("sun", native.LightKind.SUN, power=POWER, direction=travels))

        def place(name, shape, smooth, material, at):
            item = model.add_mesh(name, name, native_mesh(native, shape, smooth), [material])
            model.add_placement(root, item, [1, 0, 0, at[0], 0, 1, 0, at[1], 0, 0, 1, at[2]], name)

        for i, patch in enumerate(PATCHES):
            shape = sphere() if patch.ball else square()
            material = native_material(native, model, patch)
            place(patch.name, shape, patch.ball, material, (*center(i), 0))
            if patch.behind:
                glow = model.add_material(
                    "glow", base_color=(0, 0, 0), specular=0, emission=(0.6, 0.2, 0)
                )
                at = (center(i)[0] - 0.5, center(i)[1], -2)
                place("plate", square(0.5), False, glow, at)
        camera = native.Camera(
            "c", True, (0, 0, 10), (0, 0, -1), (2 * COLUMNS, 0, 0), (0, 2 * ROWS, 0), 0.1
        )
        view = native.View(camera, CELL * COLUMNS, CELL * ROWS, 0.0)
        options = native.PovrayOptions(antialias=native.Antialias.REFERENCE)
        with native.Cut(model, view) as cut:
            native.povray_export(cut, folder, options)
        native.povray_run(folder, "ours.png", options)


def write_both(folder):
    from lodestone.core.native import lodestone_native as native

    left = native.image_read(os.path.join(folder, "cycles.png"))
    right = native.image_read(os.path.join(folder, "ours.png"))
    row = 4 * left.width
    pixels = array("f")
    for y in range(left.height):
        for image in (left, right):
            pixels.extend(image.pixels[row * y : row * (y + 1)])
    both = native.Image(2 * left.width, left.height, pixels)
    native.image_write_png(os.path.join(folder, "both.png"), both)


def pixels_of(path):
    """Rows of (r, g, b), 0...255 as the file encodes them, the lowest first."""
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    values = [0.0] * len(image.pixels)
    image.pixels.foreach_get(values)
    width = image.size[0]
    bpy.data.images.remove(image)
    texels = [tuple(255 * v for v in values[i : i + 3]) for i in range(0, len(values), 4)]
    return [texels[i : i + width] for i in range(0, len(texels), width)]


class Patches(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        folder = Path(os.environ.get("LODESTONE_PATCHES") or scratch.name)
        scene = blender_scene()
        scene.render.filepath = str(folder / "cycles.png")
        bpy.ops.render.render(write_still=True)
        render_ours(str(folder))
        cls.cycles = pixels_of(folder / "cycles.png")
        cls.ours = pixels_of(folder / "ours.png")
        if "LODESTONE_PATCHES" in os.environ:
            write_both(str(folder))

    def difference(self, i):
        """Root mean square over a patch, without its border."""
        left, low = CELL * (i % COLUMNS), CELL * (ROWS - 1 - i // COLUMNS)
        edge = CELL // 8
        squares = [
            (a - b) ** 2
            for y in range(low + edge, low + CELL - edge)
            for x in range(left + edge, left + CELL - edge)
            for a, b in zip(self.cycles[y][x], self.ours[y][x])
        ]
        return math.sqrt(sum(squares) / len(squares))

    def test_every_patch_is_as_near_to_cycles_as_was_measured(self):
        for i, patch in enumerate(PATCHES):
            with self.subTest(patch.name):
                left = self.difference(i)
                if "LODESTONE_PATCHES" in os.environ:
                    print(f"PATCH {patch.name:14} {left:6.2f} of {patch.bound}")
                self.assertLessEqual(left, patch.bound, patch.name)

    def test_the_pictures_show_something(self):
        for rows in (self.cycles, self.ours):
            values = [max(texel) for row in rows for texel in row]
            self.assertGreater(max(values), 200)
            self.assertLess(min(values), 60)


if __name__ == "__main__":
    unittest.main()
