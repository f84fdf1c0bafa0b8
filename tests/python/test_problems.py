# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the list of problems: each once, by cause, and ignored ones only where they were meant."""

import time
import unittest

import addon_path  # noqa: F401
from lodestone.core import problem_causes
from lodestone.core.problems import ERROR, INFO, WARNING, Problem, Problems
from lodestone.core.session import last_check


def material(name, text, severity=WARNING, library="", code="node_color"):
    message = f'Material "{name}": {text}'
    return Problem(name, severity, code, message, "material", library)


def users(**objects):
    return {
        ("material", "", name): tuple(("object", "", item) for item in items)
        for name, items in objects.items()
    }


class Collecting(unittest.TestCase):
    def test_nothing_is_no_problem(self):
        self.assertEqual((len(Problems()), list(Problems()), Problems().wrong), (0, [], []))

    def test_the_word_before_the_name_tells_its_kind(self):
        for message, kind in (
            ('Material "X": is grey', "material"),
            ('Shadows of light "X" are drawn sharp', "light"),
            ('Depth of field of camera "X" is left out', "camera"),
            ('World "X": drawn as one flat color', "world"),
            ('Library "X" is missing', "library"),
            ('Area "X" is no kind', ""),
            ("X says nothing", ""),
        ):
            problems = Problems()
            problems.add("X", WARNING, "some_code", message)
            self.assertEqual([p.kind for p in problems], [kind], message)

    def test_a_given_kind_and_library_win(self):
        problems = Problems()
        problems.add("X", WARNING, "a", 'Material "X": grey', kind="object", library="//l.blend")
        (problem,) = problems
        self.assertEqual(problem.subject, ("object", "//l.blend", "X"))

    def test_equal_names_of_two_libraries_are_two_things(self):
        problems = Problems()
        for library in ("", "//a.blend", "//a.blend", "//b.blend"):
            problems.add("Bark", WARNING, "a", 'Material "Bark": grey', library=library)
        self.assertEqual(len(problems), 3)

    def test_two_texts_of_one_code_are_both_kept(self):
        problems = Problems()
        for node in ("Noise", "Wave", "Noise"):
            problems.add("Bark", WARNING, "node_color", f'Material "Bark": {node} is flat')
        self.assertEqual(len(problems), 2)

    def test_a_thing_with_endless_problems_of_a_code_is_bounded(self):
        problems = Problems()
        for number in range(10_000):
            problems.add("Bark", WARNING, "node_color", f"{number} is flat")
        self.assertEqual(len(problems), 16)

    def test_what_is_not_wanted_can_come_again(self):
        problems = Problems()
        problems.add("Bark", WARNING, "a", "grey")
        problems.keep(lambda problem: False)
        self.assertEqual(len(problems), 0)
        problems.add("Bark", WARNING, "a", "grey")
        self.assertEqual(len(problems), 1)


