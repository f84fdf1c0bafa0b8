# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards classes of rays with levels of their own: their words, what a cut says of them, and what
the command line, profiles and views ask for."""

import contextlib
import io
import json
import re
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace

import addon_path  # makes the add-on importable
from lodestone.core.batch import command_line
from lodestone.core.batch.file_jobs import FileJob
from lodestone.core.picture import unseen_detail, why_sentences
from lodestone_native import Drawn, Kind, Met, Modifiers, Object, OffScreen, RayClass, Rays
from test_why_sentences import _Cut

BOTH = Rays.SHADOW | Rays.REFLECTION


class Words(unittest.TestCase):
    def test_none_is_no_class(self):
        self.assertEqual((unseen_detail.rays_of("none"), unseen_detail.text_of(0)), (0, "none"))
        self.assertEqual(unseen_detail.mask([]), 0)

    def test_settings_and_words_name_the_same_bits(self):
        for one in unseen_detail.CLASSES:
            self.assertEqual(unseen_detail.mask([one.key]), one.rays)
            self.assertEqual(unseen_detail.rays_of(one.word), one.rays)
            self.assertEqual(unseen_detail.text_of(one.rays), one.word)
        self.assertEqual(unseen_detail.rays_of("reflection,shadow"), BOTH)
        self.assertEqual(unseen_detail.text_of(BOTH), "shadow,reflection")

    def test_nonsense_is_named(self):
        for text in ("", "shadows", "shadow,", "shadow;reflection", "none,shadow", "\0", "9" * 999):
            with self.assertRaises(ValueError, msg=text):
                unseen_detail.rays_of(text)

    def test_pages_and_the_command_know_each_class(self):
        page = (addon_path.ROOT / "blender_addon" / "docs" / "batch.md").read_text()
        (row,) = (line for line in page.splitlines() if line.startswith("| `--ray-classes"))
        for one in unseen_detail.CLASSES:
            self.assertIn(f"`{one.word}`", row)
        command = (addon_path.ROOT / "backend" / "tools" / "choosing.cpp").read_text()
        (told,) = re.findall(r'"([\w, ]+), with commas between"', command)
        self.assertEqual(set(told.split(", ")), {one.name.lower() for one in Rays})
        for one in Rays:
            self.assertIn(f'std::pair{{"{one.name.lower()}", LDS_RAYS_{one.name}}}', command)

    def test_each_class_with_a_rule_can_be_switched_on(self):
        path = addon_path.ROOT / "backend" / "src" / "choose" / "ray_class" / "ray_cut.h"
        (rules,) = re.findall(r"kRayRules\{([^}]*)\}", path.read_text())
        ruled = {
            one.name
            for one, rule in zip(RayClass, re.findall(r"RayRule::(\w+)", rules), strict=True)
            if rule != "None"
        }
        self.assertEqual({one.rays.name for one in unseen_detail.CLASSES}, ruled)

    def test_tooltips_are_sentences_without_a_full_stop(self):
        for one in unseen_detail.CLASSES:
            self.assertGreater(len(one.description), 40)
            self.assertFalse(one.description.endswith("."))


class _Rays:
    """A cut, as unseen_detail.met() asks it."""

    def __init__(self, modifiers):
        self.view = SimpleNamespace(modifiers=modifiers)
        self.asked = []

    def rays(self, rays):
        self.asked.append(rays)
        return SimpleNamespace(
            own=3, triangles=100 * rays, largest_error_px=0.5, kept_need=1, kept_shape=2,
            kept_contact=4, all_triangles=1200, all_bytes=5000,
        )  # fmt: skip


class Numbers(unittest.TestCase):
    def test_a_cut_without_classes_is_not_asked(self):
        for modifiers in (None, Modifiers(), Modifiers(off_screen=OffScreen.SHADOWS)):
            cut = _Rays(modifiers)
            self.assertIsNone(unseen_detail.met(cut))
            self.assertEqual(cut.asked, [])

    def test_each_class_is_told_once_in_the_panel_s_order(self):
        cut = _Rays(Modifiers(ray_classes=BOTH))
        found = unseen_detail.met(cut)
        self.assertEqual(cut.asked, [Rays.SHADOW, Rays.REFLECTION])
        self.assertEqual([one.triangles for one in found.classes], [200, 100])
        self.assertEqual((found.triangles, found.bytes), (1200, 5000))

    def test_the_report_has_every_number(self):
        found = unseen_detail.part(unseen_detail.met(_Rays(Modifiers(ray_classes=Rays.SHADOW))))
        self.assertEqual(
            json.loads(json.dumps(found)),
            {
                "classes": {
                    "shadow": {
                        "coarser": 3,
                        "triangles": 200,
                        "largest_error_px": 0.5,
                        "kept": {"needed": 1, "shaped": 2, "touching": 4},
                    }
                },
                "triangles": 1200,
                "bytes": 5000,
            },
        )


class Asked(unittest.TestCase):
    def pictures(self, *arguments, views=None, profile=None):
        with tempfile.TemporaryDirectory() as folder:
            said = ["render", "a.blend"]
            for name, value in (("--views", views), ("--profile", profile)):
                if value is not None:
                    path = Path(folder) / f"{name[2:]}.json"
                    path.write_text(json.dumps(value))
                    said.append(f"{name}={path}")
            if views is None:
                said.append("--out=a.png")
            options = command_line.parse([*said, *arguments])
            (job,) = command_line.jobs(options)
        return [(p.off_screen, p.ray_classes) for p in FileJob.load(job.dump()).pictures]

    def test_what_is_not_said_is_as_the_file_has_it(self):
        self.assertEqual(self.pictures(), [(None, None)])

    def test_the_command_line_travels_to_blender(self):
        found = self.pictures("--ray-classes=reflection,shadow", "--off-screen=shadows")
        self.assertEqual(found, [("shadows", "shadow,reflection")])
        self.assertEqual(self.pictures("--ray-classes=none"), [(None, "none")])

    def test_the_command_line_wins_over_the_profile(self):
        profile = {"ray_classes": "shadow", "off_screen": "reflected"}
        self.assertEqual(self.pictures(profile=profile), [("reflected", "shadow")])
        found = self.pictures("--ray-classes=none", profile=profile)
        self.assertEqual(found, [("reflected", "none")])

    def test_a_view_wins_over_both(self):
        views = [{"out": "a.png"}, {"out": "b.png", "ray_classes": "none", "off_screen": "full"}]
        found = self.pictures("--ray-classes=shadow", views=views)
        self.assertEqual(found, [(None, "shadow"), ("full", "none")])

    def test_nonsense_is_refused_by_name(self):
        wrong = (
            ({}, ["--ray-classes=glass"]),
            ({}, ["--ray-classes="]),
            ({}, ["--off-screen=Shadows"]),
            ({"profile": {"ray_classes": "all"}}, []),
            ({"profile": {"off_screen": 1}}, []),
        )
        for files, arguments in wrong:
            with contextlib.redirect_stderr(io.StringIO()) as said:
                with self.assertRaises(SystemExit) as caught:
                    self.pictures(*arguments, **files)
            self.assertEqual(caught.exception.code, 2)
            self.assertTrue("class of rays" in said.getvalue() or "none of" in said.getvalue())
        for entry in ({"ray_classes": ["shadow", "glass"]}, {"off_screen": {}}):
            with self.assertRaisesRegex(ValueError, "entry 0"):
                self.pictures(views=[{"out": "a.png", **entry}])


class _Met(_Cut):
    def __init__(self, ray_classes, **met):
        super().__init__()
        self.view = SimpleNamespace(pixel_error=1.0, modifiers=Modifiers(ray_classes=ray_classes))
        usual = {"object": Object(9, 1), "lod": 3, "kind": Kind.BOX, "error_px": 0.42}
        self._met = SimpleNamespace(**(usual | met))

    def choice_rays(self, position, rays):
        return self._met


class Why(unittest.TestCase):
    def lines(self, ray_classes=Rays.SHADOW, **met):
        return why_sentences.explain(_Met(ray_classes, **met), Drawn.ITSELF, 0).lines[2:]

    def test_classes_that_are_off_are_not_spoken_of(self):
        self.assertEqual(self.lines(ray_classes=0, met=Met.OWN), ())
        self.assertEqual(self.lines(met=Met.OFF), ())

    def test_a_coarser_level_has_its_bound(self):
        found = self.lines(met=Met.OWN)
        self.assertEqual(found, ("Shadows: by LOD 3  Box, off by at most 0.42 px",))
        self.assertIn("by group House as LOD 3  Box", self.lines(met=Met.GROUP)[0])
        self.assertEqual(len(self.lines(ray_classes=BOTH, met=Met.OWN)), 2)

    def test_what_keeps_it_as_it_is_seen_is_said(self):
        for met, words in ((Met.NEED, "good enough"), (Met.SHAPE, "cover"), (Met.CONTACT, "near")):
            (line,) = self.lines(met=met)
            self.assertIn(words, line)
            self.assertIn("as it is seen", line)
