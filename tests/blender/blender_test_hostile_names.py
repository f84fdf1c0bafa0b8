# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards that a name is never more than a name: whatever things are called, the picture is the same
and nothing else is written or run."""

import os
import struct
import tempfile
import unittest
import zlib
from pathlib import Path

import bpy

import blender_scenes as scenes
import hostile_names as hostile

COLUMNS = 24
LONG_TEXT = 10_000


def png(left, right):
    """4 x 4 pixels of two colors (0...255), half each."""

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    rows = (b"\0" + bytes(left) * 2 + bytes(right) * 2) * 4
    header = struct.pack(">IIBBBBB", 4, 4, 8, 2, 0, 0, 0)
    parts = (chunk(b"IHDR", header), chunk(b"IDAT", zlib.compress(rows)), chunk(b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


class Named:
    """A field of cubes in nested collections, everything called by the names in turn."""

    def __init__(self, folder, names, stems):
        self.names, self.stems = names, stems
        self.pictures = folder / "pictures"
        self.pictures.mkdir(parents=True)
        self.given = 0
        scene = self.scene = scenes.fresh()
        scene.name = self.name()
        scene.view_layers[0].name = self.name()
        scene.camera.name = scene.camera.data.name = self.name()
        sun = scenes.sun()
        sun.name = sun.data.name = self.name()
        scene.world = self.world()
        parent = scene.collection
        for i, name in enumerate(names):
            if i % 10 == 0:  # six deep, and begun again
                holder = scene.collection if i % 60 == 0 else parent
                parent = scenes.collection(names[-i - 1], holder)
            self.cube(i, name, parent)
        text = "".join(names).encode()[:LONG_TEXT].decode("utf-8", "ignore")
        bpy.data.texts.new(self.name()).write(text)
        scene["note"] = text
        scene.render.use_stamp_note, scene.render.stamp_note_text = True, text

    def name(self):
        """The next one."""
        self.given += 7
        return self.names[self.given % len(self.names)]

    def world(self):
        made = bpy.data.worlds.new(self.name())
        made.use_nodes = True
        for node in made.node_tree.nodes:
            node.name = self.name()
        return made

    def cube(self, i, name, parent):
        rows = (len(self.names) + COLUMNS - 1) // COLUMNS
        place = (0.5 * (i % COLUMNS - COLUMNS / 2), 0.5 * (i // COLUMNS - rows / 2), 0)
        mesh = scenes.cube_mesh(name, 0.4)
        made = scenes.cube(name, place, data=mesh, collection=parent)
        made.vertex_groups.new(name=self.name())
        for u in (0.25, 0.75):
            layer = mesh.uv_layers.new(name=self.name())
            layer.data.foreach_set("uv", [u, 0.5] * len(mesh.loops))
        if i % 4 == 3:
            colors = mesh.color_attributes.new(self.name(), "FLOAT_COLOR", "CORNER")
            colors.data.foreach_set("color", [i % 5 / 5, i % 7 / 7, 0.5, 1.0] * len(mesh.loops))
        mesh.materials.append(self.material(i, name, mesh))

    def material(self, i, name, mesh):
        made = scenes.material(name, (i % 5 / 5, i % 7 / 7, i % 11 / 11))
        nodes, link = made.node_tree.nodes, made.node_tree.links.new
        shader, source = nodes["Principled BSDF"], None
        if i % 4 in (1, 2):
            source = nodes.new("ShaderNodeTexImage")
            source.image = self.image(i, name)
            uv = nodes.new("ShaderNodeUVMap")
            uv.uv_map = mesh.uv_layers[1].name
            link(uv.outputs["UV"], source.inputs["Vector"])
        elif i % 4 == 3:
            source = nodes.new("ShaderNodeVertexColor")
            source.layer_name = mesh.color_attributes[0].name
        if source is not None:
            link(source.outputs["Color"], shader.inputs["Base Color"])
        for node in nodes:
            node.name = node.label = self.name()
        return made

    def image(self, i, name):
        path = self.pictures / (self.stems[i % len(self.stems)] + ".png")
        path.write_bytes(png((9, 9, 9), (i % 250, 250 - i % 250, i * 31 % 250)))
        made = bpy.data.images.load(str(path))
        made.name = name
        if i % 4 == 2:
            made.pack()
            path.unlink()
        return made


class HostileNames(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def rendered(self, blend, names, stems, pixel_error):
        """(pixels, problems, paths that were made) of one field in a folder of its own."""
        from lodestone.core.session.addon_session import addon_session
        from lodestone.operators.check_scene import check_scene

        folder = self.folder / str(len(list(self.folder.iterdir())))
        scene = Named(folder, names, stems).scene
        scene.render.engine = "LODESTONE_POVRAY"
        scene.render.filepath = str(folder / "picture.png")
        scene.lodestone.pixel_error_render = pixel_error
        bpy.ops.wm.save_as_mainfile(filepath=str(folder / "saved.blend"))
        os.rename(folder / "saved.blend", folder / blend)  # Blender saves under a longer name
        bpy.ops.wm.open_mainfile(filepath=str(folder / blend))
        before = self.every_path()
        checked = [problem.code for problem in check_scene(bpy.context).problems]
        bpy.ops.render.render(write_still=True)
        made = {os.path.relpath(path, folder) for path in self.every_path() - before}
        found = [
            problem.code for problem in addon_session().checks.get(bpy.context.scene.name).problems
        ]
        self.assertEqual(sorted(checked), sorted(found))
        image = bpy.data.images.load(str(folder / "picture.png"))
        pixels = list(image.pixels)
        bpy.data.images.remove(image)
        return pixels, found, made

    def every_path(self):
        """Of the folder, of where we are, and of where temporary things go."""
        found = {os.path.join(at, name) for at, _, names in os.walk(self.folder) for name in names}
        for place in (os.getcwd(), str(Path.home())):
            found.update(os.path.join(place, name) for name in os.listdir(place))
        return found

    def fields(self, count, pixel_error):
        names = hostile.names()
        names = [names[i * len(names) // count] for i in range(count)]
        plain = [f"Thing {i}" for i in range(count)]
        # Blender takes a backslash for a slash
        stems = [stem for stem in hostile.file_stems(".png") if "\\" not in stem]
        expected = self.rendered("plain.blend", plain, plain, pixel_error)
        blend = hostile.full('"名 $(touch canary)\n', 249) + ".blend"
        return expected, self.rendered(blend, names, stems, pixel_error)

    def test_a_picture_does_not_depend_on_names(self):
        (expected, codes, _), (pixels, found, made) = self.fields(len(hostile.names()), 0.0)
        self.assertGreater(len({tuple(expected[i : i + 3]) for i in range(0, 9216, 4)}), 200)
        self.assertTrue(pixels == expected)
        self.assertEqual(sorted(found), sorted(codes))
        kept = {path for path in made if path.startswith("lodestone/")}
        self.assertEqual(made - kept, {"picture.png"})
        files = {path.split("/")[-1] for path in kept}
        # What was found for pictures, beside no levels.
        self.assertEqual(files, {"sky_light.bin", "pictures.bin", "cost.json"})

    def test_levels_do_not_depend_on_names(self):
        (expected, codes, _), (pixels, found, made) = self.fields(40, 2.0)
        self.assertTrue(pixels == expected)
        self.assertEqual(sorted(found), sorted(codes))
        others = {path for path in made if not path.startswith("lodestone/")}
        self.assertEqual(others, {"picture.png"})
        self.assertEqual(len({path.split("/")[1] for path in made - others}), 1)


class OtherNames(unittest.TestCase):
    """Names that only damaged or foreign files hold."""

    def setUp(self):
        self.scene = scenes.fresh()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.scene.render.engine = "LODESTONE_POVRAY"
        self.scene.render.resolution_x = self.scene.render.resolution_y = 8
        self.scene.render.filepath = str(self.folder / "picture.png")
        self.scene.lodestone.pixel_error_render = 0.0
        scenes.cube("Cube.ABCDEFGH", size=3.0)
        scenes.sun()

    def dressed(self):
        """Makes whatever has a name that a picture may hang on."""
        cube = bpy.data.objects["Cube.ABCDEFGH"]
        mesh = cube.data
        uvs = mesh.uv_layers.new(name="First")
        uvs.data.foreach_set("uv", [0.75, 0.5] * len(mesh.loops))
        uvs = mesh.uv_layers.new(name="Map.ABCDEFGH")
        uvs.data.foreach_set("uv", [0.25, 0.5] * len(mesh.loops))
        layer = mesh.color_attributes.new("Dye.ABCDEFGH", "FLOAT_COLOR", "CORNER")
        layer.data.foreach_set("color", [0.2, 0.9, 0.4, 1.0] * len(mesh.loops))
        made = scenes.material("Clay.ABCDEFGH", (0.5, 0.5, 0.5))
        tree = made.node_tree
        texture, uv = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeUVMap")
        dye, mix = tree.nodes.new("ShaderNodeVertexColor"), tree.nodes.new("ShaderNodeMixRGB")
        (self.folder / "picture.in.png").write_bytes(png((220, 20, 30), (30, 40, 200)))
        texture.image = bpy.data.images.load(str(self.folder / "picture.in.png"))
        texture.image.pack()
        uv.uv_map, dye.layer_name, mix.blend_type = uvs.name, layer.name, "MULTIPLY"
        for number, node in enumerate(tree.nodes):
            node.name = f"{number}.ABCDEFGH"
        tree.links.new(uv.outputs[0], texture.inputs[0])
        mix.inputs[0].default_value = 1.0
        tree.links.new(texture.outputs[0], mix.inputs[1])
        tree.links.new(dye.outputs[0], mix.inputs[2])
        shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
        tree.links.new(mix.outputs[0], shader.inputs["Base Color"])
        mesh.materials.append(made)
        holder = scenes.collection("Things.ABCDEFGH", self.scene.collection)
        twin = scenes.cube("Twin.ABCDEFGH", (1.5, 0.0, 1.0), data=mesh, collection=holder)
        twin.modifiers.new("Triangles", "TRIANGULATE")
        instance = scenes.link(bpy.data.objects.new("Copy.ABCDEFGH", None))
        instance.instance_type, instance.instance_collection = "COLLECTION", holder
        instance.location = (-3.0, 0.0, 0.0)
        self.scene.world = bpy.data.worlds.new("World.ABCDEFGH")
        for things in (bpy.data.images, bpy.data.lights, bpy.data.cameras, bpy.data.objects):
            for number, thing in enumerate(things):
                if not thing.name.endswith("ABCDEFGH"):
                    thing.name = f"{number}.ABCDEFGH"
        self.scene.view_layers[0].name = "Layer.ABCDEFGH"

    def rendered(self):
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(str(self.folder / "picture.png"))
        pixels = list(image.pixels)
        bpy.data.images.remove(image)
        (self.folder / "picture.png").unlink()
        return pixels

    def test_a_picture_does_not_depend_on_names_that_are_no_text(self):
        from lodestone.core.session.addon_session import addon_session

        self.dressed()
        path = self.folder / "damaged.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=False)
        expected = self.rendered()
        self.assertGreater(len({tuple(expected[i : i + 3]) for i in range(0, 256, 4)}), 3)
        data = path.read_bytes()
        self.assertGreater(data.count(b".ABCDEFGH"), 20)
        path.write_bytes(data.replace(b".ABCDEFGH", b".caf\xe9\xff\xed\xa0\x80"))
        bpy.ops.wm.open_mainfile(filepath=str(path))
        with self.assertRaises(UnicodeDecodeError):
            [item.name for item in bpy.data.objects]
        bpy.ops.lodestone.check_scene()
        checked = [problem.message for problem in addon_session().checks.get("Scene").problems]
        self.assertTrue(self.rendered() == expected)
        found = [problem.message for problem in addon_session().checks.get("Scene").problems]
        self.assertEqual(sorted(checked), sorted(found))
        self.assertIn(
            r'"Cube.caf\xe9\xff\xed\xa0\x80" has a name that is not valid text (UTF-8) in the file',
            found,
        )
        bpy.context.scene.lodestone.pixel_error_render = 1.0
        bpy.ops.lodestone.update_levels()
        self.assertTrue((self.folder / "lodestone" / "damaged").is_dir())
        self.rendered()

    def test_a_scene_whose_name_is_no_text_is_told_instead_of_a_traceback(self):
        self.scene.name = "Scene.ABCDEFGH"
        scenes.cube("Cube", size=3.0)
        self.scene.view_layers.new("Layer.ABCDEFGH")
        path = self.folder / "damaged.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=False)
        data = path.read_bytes()
        path.write_bytes(data.replace(b".ABCDEFGH", b".caf\xe9\xff\xed\xa0\x80"))
        bpy.ops.wm.open_mainfile(filepath=str(path))
        for work in (
            lambda: bpy.ops.render.render(write_still=True),
            bpy.ops.lodestone.update_levels,
        ):
            with self.assertRaisesRegex(RuntimeError, r"caf\\xe9\\xff.*rename"):
                work()
        self.assertFalse((self.folder / "picture.png").exists())

    def linked(self):
        """A cube from a library whose path is then one of bytes that are no text."""
        library = str(self.folder / "library.blend")
        bpy.data.libraries.write(library, {bpy.data.objects["Cube.ABCDEFGH"]})
        with bpy.data.libraries.load(library, link=True) as (_, target):
            target.objects = ["Cube.ABCDEFGH"]
        odd = os.fsdecode(os.fsencode(self.folder) + b"/caf\xe9\xff\n.blend")
        os.rename(library, odd)
        bpy.data.libraries[0].filepath = odd
        return scenes.link(target.objects[0])

    def test_a_library_at_a_path_of_any_bytes_may_be_missing(self):
        from lodestone.core.session.addon_session import addon_session

        os.unlink(self.linked().library.filepath)
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "user.blend"))
        bpy.ops.wm.open_mainfile(filepath=str(self.folder / "user.blend"))
        bpy.ops.render.render(write_still=True)
        self.assertTrue((self.folder / "picture.png").is_file())
        found = addon_session().checks.get(bpy.context.scene.name).problems
        (problem,) = [problem for problem in found if problem.code == "library_missing"]
        self.assertIn("/caf\ufffd\ufffd", problem.message)

    def test_a_decision_on_what_is_linked_from_a_path_of_any_bytes_is_kept(self):
        from lodestone.bridge import object_decisions

        item = self.linked()
        object_decisions.decide_linked(self.scene, "object", item, "ENVIRONMENT")
        path = str(self.folder / "user.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
        (item,) = [item for item in bpy.data.objects if item.library]
        role = object_decisions.linked_role(bpy.context.scene, "object", item)
        self.assertEqual(role, "ENVIRONMENT")

    def test_cameras_are_found_by_any_name_and_missed_by_none(self):
        for name in hostile.names():
            if name:
                data = bpy.data.cameras.new(name)
                made = scenes.link(bpy.data.objects.new(name, data))
                made.name = name
        names = [item.name for item in self.scene.objects if item.type == "CAMERA" and item.name]
        extraction, request = scenes.extract(False, [(name, (4, 4)) for name in names])
        extraction.model.close()
        self.assertGreater(len(names), 400)
        found = [camera.name for camera, _ in request.frames]
        self.assertEqual(found, names)
        for name in ("no such\n", "\udcff", "\ud800"):
            with self.assertRaisesRegex(Exception, "no camera"):
                scenes.extract(False, [(name, None)])


if __name__ == "__main__":
    unittest.main()
