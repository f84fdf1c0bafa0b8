# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the ids that tie levels in the store to things in the file."""

import unittest

import addon_path  # noqa: F401
from lodestone.core import identity


class StableId(unittest.TestCase):
    def test_is_sixteen_hexadecimal_digits(self):
        self.assertTrue(identity.is_uid(identity.stable_id()))
        self.assertTrue(identity.is_uid(identity.stable_id("mesh", "", "Cube")))

    def test_is_the_same_in_every_run(self):
        self.assertEqual(identity.stable_id("a", 1), "c25807dbd8416470")

    def test_parts_do_not_run_together(self):
        self.assertNotEqual(identity.stable_id("ab", "c"), identity.stable_id("a", "bc"))
        self.assertNotEqual(identity.stable_id("a", ""), identity.stable_id("a"))

    def test_takes_any_name(self):
        for name in ("", 'quote"', "new\nline", "{brace}", "Ünïcode 名", "\udcff", "x" * 9999):
            self.assertTrue(identity.is_uid(identity.stable_id(name)), name)


class AssignUids(unittest.TestCase):
    def test_of_nothing_is_nothing(self):
        self.assertEqual(identity.assign_uids([]), [])

    def test_a_new_thing_gets_the_id_it_had_without_one(self):
        uids = identity.assign_uids([("object", "", "Oak", "")])
        self.assertEqual(uids, [identity.named_id("object", "", "Oak")])

    def test_a_renamed_thing_keeps_its_own(self):
        stored = identity.named_id("object", "", "Oak")
        self.assertEqual(identity.assign_uids([("object", "", "Elm", stored)]), [stored])

    def test_a_copy_gets_a_new_one_and_the_first_keeps_it(self):
        stored = identity.named_id("object", "", "Oak")
        things = [("object", "", "Oak", stored), ("object", "", "Oak.001", stored)]
        uids = identity.assign_uids(things)
        self.assertEqual(uids[0], stored)
        self.assertEqual(uids[1], identity.named_id("object", "", "Oak.001"))

    def test_a_thing_that_took_the_name_of_a_renamed_one_gets_another(self):
        stored = identity.named_id("object", "", "Oak")
        things = [("object", "", "Elm", stored), ("object", "", "Oak", "")]
        uids = identity.assign_uids(things)
        self.assertEqual(uids[0], stored)
        self.assertNotEqual(uids[1], stored)
        self.assertTrue(identity.is_uid(uids[1]))

    def test_none_is_one_that_others_have(self):
        stored = identity.named_id("object", "", "Oak")
        uids = identity.assign_uids([("object", "", "Oak", stored)], taken=[stored])
        self.assertNotEqual(uids[0], stored)

    def test_what_is_no_uid_is_replaced(self):
        for wrong in ("xyz", "A" * 16, "g" * 16, "0" * 17):
            uids = identity.assign_uids([("object", "", "Oak", wrong)])
            self.assertTrue(identity.is_uid(uids[0]), wrong)

    def test_ten_thousand_copies_all_differ(self):
        things = [("object", "", f"Oak.{i}", "0" * 16) for i in range(10000)]
        self.assertEqual(len(set(identity.assign_uids(things))), 10000)


if __name__ == "__main__":
    unittest.main()
