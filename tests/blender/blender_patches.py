# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets of patches, drawn by Cycles (direct light only) and by Lodestone, and what they differ.

A sheet is a grid of squares and balls under a gray world, with or without a sun. With
LODESTONE_PATCHES=FOLDER the pictures of a sheet stay in FOLDER/<name> (both.png beside each other,
Cycles left), and what is left is printed; LODESTONE_PATCH_CELL is the width of a patch in pixels.
"""

import math
import os
import tempfile
from array import array
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import mathutils

import blender_scenes as scenes

CELL = int(os.environ.get("LODESTONE_PATCH_CELL", "32"))  # pixels
SUN = (0.35, 0.3, 0.8)  # the direction to it


@dataclass
class Patch:
    name: str
    bound: float
    fields: dict = field(default_factory=dict)  # of the native material
    inputs: dict = field(default_factory=dict)  # of the principled node, where they differ
    ball: bool = False
    behind: bool = False  # half of what lies behind glows

    @property
    def kind(self):
        """First word of the name: says what pictures and nodes it has."""
        return self.name.split()[0]


@dataclass
class Sheet:
    name: str
    patches: list  # in rows, from above
    columns: int
    world: float  # radiance
    power: float  # of the sun, W/m2

    @property
    def rows(self):
        return math.ceil(len(self.patches) / self.columns)

    def center(self, i):
        x = 2.0 * (i % self.columns) - self.columns + 1
        return (x, self.rows - 1 - 2.0 * (i // self.columns))


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


def halves(width):
    """Left black, right as red as can be."""
    for i in range(width * width):
        yield (0.0 if i % width < width / 2 else 0.9, 0.0, 0.0, 1.0)


def square(size=0.9):
    corners = [(-size, -size, 0), (size, -size, 0), (size, size, 0), (-size, size, 0)]
    return corners, [(0, 1, 2, 3)], [(0, 0), (1, 0), (1, 1), (0, 1)]


def sphere(radius=0.9, around=64, high=32):
    points = [(0, 0, -radius)]
    for j in range(1, high):
        b = math.pi * j / high
        ring, z = radius * math.sin(b), -radius * math.cos(b)
        for i in range(around):
            # POV-Ray meshes leak where a ray meets a vertex: turned, none does.
            a = 2 * math.pi * i / around + 0.1
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

    if patch.kind in ("textured", "clip", "halves"):
        clip = patch.kind == "clip"
        texels = list(halves(16) if patch.kind == "halves" else spots(16, clip))
        image = made("ShaderNodeTexImage", image=blender_image("Spots", texels, False))
        tree.links.new(image.outputs["Color"], node.inputs["Base Color"])
        if clip:
            image.interpolation = "Closest"
            tree.links.new(image.outputs["Alpha"], node.inputs["Alpha"])
    if patch.kind == "vertex_color":
        colors = made("ShaderNodeVertexColor", layer_name="Color")
        tree.links.new(colors.outputs["Color"], node.inputs["Base Color"])
    if patch.kind == "bump":
        image = made("ShaderNodeTexImage", image=blender_image("Waves", list(waves(32)), True))
        bump = made("ShaderNodeBump")
        bump.inputs["Strength"].default_value = 1.0
        bump.inputs["Distance"].default_value = 0.4
        tree.links.new(image.outputs["Color"], bump.inputs["Height"])
        tree.links.new(bump.outputs["Normal"], node.inputs["Normal"])
    if patch.kind == "normal":
        image = made("ShaderNodeTexImage", image=blender_image("Normals", list(normals(64)), True))
        bump = made("ShaderNodeNormalMap")
        tree.links.new(image.outputs["Color"], bump.inputs["Color"])
        tree.links.new(bump.outputs["Normal"], node.inputs["Normal"])
    if patch.kind == "mixed":
        other = made("ShaderNodeBsdfPrincipled")
        other.inputs["Base Color"].default_value = (0.1, 0.1, 0.8, 1.0)
        other.inputs["Specular"].default_value = 0.0
        mix = made("ShaderNodeMixShader")
        mix.inputs["Fac"].default_value = 0.3
        tree.links.new(node.outputs[0], mix.inputs[1])
        tree.links.new(other.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    return material


def blender_scene(sheet):
    scene = scenes.fresh()
    scene.render.engine = "CYCLES"
    scene.cycles.use_denoising = False
    scene.cycles.samples = 48
    scene.cycles.seed = 1
    scene.cycles.max_bounces = 8
    scene.cycles.diffuse_bounces = 0
    scene.cycles.glossy_bounces = 1
    scene.cycles.transmission_bounces = 8
    scene.cycles.pixel_filter_type, scene.render.filter_size = "BOX", 0.01
    scene.render.resolution_x, scene.render.resolution_y = CELL * sheet.columns, CELL * sheet.rows
    scene.render.image_settings.file_format = "PNG"
    scene.camera.data.type = "ORTHO"
    scene.camera.data.ortho_scale = 2 * max(sheet.columns, sheet.rows)
    if sheet.power > 0:
        sun = scenes.sun(energy=sheet.power)
        sun.rotation_euler = mathutils.Vector(SUN).to_track_quat("Z", "Y").to_euler()
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (sheet.world, sheet.world, sheet.world, 1)
    for i, patch in enumerate(sheet.patches):
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
        made.location = (*sheet.center(i), 0)
        if patch.behind:
            points, faces, _ = square(0.5)
            plate = scenes.mesh("Plate", points, faces)
            glow = principled("Plate", 0, color=(0.0, 0.0, 0.0), emission=(0.6, 0.2, 0.0))
            plate.materials.append(blender_material(glow))
            made = scenes.link(bpy.data.objects.new("Plate", plate))
            made.location = (sheet.center(i)[0] - 0.5, sheet.center(i)[1], -2)
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

    if patch.kind in ("textured", "clip", "halves"):
        closest = patch.kind == "clip"
        texels = list(halves(16) if patch.kind == "halves" else spots(16, closest))
        spotted = picture(texels, False)
        fields["base_color_texture"] = native.texture(spotted, closest=closest)
        if closest:
            fields["alpha_texture"] = native.texture(spotted, native.Channel.ALPHA, closest=True)
    if patch.kind == "vertex_color":
        fields.update(vertex_colors=1, base_color=(1.0, 1.0, 1.0))
    if patch.kind == "bump":
        fields["bump_texture"] = native.texture(picture(list(waves(32)), True))
        fields["bump_distance"] = 0.4
    if patch.kind == "normal":
        fields["normal_texture"] = native.texture(picture(list(normals(64)), True))
    if patch.kind == "mixed":
        other = model.add_material("other", base_color=(0.1, 0.1, 0.8), specular=0.0)
        fields.update(other=1 + other, mix=0.3)
    return model.add_material(patch.name, **fields)


def render_ours(sheet, folder):
    from lodestone.core.native import lodestone_native as native

    with native.Model() as model:
        root = model.add_group("root", "root")
        model.set_root(root)
        model.set_world((sheet.world,) * 3)
        if sheet.power > 0:
            travels = tuple(-v for v in SUN)
            sun = native.Light("sun", native.LightKind.SUN, power=sheet.power, direction=travels)
            model.add_light(sun)

        def place(name, shape, smooth, material, at):
            item = model.add_mesh(name, name, native_mesh(native, shape, smooth), [material])
            model.add_placement(root, item, [1, 0, 0, at[0], 0, 1, 0, at[1], 0, 0, 1, at[2]], name)

        for i, patch in enumerate(sheet.patches):
            shape = sphere() if patch.ball else square()
            material = native_material(native, model, patch)
            place(patch.name, shape, patch.ball, material, (*sheet.center(i), 0))
            if patch.behind:
                glow = model.add_material(
                    "glow", base_color=(0, 0, 0), specular=0, emission=(0.6, 0.2, 0)
                )
                at = (sheet.center(i)[0] - 0.5, sheet.center(i)[1], -2)
                place("plate", square(0.5), False, glow, at)
        right, up = (2 * sheet.columns, 0, 0), (0, 2 * sheet.rows, 0)
        camera = native.Camera("c", True, (0, 0, 10), (0, 0, -1), right, up, 0.1)
        view = native.View(camera, CELL * sheet.columns, CELL * sheet.rows, 0.0)
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


def draw(sheet):
    """Rows of pixels, the lowest first, by Cycles and by Lodestone."""
    with tempfile.TemporaryDirectory() as scratch:
        kept = os.environ.get("LODESTONE_PATCHES")
        folder = Path(kept) / sheet.name if kept else Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        blender_scene(sheet).render.filepath = str(folder / "cycles.png")
        bpy.ops.render.render(write_still=True)
        render_ours(sheet, str(folder))
        if kept:
            write_both(str(folder))
        return pixels_of(folder / "cycles.png"), pixels_of(folder / "ours.png")


def difference(sheet, i, cycles, ours):
    """Root mean square over a patch, without its border."""
    left, low = CELL * (i % sheet.columns), CELL * (sheet.rows - 1 - i // sheet.columns)
    edge = CELL // 8
    squares = [
        (a - b) ** 2
        for y in range(low + edge, low + CELL - edge)
        for x in range(left + edge, left + CELL - edge)
        for a, b in zip(cycles[y][x], ours[y][x])
    ]
    return math.sqrt(sum(squares) / len(squares))


def check(test, sheet, cycles, ours):
    """That every patch is as near to Cycles as its bound."""
    for i, patch in enumerate(sheet.patches):
        with test.subTest(patch.name):
            left = difference(sheet, i, cycles, ours)
            if "LODESTONE_PATCHES" in os.environ:
                print(f"PATCH {patch.name:24} {left:6.2f} of {patch.bound}")
            test.assertLessEqual(left, patch.bound, patch.name)
