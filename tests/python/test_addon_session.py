# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the session: what is remembered is there until it ends, and nothing is afterwards."""

import unittest
from pathlib import Path

import addon_path  # noqa: F401
from lodestone.core.picture.cost_model import Ratios
from lodestone.core.session.addon_session import addon_session, end_session
from lodestone.core.session.last_check import Check


class Part:
    made = closed = 0

    def __init__(self):
        Part.made += 1

    def close(self):
        Part.closed += 1


class Plain(dict):
    pass


class Model:
    closed = False

    def close(self):
        self.closed = True


class Session(unittest.TestCase):
    def setUp(self):
        end_session()
        self.addCleanup(end_session)
        Part.made = Part.closed = 0

    def test_there_is_one_until_it_ends(self):
        session = addon_session()
        self.assertIs(addon_session(), session)
        end_session()
        self.assertIsNot(addon_session(), session)

    def test_each_scene_has_its_own(self):
        check = Check(())
        addon_session().checks["A"] = check
        self.assertIs(addon_session().checks.get("A"), check)
        self.assertIsNone(addon_session().checks.get("B"))

    def test_parts_are_made_once_and_closed_once(self):
        part = addon_session().part(Part)
        self.assertIs(addon_session().part(Part), part)
        self.assertEqual((Part.made, Part.closed), (1, 0))
        addon_session().drop(Part)
        addon_session().drop(Part)
        self.assertEqual((Part.made, Part.closed), (1, 1))
        self.assertIsNot(addon_session().part(Part), part)

    def test_what_was_never_asked_for_is_not_made_to_be_dropped(self):
        addon_session().drop(Part)
        self.assertEqual(Part.made, 0)

    def test_the_end_forgets_everything(self):
        from lodestone.core.session.kept_model import Kept

        session, model = addon_session(), Model()
        session.changed_shapes.note(["Cube"])
        session.checks["A"] = Check(())
        session.costs.of(Path("/nowhere/at/all")).write("Camera", Ratios(2.0))
        session.kept_models.put("A", Kept(model, None, {}, 1))
        session.part(Part)
        session.part(Plain)["A"] = 1
        end_session()
        self.assertTrue(model.closed)
        self.assertEqual(Part.closed, 1)
        later = addon_session()
        self.assertEqual(later.changed_shapes.names(), set())
        self.assertEqual((later.checks, later.renders, later.comparisons), ({}, {}, {}))
        self.assertIsNone(later.kept_models.get("A"))
        self.assertEqual(later.part(Plain), {})


if __name__ == "__main__":
    unittest.main()
