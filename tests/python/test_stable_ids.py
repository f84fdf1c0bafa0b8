# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the ids that tie levels in the store to things in the file."""

import unittest

import addon_path  # noqa: F401
from lodestone.core import stable_ids


class StableId(unittest.TestCase):
    def test_is_sixteen_hexadecimal_digits(self):
        self.assertTrue(stable_ids.is_uid(stable_ids.stable_id()))
        self.assertTrue(stable_ids.is_uid(stable_ids.stable_id("mesh", "", "Cube")))

    def test_is_the_same_in_every_run(self):
        self.assertEqual(stable_ids.stable_id("a", 1), "c25807dbd8416470")

    def test_parts_do_not_run_together(self):
        self.assertNotEqual(stable_ids.stable_id("ab", "c"), stable_ids.stable_id("a", "bc"))
        self.assertNotEqual(stable_ids.stable_id("a", ""), stable_ids.stable_id("a"))

    def test_takes_any_name(self):
        for name in ("", 'quote"', "new\nline", "{brace}", "Ünïcode 名", "\udcff", "x" * 9999):
            self.assertTrue(stable_ids.is_uid(stable_ids.stable_id(name)), name)


def oak(stored="", decided=False, name="Oak"):
    return ("object", "", name, stored, decided)


OAK = stable_ids.named_id("object", "", "Oak")


class AssignUids(unittest.TestCase):
    def test_of_nothing_is_nothing(self):
        self.assertEqual(stable_ids.assign_uids([]), [])

    def test_a_name_is_enough_where_nothing_is_decided(self):
        self.assertEqual(stable_ids.assign_uids([oak(), oak(name="Elm")]), ["", ""])

    def test_a_decision_stores_the_id_it_had_without_one(self):
        self.assertEqual(stable_ids.assign_uids([oak(decided=True)]), [OAK])

    def test_a_renamed_thing_keeps_its_own(self):
        for decided in (False, True):
            self.assertEqual(stable_ids.assign_uids([oak(OAK, decided, "Elm")]), [OAK])

    def test_a_copy_is_known_by_its_name_and_the_first_keeps_the_id(self):
        things = [oak(OAK), oak(OAK, name="Oak.001")]
        self.assertEqual(stable_ids.assign_uids(things), [OAK, ""])

    def test_a_copy_with_its_decision_gets_a_new_one(self):
        things = [oak(OAK, True), oak(OAK, True, "Oak.001")]
        uids = stable_ids.assign_uids(things)
        self.assertEqual(uids, [OAK, stable_ids.named_id("object", "", "Oak.001")])

    def test_a_thing_that_took_the_name_of_a_renamed_one_gets_another(self):
        for decided in (False, True):
            uids = stable_ids.assign_uids([oak(OAK, name="Elm"), oak(decided=decided)])
            self.assertEqual(uids[0], OAK)
            self.assertNotEqual(uids[1], OAK)
            self.assertTrue(stable_ids.is_uid(uids[1]))

    def test_none_is_one_that_others_have(self):
        for stored in (OAK, ""):
            (uid,) = stable_ids.assign_uids([oak(stored)], taken=[OAK])
            self.assertNotEqual(uid, OAK)
            self.assertTrue(stable_ids.is_uid(uid))

    def test_what_is_no_uid_is_replaced(self):
        for wrong in ("xyz", "A" * 16, "g" * 16, "0" * 17):
            self.assertEqual(stable_ids.assign_uids([oak(wrong)]), [""], wrong)
            self.assertEqual(stable_ids.assign_uids([oak(wrong, True)]), [OAK], wrong)

    def test_once_assigned_they_stay(self):
        things = [oak(OAK, name="Elm"), oak(), oak(decided=True, name="Ash"), oak(name="Fir")]
        first = stable_ids.assign_uids(things)
        again = [(*thing[:3], uid, thing[4]) for thing, uid in zip(things, first)]
        self.assertEqual(stable_ids.assign_uids(again), first)

    def test_ten_thousand_copies_all_differ(self):
        for decided, stored in ((True, 10000), (False, 1)):
            things = [oak("0" * 16, decided, f"Oak.{i}") for i in range(10000)]
            uids = stable_ids.assign_uids(things)
            self.assertEqual(sum(map(bool, uids)), stored)
            known = {u or stable_ids.named_id(*thing[:3]) for u, thing in zip(uids, things)}
            self.assertEqual(len(known), 10000)


class SameLibrary(unittest.TestCase):
    def test_equal_paths_and_a_relative_one_with_its_absolute_one(self):
        same = stable_ids.same_library
        self.assertTrue(same("/work/kit.blend", "/work/kit.blend"))
        self.assertTrue(same("//kit.blend", "/work/kit.blend"))
        self.assertTrue(same("C:\\work\\lib\\kit.blend", "//..\\lib\\kit.blend"))
        self.assertTrue(same("//../lib/kit.blend", "//lib/kit.blend"))

    def test_other_files_folders_and_nothing_differ(self):
        same = stable_ids.same_library
        self.assertFalse(same("/work/kit.blend", "/home/kit.blend"))
        self.assertFalse(same("//kit.blend", "/work/toolkit.blend"))
        self.assertFalse(same("//a/kit.blend", "/work/b/kit.blend"))
        self.assertFalse(same("", "//kit.blend"))
        self.assertFalse(same("//", "/work/kit.blend"))


if __name__ == "__main__":
    unittest.main()