class ByCause(unittest.TestCase):
    def test_nothing_gives_no_row(self):
        found = problem_causes.split((), {})
        self.assertEqual((found.shown, found.ignored), ((), ()))
        self.assertEqual(problem_causes.headline(found), "No problems")
        self.assertEqual(problem_causes.exact_line(0, 0), "")

    def test_one_row_with_the_number_of_objects(self):
        used = users(Bark_old=[f"Tree.{i}" for i in range(12)])
        problems = [material("Bark_old", "Noise Texture is drawn flat")]
        (row,) = problem_causes.split(problems, used).shown
        self.assertEqual(
            row.sentence, 'Material "Bark_old": Noise Texture is drawn flat (12 objects)'
        )
        self.assertEqual(len(row.objects), 12)

    def test_materials_with_one_cause_are_one_row(self):
        used = users(A=["One", "Two"], B=["Two"], C=["Three"])
        problems = [material(name, "clearcoat is left out") for name in "ABC"]
        (row,) = problem_causes.split(problems, used).shown
        self.assertEqual(row.sentence, "3 materials: clearcoat is left out (3 objects)")
        self.assertEqual([name for _, _, name in row.objects], ["One", "Two", "Three"])

    def test_other_things_are_counted_after_the_first(self):
        problems = [
            Problem(n, INFO, "soft_shadow", f'Shadows of light "{n}" are sharp', "light")
            for n in ("Key", "Fill", "Rim")
        ]
        (row,) = problem_causes.split(problems, {}).shown
        self.assertEqual(row.sentence, 'Shadows of light "Key" are sharp (and 2 more)')
        self.assertEqual(len(row.objects), 3)

    def test_a_name_that_is_part_of_the_text_does_not_join_different_causes(self):
        problems = [material("e", "one thing"), material("e", "other thing")]
        self.assertEqual(len(problem_causes.split(problems, {}).shown), 2)

    def test_the_worst_come_first_and_the_key_does_not_depend_on_who_has_it(self):
        problems = [
            material("A", "i", INFO),
            material("A", "w"),
            material("A", "e", ERROR),
            material("B", "w"),
        ]
        rows = problem_causes.split(problems, {}).shown
        self.assertEqual([row.severity for row in rows], [ERROR, WARNING, INFO])
        alone = problem_causes.split([material("B", "w")], {}).shown[0]
        self.assertEqual(rows[1].key, alone.key)
        self.assertEqual(
            problem_causes.headline(problem_causes.split(problems, {})), "1 error, 1 warning"
        )

    def test_an_ignored_problem_is_shown_again_when_it_changes_or_another_has_it(self):
        old = material("A", "clearcoat is left out")
        changed = material("A", "sheen is left out")
        other = material("B", "clearcoat is left out")
        found = problem_causes.split([old, changed, other], {}, {old.key})
        self.assertEqual([p for row in found.ignored for p in row.problems], [old])
        self.assertEqual([p for row in found.shown for p in row.problems], [changed, other])

    def test_what_stops_every_picture_cannot_be_ignored(self):
        problem = Problem("", ERROR, "povray_missing", "POV-Ray was not found")
        found = problem_causes.split([problem], {}, {problem.key})
        self.assertEqual(len(found.shown), 1)
        self.assertTrue(found.shown[0].about_setup)

    def test_the_report_names_everything(self):
        used = {("material", "//l.blend", "A"): (("object", "", "One"),)}
        problems = [material("A", "grey", library="//l.blend"), material("B", "grey")]
        text = problem_causes.split(problems, used).shown[0].report
        for name in ('"A" (//l.blend)', '"B"', '"One"', "2 materials: grey (1 object)"):
            self.assertIn(name, text)

    def test_hostile_names_stay_text(self):
        for name in ('"', '""', 'a" b', "new\nline", "\udcff", "x" * 63, "{0}", "%s"):
            used = {("material", "", name): (("object", "", name),)}
            (row,) = problem_causes.split([material(name, "grey")], used).shown
            self.assertIn("grey", row.sentence)
            self.assertEqual(len(row.key), 16)
            self.assertIn("(1 object)", row.report)

    def test_thousands_are_grouped_in_no_time(self):
        names = [f"M.{i}" for i in range(20_000)]
        used = users(**{name: [name, "Shared"] for name in names})
        problems = [material(name, "grey") for name in names]
        start = time.process_time()
        (row,) = problem_causes.split(problems, used).shown
        self.assertEqual(len(row.objects), 20_001)
        self.assertLess(time.process_time() - start, 5.0)


class Checks(unittest.TestCase):
    def test_exact_are_those_that_nothing_is_said_about(self):
        used = users(**{f"M{i}": ["Cube"] for i in range(342)})
        found = [material(f"M{i}", "grey", INFO) for i in range(24)]
        found += [material("M0", "and flat"), Problem("Cube", ERROR, "nan", "bad", "object")]
        check = last_check.Check(tuple(found), used)
        self.assertEqual(check.exact_materials, (318, 342))
        self.assertEqual(problem_causes.exact_line(318, 342), "318 of 342 materials exact (93 %)")
        self.assertEqual(problem_causes.exact_line(341, 342), "341 of 342 materials exact (99 %)")

    def test_rows_are_made_once_for_the_same_decisions(self):
        problem = material("A", "grey")
        check = last_check.Check((problem,))
        self.assertIs(check.split(set()), check.split(()))
        self.assertEqual(len(check.split({problem.key}).shown), 0)
        self.assertEqual(len(check.split(()).shown), 1)


if __name__ == "__main__":
    unittest.main()
