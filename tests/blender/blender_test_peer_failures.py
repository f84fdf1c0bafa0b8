# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards against what Blender's bundled POV-Ray add-on (render_povray) was seen to fail at: a case
for each row, B1...B18, by picture or by count."""

import contextlib
import ctypes
import io
import math
import os
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import bpy
from bpy_extras.object_utils import world_to_camera_view

import blender_scenes as scenes
from blender_case import Case
from blender_test_camera import CASES, GlowingBalls, with_case

WIDTH, HEIGHT = 32, 18


def quad(name, left, right, material=None, bottom=-9.0, top=9.0, height=0.0):
    corners = [(left, bottom), (right, bottom), (right, top), (left, top)]
    mesh = scenes.mesh(name, [(x, y, height) for x, y in corners], [(0, 1, 2, 3)])
    if material is not None:
        mesh.materials.append(material)
    return scenes.link(bpy.data.objects.new(name, mesh))


@contextlib.contextmanager
def console(path):
    """Everything that is said meanwhile, by Blender too, goes into a file."""
    flush = ctypes.CDLL(None).fflush
    sys.stdout.flush()
    flush(None)
    before = [os.dup(number) for number in (1, 2)]
    file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    try:
        for number in (1, 2):
            os.dup2(file, number)
        yield
    finally:
        sys.stdout.flush()
        flush(None)
        for number, old in zip((1, 2), before):
            os.dup2(old, number)
            os.close(old)
        os.close(file)


class PeerFailures(Case):
    """From 10 m above; a picture is 7.2 m wide at the height 0."""

    def setUp(self):
        super().setUp()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.out = self.folder / "picture.exr"
        bpy.ops.wm.save_as_mainfile(filepath=str(self.folder / "file.blend"))
        self.scene.lodestone.pixel_error_render = 0.0
        render = self.scene.render
        render.engine, render.filepath = "LODESTONE_POVRAY", str(self.out)
        render.resolution_x, render.resolution_y = WIDTH, HEIGHT
        render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
        render.image_settings.color_mode = "RGBA"

    def render(self):
        """Linear RGBA: rows from below, of pixels."""
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(str(self.out))
        (width, height), pixels = image.size, list(image.pixels)
        bpy.data.images.remove(image)
        rows = range(0, 4 * width * height, 4 * width)
        return [[pixels[i : i + 4] for i in range(row, row + 4 * width, 4)] for row in rows]

    def found(self):
        """Codes of the last render's problems."""
        from lodestone.core.session.addon_session import addon_session

        problems = addon_session().checks.get(self.scene.name).problems
        return sorted((problem.object, problem.code) for problem in problems)

    def povray(self, script):
        """A program that takes POV-Ray's place."""
        program = self.folder / "povray"
        program.write_bytes(b"#!/bin/sh\n" + script)
        program.chmod(0o755)
        self.with_environment("LODESTONE_POVRAY", str(program))

    def with_environment(self, name, value):
        before = os.environ.get(name)
        put_back = os.environ.pop if before is None else os.environ.__setitem__
        self.addCleanup(put_back, name, *([None] if before is None else [before]))
        os.environ[name] = value

    def refused(self, text):
        self.out.write_bytes(b"last night's picture")
        with self.assertRaisesRegex(RuntimeError, text) as caught:
            bpy.ops.render.render(write_still=True)
        self.assertEqual(self.out.read_bytes(), b"last night's picture")
        return str(caught.exception)

    def command_line(self, **environment):
        """Another Blender renders the file as farms do it: (exit code, what it said)."""
        bpy.ops.wm.save_mainfile()
        command = [bpy.app.binary_path, "-b", "--factory-startup", str(self.folder / "file.blend")]
        command += ["--addons", "lodestone", "-E", "LODESTONE_POVRAY"]
        command += ["-o", "//frame_####", "-F", "PNG", "-f", "1"]
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=60, env={**os.environ, **environment}
        )
        return done.returncode, done.stdout + done.stderr

    def near(self, pixel, expected, part=0.01):
        for value, wanted in zip(pixel, expected):
            self.assertAlmostEqual(value, wanted, delta=part * max(wanted, 0.05))

    # ---- B1...B6: what ended in a crash, in gray or in nothing ----

    def test_b01_a_plain_empty_does_not_crash(self):
        empty = scenes.link(bpy.data.objects.new("Empty", None))
        empty.location = (2, 0, 0)
        scenes.cube("Child", size=1.5).parent = empty
        self.scene.render.film_transparent = True
        row = self.render()[HEIGHT // 2]
        self.assertEqual((row[WIDTH // 4][3], row[25][3]), (0.0, 1.0))  # 2 m are 9 pixels

    def test_b02_node_materials_are_not_gray(self):
        glow = scenes.material("Glow", (0, 0, 0))
        values = glow.node_tree.nodes["Principled BSDF"].inputs
        values["Emission"].default_value, values["Specular"].default_value = (1, 0.5, 0.1, 1), 0
        thin = scenes.material("Thin", (0.8, 0.1, 0.1))
        thin.node_tree.nodes["Principled BSDF"].inputs["Alpha"].default_value = 0.3
        painted = scenes.material("Painted")
        image = bpy.data.images.new("Green", 2, 2)
        image.generated_color = (0.0, 1.0, 0.0, 1.0)
        nodes = painted.node_tree.nodes
        source = nodes.new("ShaderNodeTexImage")
        source.image = image
        base = nodes["Principled BSDF"].inputs["Base Color"]
        painted.node_tree.links.new(source.outputs["Color"], base)
        red = scenes.material("Red", (0.8, 0.02, 0.02))
        for number, material in enumerate((red, painted, glow, thin)):
            left = 1.8 * number - 3.6
            quad(material.name, left, left + 1.8, material).data.uv_layers.new()
        scenes.sun(energy=math.pi)
        self.scene.render.film_transparent = True
        red, green, glow, thin = self.render()[HEIGHT // 2][4::8]
        self.assertGreater(red[0], 5 * max(red[1:3]))
        self.assertGreater(green[1], 5 * max(green[0], green[2]))
        self.near(glow, (1.0, 0.5, 0.1, 1.0))
        self.assertAlmostEqual(thin[3], 0.3, delta=0.02)
        self.assertEqual(self.found(), [])

    def test_b03_a_failure_is_never_exit_code_0_and_a_black_picture(self):
        from lodestone.engines import render_engine

        scenes.cube()
        extraction = render_engine.scene_extraction
        extract, extraction.extract = extraction.extract, lambda *_, **__: 1 // 0
        try:
            self.refused("ZeroDivisionError")
        finally:
            extraction.extract = extract
        self.povray(b"echo 'Parse Error: no such thing' >&2; exit 1\n")
        self.refused("no such thing")
        os.environ["LODESTONE_POVRAY"] = "/nowhere/povray"
        self.refused("/nowhere/povray")
        picture = self.folder / "frame_0001.png"
        picture.write_bytes(b"last night's picture")
        code, said = self.command_line(LODESTONE_POVRAY="/nowhere/povray")
        self.assertEqual((code, picture.read_bytes()), (1, b"last night's picture"), said)
        self.assertIn("/nowhere/povray", said)

    def test_b04_the_one_line_that_farms_send_renders(self):
        scenes.cube()
        code, said = self.command_line()
        self.assertEqual(code, 0, said)
        self.assertNotIn("Traceback", said)
        data = (self.folder / "frame_0001.png").read_bytes()
        self.assertEqual(struct.unpack(">II", data[16:24]), (WIDTH, HEIGHT))

    def test_b05_names_outside_latin_script_render_and_any_log_is_read(self):
        names = ("Ünïcode 名", "مرحبا", "🐸", 'x"quote')
        for number, name in enumerate(names):
            item = scenes.cube(name, (1.8 * number - 2.7, 0, 0), 1.2)
            item.data.materials.append(scenes.matte(name, (0.1 + 0.2 * number, 0.5, 0.5)))
        scenes.sun(energy=math.pi)
        shown = [round(pixel[0], 2) for pixel in self.render()[HEIGHT // 2][4::8]]
        self.assertEqual(shown, [0.1, 0.3, 0.5, 0.7])
        self.povray(b"printf 'Parse Error: \\303\\050 \\377 caf\\351\\n' >&2; exit 1\n")
        self.assertNotIn("UnicodeDecodeError", self.refused("Parse Error"))

    def test_b06_an_unbaked_domain_of_smoke_is_named_and_all_else_is_drawn(self):
        scenes.cube("Before", (-2, 0, 0), 1.5)
        domain = scenes.cube("Domain", size=9.0)
        domain.modifiers.new("Fluid", "FLUID").fluid_type = "DOMAIN"
        self.assertEqual(domain.modifiers[0].domain_settings.domain_type, "GAS")
        scenes.cube("After", (2, 0, 0), 1.5)
        self.scene.render.film_transparent = True
        row = self.render()[HEIGHT // 2]
        covered = [row[x][3] for x in (7, WIDTH // 2, 25)]
        self.assertEqual(covered, [1.0, 0.0, 1.0])  # nor is the domain a box around them
        self.assertEqual(self.found(), [("Domain", "object_kind")])
        self.assertEqual(self.named(self.extract()[0]), {"Before": 1, "After": 1})
        domain.modifiers[0].domain_settings.domain_type = "LIQUID"
        self.assertEqual(self.named(self.extract()[0])["Domain"], 1)

    # ---- B7, B8: what is shown ----

    def test_b07_every_kind_of_instance_is_drawn(self):
        source = scenes.collection("Source", self.root)
        scenes.cube("Monkey", collection=source)
        scenes.cube("Hat", (0, 0, 1.5), 0.5, collection=source)
        bpy.context.view_layer.layer_collection.children["Source"].exclude = True
        for i in range(3):
            scenes.instance(f"Use {i}", source, (2.4 * i, 0, 1))
        corners = scenes.cube("Corners", (0, 9, 0), 3.0)
        corners.instance_type = "VERTS"
        scenes.cube("Dot", size=0.2).parent = corners
        host = scenes.cube("Host", (0, 20, 0), 3.0)
        nodes = scenes.scatter_nodes(collection=source, join=True)
        host.modifiers.new("Scatter", "NODES").node_group = nodes
        emitter = scenes.cube("Emitter", (0, 30, 0))
        scenes.particles(emitter, 6, instance_object=scenes.cube("Stone", (0, 40, 0), 0.1))
        self.scene.frame_set(2)
        shown = self.named(self.extract()[0])  # also compares with the depsgraph one to one
        expected = {"Monkey": 3 + 8, "Hat": 3 + 8, "Corners": 1, "Host": 1, "Emitter": 1}
        self.assertEqual(shown, {**expected, "Dot": 8, "Stone": 1 + 6})

    def test_b08_what_is_hidden_stays_hidden(self):
        scenes.cube("Seen")
        scenes.cube("Object").hide_render = True
        for name in ("Excluded", "Hidden"):
            scenes.cube(name, collection=scenes.collection(name, self.root))
        bpy.data.collections["Hidden"].hide_render = True
        bpy.context.view_layer.layer_collection.children["Excluded"].exclude = True
        other = bpy.data.scenes.new("Other")
        scenes.cube("Elsewhere", collection=other.collection)
        self.assertEqual(self.named(self.extract()[0]), {"Seen": 1})

    # ---- B9, B10, B13: light ----

    def test_b09_a_sun_lights_the_same_wherever_it_stands(self):
        white = scenes.matte("White", (0.8, 0.8, 0.8))
        quad("Floor", -9, 9, white)
        quad("Roof", -1, 1, white, -1, 1, 4.0)
        sun = scenes.sun(energy=math.pi)
        sun.rotation_euler = (0.0, 0.6, 0.0)  # its shadow lies beside the roof
        rows = self.render()
        sun.location = (-30, 20, 50)
        self.assertTrue(self.render() == rows)
        values = [pixel[0] for pixel in rows[HEIGHT // 2]]
        self.assertLess(min(values), 0.01)
        self.assertGreater(max(values), 0.6)

    def test_b10_lights_have_their_energy_and_linear_color(self):
        quad("Floor", -9, 9, scenes.matte("Gray", (0.5, 0.5, 0.5)))
        sun = scenes.sun(energy=1.5)
        sun.data.color = (1.0, 0.5, 0.25)
        pixel = self.render()[HEIGHT // 2][WIDTH // 2]
        self.near(pixel, [0.5 * 1.5 / math.pi * c for c in (1.0, 0.5, 0.25)])
        bpy.data.objects.remove(sun)
        data = bpy.data.lights.new("Lamp", "POINT")
        data.energy, data.shadow_soft_size = 200.0, 0.0
        scenes.link(bpy.data.objects.new("Lamp", data)).location = (0, 0, 3)
        pixel = self.render()[HEIGHT // 2][WIDTH // 2]
        self.near(pixel, [0.5 * 200 / (4 * math.pi**2 * 9)] * 3, 0.02)

    def test_b13_the_worlds_nodes_are_seen_and_light(self):
        world = self.scene.world = bpy.data.worlds.new("World")
        world.use_nodes = True
        background = world.node_tree.nodes["Background"].inputs
        background["Color"].default_value, background["Strength"].default_value = (
            0.2,
            0.4,
            0.9,
            1,
        ), 0.5
        quad("Floor", -9, 0, scenes.matte("Gray", (0.5, 0.5, 0.5)))
        row = self.render()[HEIGHT // 2]
        self.near(row[4], (0.05, 0.1, 0.225), 0.03)
        self.near(row[28], (0.1, 0.2, 0.45))

    # ---- B11, B14: framing ----

    def test_b11_the_camera_frames_as_blender_does(self):
        ball = scenes.cube("Ball", size=0.5)
        glow = scenes.material("Glow", (0, 0, 0))
        glow.node_tree.nodes["Principled BSDF"].inputs["Emission"].default_value = (1, 1, 1, 1)
        ball.data.materials.append(glow)
        for name in ("auto portrait", "vertical", "shift", "pixel aspect"):
            with self.subTest(name):
                changes = CASES[name]
                data = with_case(self.scene, changes)
                wide = data.view_frame(scene=self.scene)
                middle = 10 * sum(((c / -c.z).x for c in wide)) / 4 + 0.7
                ball.location = (middle, 0.4, 0.0)
                bpy.context.view_layer.update()
                expected = world_to_camera_view(self.scene, self.scene.camera, ball.location)
                rows = self.render()
                lit = [
                    (x + 0.5, y + 0.5, pixel[0])
                    for y, row in enumerate(rows)
                    for x, pixel in enumerate(row)
                ]
                total = sum(value for *_, value in lit)
                center = [sum(spot[i] * spot[2] for spot in lit) / total for i in (0, 1)]
                self.assertAlmostEqual(center[0], expected.x * len(rows[0]), delta=0.4)
                self.assertAlmostEqual(center[1], expected.y * len(rows), delta=0.4)

    def test_b14_a_border_draws_its_part_and_no_other(self):
        scenes.cube(size=5.0)
        render = self.scene.render
        render.film_transparent = render.use_border = True
        render.border_min_x, render.border_max_x = 0.25, 0.5
        render.border_min_y, render.border_max_y = 0.5, 0.75
        rows = self.render()
        covered = {(x, y) for y, row in enumerate(rows) for x, p in enumerate(row) if p[3] > 0.5}
        self.assertEqual(covered, {(x, y) for x in range(8, 16) for y in range(9, 13)})

    # ---- B15, B16: materials ----

    def test_b15_object_materials_count_and_vertex_colors_only_where_used(self):
        red, blue = scenes.matte("Red", (0.8, 0.1, 0.1)), scenes.matte("Blue", (0.1, 0.1, 0.8))
        quad("Left", -9, -1.2, red)
        data = quad("Middle", -1.2, 1.2, red).data
        data.color_attributes.new("Unused", "FLOAT_COLOR", "CORNER")  # black
        right = quad("Right", 1.2, 9, red)
        right.material_slots[0].link, right.material_slots[0].material = "OBJECT", blue
        scenes.sun(energy=math.pi)
        row = self.render()[HEIGHT // 2]
        for x, color in ((4, (0.8, 0.1, 0.1)), (16, (0.8, 0.1, 0.1)), (28, (0.1, 0.1, 0.8))):
            self.near(row[x], color)

    def test_b16_python_may_write_every_setting_of_ours(self):
        scenes.cube()
        material_like = (bpy.data.objects["Cube"], scenes.collection("Own", self.root))
        groups = [item.lodestone for item in (self.scene, *material_like)]
        groups.append(bpy.context.preferences.addons["lodestone"].preferences)
        written = 0
        with contextlib.redirect_stderr(io.StringIO()) as said:
            for group in groups:
                written += self.write_all(group)
        self.assertEqual(said.getvalue(), "")
        self.assertGreater(written, 20)

    def write_all(self, group):
        """Writes each property in every way; the number of times."""
        written = 0
        for kind in group.bl_rna.properties:
            name = kind.identifier
            if kind.type == "COLLECTION":
                written += self.write_all(getattr(group, name).add())
                getattr(group, name).clear()
            if kind.is_readonly or kind.type in ("COLLECTION", "POINTER"):
                continue
            before = getattr(group, name)
            values = {
                "ENUM": lambda: [item.identifier for item in kind.enum_items],
                "BOOLEAN": lambda: [True, False],
                "STRING": lambda: ["", "x" * 10_000],
                "INT": lambda: [kind.hard_min, kind.hard_max],
                "FLOAT": lambda: [kind.hard_min, kind.hard_max],
            }[kind.type]()
            for value in (*values, before):
                setattr(group, name, value)
                written += 1
            self.assertEqual(getattr(group, name), before)
        return written

    # ---- B17, B18: noise ----

    def test_b17_a_frame_says_little_leaves_nothing_and_does_not_sleep(self):
        scenes.cube(size=3.0)
        self.scene.lodestone.keep_scene_files = "ALWAYS"
        bpy.ops.render.render(write_still=True)
        finished = self.folder / "finished.exr"
        (self.folder / "lodestone" / "file.scene" / "picture.exr").rename(finished)
        self.scene.lodestone.keep_scene_files = "FAILED"
        log = self.folder / "console"
        with console(log):
            bpy.ops.render.render(write_still=True)
        said = log.read_text("utf-8")
        self.assertLess(len(said), 4000)
        self.assertLess(len(said.splitlines()), 40)
        self.assertNotIn("not found", said)
        left = {path.name for path in self.folder.iterdir()}
        mine = {"file.blend", "picture.exr", "lodestone", "console", "finished.exr"}
        self.assertEqual(left, mine)
        self.assertEqual(os.listdir(self.folder / "lodestone"), ["file.scene"])

        for words in ("the first reason", "the second reason"):  # no old log is told again
            self.povray(f"echo 'Parse Error: {words}' >&2; exit 1\n".encode())
            text = self.refused(words)
            self.assertEqual(text.count("reason"), 1, text)
        take = f'for a; do case "$a" in +O*) cp {finished} "${{a#+O}}";; esac; done\n'
        self.povray(take.encode())
        spent = []
        for _ in range(4):
            start = time.monotonic()
            bpy.ops.render.render()
            spent.append(time.monotonic() - start)
        print(f"a frame without POV-Ray's own time: {min(spent):.3f} s")
        self.assertLess(min(spent), 0.4)  # the bundled one sleeps for 0.5 s and more

    def test_b18_each_material_is_written_once_and_unused_ones_never(self):
        red, green = scenes.matte("Red", (0.7, 0, 0)), scenes.matte("Green", (0, 0.7, 0))
        unused = scenes.matte("Unused", (0.123, 0.456, 0.789))
        scenes.matte("Brush", (0.321, 0.654, 0.987)).use_fake_user = True
        both = scenes.cube("Both")
        for material in (red, unused, green):
            both.data.materials.append(material)
        for polygon in both.data.polygons[:3]:
            polygon.material_index = 2
        for number in range(3):
            scenes.cube(f"Same {number}", (2 * number, 3, 0), data=both.data)
        scenes.cube("Other", (-2, 0, 0), 0.7).data.materials.append(red)
        self.scene.lodestone.keep_scene_files = "ALWAYS"
        self.render()
        folder = self.folder / "lodestone" / "file.scene"
        meshes = [path.read_text() for path in (folder / "r").iterdir()]
        self.assertEqual(sorted(text.count("pigment{") for text in meshes), [1, 2])
        self.assertEqual(sorted(text.count("#declare") for text in meshes), [1, 1])
        whole = "".join([*meshes, (folder / "scene.pov").read_text()])
        for number in (".123", ".321"):
            self.assertNotIn(number, whole)
        self.assertNotIn("radiosity", whole)
        self.assertEqual(whole.count("object{"), 5)


class DepthOfField(GlowingBalls):
    def test_b12_depth_is_blurred_as_far_as_by_cycles(self):
        data = self.scene.camera.data
        data.dof.use_dof, data.dof.aperture_fstop = True, 0.12
        data.dof.focus_object = scenes.link(bpy.data.objects.new("Focus", None))
        data.dof.focus_object.location = (0.0, 0.0, 6.0)
        self.scene.cycles.samples = 256
        # Sharp in the middle, behind the focus at the left, before it at the right
        for x, depth in ((0.0, 4.0), (-0.22, 8.0), (0.22, 2.5)):
            self.ball((x * depth, 0.0, 10.0 - depth), 0.02 * depth)
        ours, theirs = (self.render(engine) for engine in ("LODESTONE_POVRAY", "CYCLES"))
        for column in (12, 32, 52):
            spreads = [self.spread(picture, column) for picture in (ours, theirs)]
            self.assertAlmostEqual(spreads[0] / spreads[1], 1.0, delta=0.08)
        self.assertGreater(self.spread(theirs, 12), 1.5 * self.spread(theirs, 32))

    def spread(self, picture, column):
        """Root mean square distance of the light near a column from its middle, in pixels."""
        width, height, values = picture
        part = [
            (values[y * width + x], x, y)
            for y in range(height)
            for x in range(column - 10, column + 10)
        ]
        total = sum(value for value, _, _ in part)
        middle = [sum(value * place[i] for value, *place in part) / total for i in (0, 1)]
        return math.sqrt(sum(v * math.dist((x, y), middle) ** 2 for v, x, y in part) / total)


if __name__ == "__main__":
    unittest.main()
