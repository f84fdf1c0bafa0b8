# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards textures: where images come from and where they lie, down to the corners of a mesh."""

import math
import os
import shutil
import struct
import tempfile
import unittest
import zlib
from pathlib import Path

import bpy

import blender_scenes as scenes
from blender_test_materials import MaterialCase


def png(red, green, blue):
    """The bytes of a PNG of one pixel."""

    def chunk(kind, data):
        return (
            struct.pack(">I", len(data))
            + kind
            + data
            + struct.pack(">I", zlib.crc32(kind + data) & 0xFFFFFFFF)
        )

    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(bytes((0, red, green, blue))))
        + chunk(b"IEND", b"")
    )


class TextureCase(MaterialCase):
    def setUp(self):
        super().setUp()
        self.folder = Path(tempfile.mkdtemp(prefix="lodestone_textures_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def load(self, name, content, **how):
        """An image texture of a file's bytes that feeds the base color."""
        path = self.folder / name
        path.write_bytes(content)
        node = self.node("ShaderNodeTexImage", ("Color", self.base))
        node.image = bpy.data.images.load(str(path), **how)
        return node


class Images(TextureCase):
    def base_color(self):
        look, self.codes = self.translate()
        return self.added[0]["base_color"]

    def test_a_file_is_read_without_blenders_memory(self):
        node = self.load("red.png", png(255, 0, 0))
        self.close(self.base_color(), (1.0, 0.0, 0.0))
        self.assertEqual((self.codes, node.image.has_data), (set(), False))

    def test_a_relative_path_is_that_of_the_blend_file(self):
        node = self.load("red.png", png(255, 0, 0))
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "scene.blend"), check_existing=False)
        node.image.filepath = "//red.png"
        self.close(self.base_color(), (1.0, 0.0, 0.0))

    def test_a_packed_image_is_its_bytes(self):
        node = self.load("green.png", png(0, 255, 0))
        node.image.pack()
        os.remove(self.folder / "green.png")
        look, codes = self.translate()
        self.assertEqual((codes, look.base_color.texture.picture.kind), (set(), "packed"))
        self.close(self.added[0]["base_color"], (0.0, 1.0, 0.0))

    def test_a_png_that_says_it_is_times_alpha_is_read_as_any_other_as_by_cycles(self):
        made = bpy.data.images.new("Half", 2, 2, alpha=True)
        made.pixels = [1.0, 0.5, 0.0, 0.5] * 4
        made.filepath_raw, made.file_format = str(self.folder / "half.png"), "PNG"
        made.save()
        node = self.node("ShaderNodeTexImage", ("Color", self.base))
        node.image = bpy.data.images.load(made.filepath_raw)
        found = []
        for mode in ("STRAIGHT", "PREMUL"):
            node.image.alpha_mode = mode
            found.append(self.base_color())
        self.close(found[0], found[1])

    def test_cubic_interpolation_is_named(self):
        node = self.load("red.png", png(255, 0, 0))
        node.interpolation = "Cubic"
        self.assertEqual(self.translate()[1], {"interpolation"})

    def test_other_formats_come_through_blender(self):
        image = self.image([(1, 0, 0, 1), (0, 0, 1, 1)])
        for kind, ending in (("TARGA", "tga"), ("BMP", "bmp"), ("TIFF", "tif"), ("HDR", "hdr")):
            path = self.folder / f"picture.{ending}"
            bpy.context.scene.render.image_settings.file_format = kind
            image.save_render(str(path))
            node = self.node("ShaderNodeTexImage", ("Color", self.base))
            node.image = bpy.data.images.load(str(path))
            self.close(self.base_color(), (0.5, 0.0, 0.5), places=2)
            self.assertEqual((self.codes, node.image.has_data), (set(), False), kind)

    def test_a_painted_image_counts_as_it_is_seen(self):
        node = self.load("red.png", png(255, 0, 0))
        node.image.pixels[:] = (0.0, 0.0, 1.0, 1.0)
        self.close(self.base_color(), (0.0, 0.0, 1.0))

    def test_the_same_numbers_are_color_or_data(self):
        node = self.load("gray.png", png(188, 188, 188))
        self.close(self.base_color(), (0.5028865,) * 3, places=4)
        node.image.colorspace_settings.name = "Non-Color"
        self.close(self.base_color(), (188 / 255,) * 3)
        node.image.colorspace_settings.name = "Filmic Log"
        self.base_color()
        self.assertEqual(self.codes, {"color_space"})

    def test_a_missing_image_is_magenta_and_an_error(self):
        node = self.load("red.png", png(255, 0, 0))
        os.remove(self.folder / "red.png")
        self.close(self.base_color(), (1.0, 0.0, 1.0))
        self.assertEqual(self.severity, {"image_missing": "error"})
        node.image = None
        self.close(self.base_color(), (1.0, 0.0, 1.0))
        self.assertEqual(self.severity, {"image_missing": "error"})

    def test_files_that_are_no_images_are_magenta_and_an_error(self):
        os.mkfifo(self.folder / "pipe.png")
        broken = (b"", b"\x89PNG\r\n\x1a\n" + b"x" * 60, b"\xff\xd8\xff", os.urandom(512))
        for number, content in enumerate(broken):
            self.load(f"broken{number}.png", content, check_existing=False)
            self.close(self.base_color(), (1.0, 0.0, 1.0))
            self.assertEqual(self.severity, {"image_missing": "error"})
        for path in (self.folder, self.folder / "pipe.png", Path("/dev/zero"), Path("\0")):
            image = bpy.data.images.new("Odd", 1, 1)
            image.source = "FILE"
            image.filepath = str(path)
            node = self.node("ShaderNodeTexImage", ("Color", self.base))
            node.image = image
            self.close(self.base_color(), (1.0, 0.0, 1.0))

    def test_a_sequence_shows_the_file_of_its_frame(self):
        from lodestone.bridge.nodes.image_sources import source_of

        for number, color in ((1, (255, 0, 0)), (2, (0, 255, 0)), (12, (0, 0, 255))):
            (self.folder / f"clip v2 {number:04d}.png").write_bytes(png(*color))
        node = self.node("ShaderNodeTexImage", ("Color", self.base))
        node.image = bpy.data.images.load(str(self.folder / "clip v2 0001.png"))
        node.image.source = "SEQUENCE"
        user = node.image_user
        user.frame_duration, user.frame_start, user.use_auto_refresh = 12, 1, True

        def shown(frame):
            return Path(source_of(node.image, user, frame, print).path).name[8:12]

        self.assertEqual([shown(f) for f in (1, 2, 12, 99)], "0001 0002 0012 0012".split())
        user.use_cyclic = True
        self.assertEqual([shown(f) for f in (13, 24)], ["0001", "0012"])
        user.frame_start, user.frame_offset, user.use_cyclic = 11, 1, False
        self.assertEqual(shown(11), "0002")

    def test_checking_called_a_sequence_missing_that_does_not_refresh_by_itself(self):
        from lodestone.core.session.addon_session import addon_session

        (self.folder / "clip 0002.png").write_bytes(png(0, 255, 0))
        node = self.node("ShaderNodeTexImage", ("Color", self.base))
        node.image = bpy.data.images.load(str(self.folder / "clip 0002.png"))
        node.image.source = "SEQUENCE"
        node.image_user.frame_duration, node.image_user.use_auto_refresh = 5, False
        scene = bpy.context.scene
        scene.frame_set(2)
        bpy.ops.mesh.primitive_plane_add()
        bpy.context.object.data.materials.append(self.material)
        bpy.ops.lodestone.check_scene()
        codes = {problem.code for problem in addon_session().checks.get(scene.name).problems}
        self.assertNotIn("image_missing", codes)
        os.remove(self.folder / "clip 0002.png")
        bpy.ops.lodestone.check_scene()
        codes = {problem.code for problem in addon_session().checks.get(scene.name).problems}
        self.assertIn("image_missing", codes)

    def test_of_tiles_the_first_is_drawn_and_named(self):
        for tile, color in ((1001, (255, 0, 0)), (1002, (0, 255, 0))):
            (self.folder / f"skin.{tile}.png").write_bytes(png(*color))
        node = self.node("ShaderNodeTexImage", ("Color", self.base))
        node.image = bpy.data.images.load(str(self.folder / "skin.1001.png"))
        node.image.source = "TILED"
        self.close(self.base_color(), (1.0, 0.0, 0.0))
        self.assertEqual(self.codes, {"udim"})

    def test_checking_reads_no_image_and_names_the_missing_ones(self):
        from lodestone.bridge.nodes.materials import Materials
        from lodestone.core.problems import Problems

        node = self.load("red.png", b"no image at all")
        problems = Problems()
        Materials(None, problems).index(self.material)
        self.assertEqual((len(problems), node.image.has_data), (0, False))
        os.remove(self.folder / "red.png")
        Materials(None, problems).index(self.material)
        self.assertEqual([p.code for p in problems], ["image_missing"])


class Coordinates(TextureCase):
    """On a plane from (-1, -1, 0) to (1, 1, 0), whose uvs are 0...1."""

    def setUp(self):
        super().setUp()
        bpy.ops.mesh.primitive_plane_add(size=2.0)
        self.plane = bpy.context.object
        self.plane.data.materials.append(self.material)
        self.image_node = self.picture(self.base)

    def uvs(self, item=None):
        """(x, y, z) to the picture's coordinates of every corner of an object, and codes."""
        look, codes = self.translate()
        from lodestone.bridge.nodes.materials import Wanted
        from lodestone.bridge.scene import mesh_buffers

        depsgraph = bpy.context.evaluated_depsgraph_get()
        shown = (item or self.plane).evaluated_get(depsgraph)
        buffers = mesh_buffers.extract(shown, [Wanted(look.coordinates, look.vertex_colors)])
        rows = look.base_color.texture.to_picture if look.base_color.texture else None
        found = {}
        for corner, vertex in enumerate(buffers.corner_vertices):
            if buffers.corner_uvs is None or rows is None:
                break
            u, v = buffers.corner_uvs[2 * corner : 2 * corner + 2]
            place = tuple(round(c, 4) for c in buffers.positions[3 * vertex : 3 * vertex + 3])
            at = (rows[0] * u + rows[1] * v + rows[2], rows[3] * u + rows[4] * v + rows[5])
            found.setdefault(place, set()).add(tuple(round(c, 4) + 0.0 for c in at))
        self.buffers = buffers
        return found, codes

    def feed(self, kind, output, **values):
        return self.node(kind, (output, self.image_node.inputs["Vector"]), **values)

    def test_uvs_are_those_of_the_layer_that_is_named_or_rendered(self):
        found, codes = self.uvs()
        self.assertEqual((found[(1.0, -1.0, 0.0)], codes), ({(1.0, 0.0)}, set()))
        second = self.plane.data.uv_layers.new(name="Second")
        for loop in second.data:
            loop.uv = (0.25, 0.75)
        self.feed("ShaderNodeUVMap", 0).uv_map = "Second"
        self.assertEqual(self.uvs()[0][(1.0, -1.0, 0.0)], {(0.25, 0.75)})
        self.feed("ShaderNodeTexCoord", "UV")
        self.assertEqual(self.uvs()[0][(1.0, -1.0, 0.0)], {(1.0, 0.0)})
        self.feed("ShaderNodeUVMap", 0).uv_map = "Not there"
        self.assertEqual(self.uvs()[0][(1.0, -1.0, 0.0)], {(0.0, 0.0)})

    def test_mapping_points_textures_and_vectors(self):
        turn = (0.0, 0.0, math.radians(90))
        for kind, expected in (
            ("POINT", (0.1, 2.2)),
            ("VECTOR", (0.0, 2.0)),
            ("TEXTURE", (-0.1, -0.3)),
        ):
            mapping = self.feed("ShaderNodeMapping", 0, Location=(0.1, 0.2, 0), Rotation=turn)
            mapping.inputs["Scale"].default_value = (2.0, 3.0, 1.0)
            mapping.vector_type = kind
            self.node("ShaderNodeTexCoord", ("UV", mapping.inputs["Vector"]))
            found, codes = self.uvs()
            self.close(next(iter(found[(1.0, -1.0, 0.0)])), expected, places=4)
            self.assertEqual(codes, set())

    def test_mappings_in_a_row_and_vector_math_are_followed(self):
        scale = self.feed("ShaderNodeVectorMath", 0)
        scale.operation = "MULTIPLY"
        scale.inputs[1].default_value = (10.0, 10.0, 1.0)
        mapping = self.node("ShaderNodeMapping", (0, scale.inputs[0]), Location=(0.5, 0, 0))
        self.node("ShaderNodeUVMap", (0, mapping.inputs["Vector"]))
        found, codes = self.uvs()
        self.assertEqual((found[(1.0, -1.0, 0.0)], codes), ({(15.0, 0.0)}, set()))

    def test_generated_coordinates_fill_the_bound(self):
        self.feed("ShaderNodeTexCoord", "Generated")
        found, codes = self.uvs()
        self.assertEqual((found[(1.0, -1.0, 0.0)], codes), ({(1.0, 0.0)}, set()))
        cube = scenes.cube(size=4.0)
        cube.data.materials.append(self.material)
        self.assertEqual(self.uvs(cube)[0][(2.0, -2.0, 2.0)], {(1.0, 0.0)})

    def test_object_coordinates_are_positions(self):
        self.plane.location = (5, 5, 5)
        self.feed("ShaderNodeTexCoord", "Object")
        self.assertEqual(self.uvs()[0][(1.0, -1.0, 0.0)], {(1.0, -1.0)})

    def test_another_objects_coordinates_follow_both_objects(self):
        other = scenes.link(bpy.data.objects.new("Projector", None))
        other.location, other.scale = (1, 0, 0), (2, 2, 2)
        self.plane.location = (5, 0, 0)
        self.feed("ShaderNodeTexCoord", "Object").object = other
        bpy.context.view_layer.update()
        self.assertEqual(self.uvs()[0][(1.0, -1.0, 0.0)], {(2.5, -0.5)})
        twin = scenes.link(self.plane.copy())
        twin.location = (7, 0, 0)
        scenes.cube().data.materials.append(scenes.material("Plain"))
        extraction, request = scenes.extract()
        self.addCleanup(extraction.model.close)
        self.assertEqual(request.differences, [])
        self.assertEqual(len(extraction.leaves), 3)  # the twins share a mesh, not its coordinates

    def test_box_projection_takes_the_side_a_face_looks_to(self):
        self.image_node.projection = "BOX"
        self.feed("ShaderNodeTexCoord", "Object")
        cube = scenes.cube(size=2.0)
        found, codes = self.uvs(cube)
        # to +x (y, z); to +y (1 - x, z); to +z (1 - y, x)
        self.assertEqual(found[(1.0, 1.0, 1.0)], {(1.0, 1.0), (0.0, 1.0)})
        self.assertEqual(found[(-1.0, -1.0, -1.0)], {(2.0, -1.0), (-1.0, -1.0)})
        self.assertEqual(codes, set())

    def test_sphere_and_tube_have_no_seam(self):
        bpy.ops.mesh.primitive_uv_sphere_add(radius=0.5)
        ball = bpy.context.object
        for kind in ("SPHERE", "TUBE"):
            self.image_node.projection = kind
            self.feed("ShaderNodeTexCoord", "Generated")
            self.uvs(ball)
            ends = [*self.buffers.face_starts, len(self.buffers.corner_vertices)]
            for start, end in zip(ends, ends[1:]):
                u = self.buffers.corner_uvs[2 * start : 2 * end : 2]
                self.assertLess(max(u) - min(u), 0.25)

    def test_a_slot_has_the_coordinates_of_its_first_image(self):
        rough = self.picture(self.principled.inputs["Roughness"], data=True)
        self.node("ShaderNodeTexCoord", ("Generated", rough.inputs["Vector"]))
        look, codes = self.translate()
        self.assertEqual((look.coordinates.kind, look.roughness.texture), ("UV", None))
        self.assertAlmostEqual(look.roughness.number, 0.5, places=5)
        self.assertEqual(codes, {"texture_mean"})

    def test_slots_have_each_their_own_coordinates(self):
        from lodestone.bridge.nodes.materials import Wanted
        from lodestone.bridge.nodes.texture_coordinates import Coordinates
        from lodestone.bridge.scene import mesh_buffers

        data = scenes.mesh(
            "Two",
            [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)],
            [(0, 1, 2, 3), (1, 4, 5, 2)],
        )
        data.polygons[1].material_index = 7  # counts as the last slot
        for name, value in (("A", (0.25, 0.25)), ("B", (0.5, 0.5))):
            layer = data.uv_layers.new(name=name)
            for loop in layer.data:
                loop.uv = value
        item = scenes.link(bpy.data.objects.new("Two", data))
        shown = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
        buffers = mesh_buffers.extract(shown, [Wanted(Coordinates(name=n)) for n in "AB"])
        self.close(buffers.corner_uvs, [0.25] * 8 + [0.5] * 8)
        wanted = [Wanted(Coordinates(name="B")), Wanted(Coordinates("OBJECT"))]
        buffers = mesh_buffers.extract(shown, wanted)
        self.close(buffers.corner_uvs, [0.5] * 8 + [1, 0, 2, 0, 2, 1, 1, 1])
        buffers = mesh_buffers.extract(shown, [Wanted(), Wanted()])
        self.assertIsNone(buffers.corner_uvs)

    def test_coordinates_that_cannot_be_followed_give_the_mean_and_are_named(self):
        for output in ("Normal", "Camera", "Window", "Reflection"):
            self.feed("ShaderNodeTexCoord", output)
            look, codes = self.translate()
            self.assertEqual((codes, look.coordinates), ({"texture_coordinates"}, None))
            self.close(look.base_color.color, (0.5, 0.5, 0.5))

    def test_extension_and_interpolation_are_kept(self):
        for name, number in (("REPEAT", 0), ("EXTEND", 1), ("CLIP", 2)):
            self.image_node.extension = name
            self.image_node.interpolation = "Closest" if number else "Cubic"
            texture = self.translate()[0].base_color.texture
            self.assertEqual((texture.extension, texture.closest), (number, number > 0))


class VertexColors(TextureCase):
    def colored(self, domain="CORNER", kind="BYTE_COLOR"):
        data = scenes.mesh("Leaf", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
        attribute = data.color_attributes.new(name="Paint", type=kind, domain=domain)
        attribute.data.foreach_set("color", [1, 0, 0, 1, 0, 1, 0, 0.5, 0, 0, 0.5, 0])
        return scenes.link(bpy.data.objects.new("Leaf", data))

    def colors(self, item):
        from lodestone.bridge.nodes.materials import Wanted
        from lodestone.bridge.scene import mesh_buffers

        look, self.codes = self.translate()
        shown = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
        found = mesh_buffers.extract(shown, [Wanted(look.coordinates, look.vertex_colors)])
        if found.vertex_colors is None:
            return found.corner_colors
        places = (range(4 * vertex, 4 * vertex + 4) for vertex in found.corner_vertices)
        return [found.vertex_colors[at] for place in places for at in place]

    def test_they_are_linear_whatever_they_are_stored_as(self):
        self.node("ShaderNodeVertexColor", ("Color", self.base)).layer_name = "Paint"
        expected = [1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 0.5, 1]  # alpha is not asked for
        for domain in ("CORNER", "POINT"):
            for kind in ("BYTE_COLOR", "FLOAT_COLOR"):
                self.close(self.colors(self.colored(domain, kind)), expected, places=2)
        self.assertEqual((self.codes, self.added[0]["vertex_colors"]), (set(), 1))
        self.close(self.added[0]["base_color"], (1.0, 1.0, 1.0))

    def test_they_multiply_an_image_or_a_constant(self):
        mix = self.node("ShaderNodeMixRGB", ("Color", self.base), Fac=1.0)
        mix.blend_type = "MULTIPLY"
        self.node("ShaderNodeAttribute", ("Color", mix.inputs["Color1"])).attribute_name = "Paint"
        mix.inputs["Color2"].default_value = (0.5, 0.25, 1.0, 1.0)
        self.assertIsNotNone(self.colors(self.colored()))
        self.close(self.added[0]["base_color"], (0.5, 0.25, 1.0))
        self.picture(mix.inputs["Color2"])
        self.assertIsNotNone(self.colors(self.colored()))
        self.assertEqual(self.codes, set())
        self.close(self.added[0]["base_color"], (0.5, 0.5, 0.5))

    def test_their_alpha_counts_when_it_is_used(self):
        node = self.node("ShaderNodeVertexColor", ("Alpha", self.principled.inputs["Alpha"]))
        node.layer_name = "Paint"
        self.close(self.colors(self.colored())[3::4], (1.0, 0.5, 0.0), places=2)
        self.assertEqual((self.codes, self.added[0]["alpha_mode"]), (set(), 1))

    def test_a_mesh_without_them_is_black_and_one_that_needs_none_has_none(self):
        self.assertIsNone(self.colors(self.colored()))
        self.node("ShaderNodeVertexColor", ("Color", self.base)).layer_name = "Other"
        self.close(self.colors(self.colored()), [0, 0, 0, 1] * 3)

    def test_those_of_a_shader_that_is_mixed_in_are_kept_too(self):
        output = self.tree.nodes["Material Output"]
        mix = self.node("ShaderNodeMixShader", (0, output.inputs["Surface"]))
        painted = self.node("ShaderNodeBsdfDiffuse", (0, mix.inputs[2]))
        self.tree.links.new(self.principled.outputs[0], mix.inputs[1])
        self.node("ShaderNodeVertexColor", ("Color", painted.inputs[0])).layer_name = "Paint"
        from lodestone.bridge.nodes.materials import Materials
        from lodestone.core.problems import Problems

        materials = Materials(None, Problems())
        self.assertIsNone(materials.look(self.material).vertex_colors)
        self.assertEqual(materials.wanted(self.material).vertex_colors.name, "Paint")

    def test_what_does_not_simply_multiply_is_gray_and_named(self):
        rough = self.principled.inputs["Roughness"]
        self.node("ShaderNodeVertexColor", ("Color", rough)).layer_name = "Paint"
        look, codes = self.translate()
        self.assertEqual((look.roughness.number, codes), (0.5, {"vertex_colors"}))


if __name__ == "__main__":
    unittest.main()
