# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards that two checkouts are told to make the same bits only when they do, up to names."""

import contextlib
import io
import json
import re
import struct
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from bench import compare_checkouts, same_bits  # noqa: E402

ONE, TWO, THREE, FOUR = (digit * 16 for digit in "1234")
OLD_TO_NEW = {ONE: "a" * 16, TWO: "b" * 16, THREE: "c" * 16, FOUR: "d" * 16}


def glb(name: str, values: tuple[float, ...]) -> bytes:
    text = json.dumps({"meshes": [{"name": name}]}).encode()
    text += b" " * (-len(text) % 4)
    data = struct.pack(f"<{len(values)}f", *values)
    whole = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A)
    return whole + text + struct.pack("<II", len(data), 0x004E4942) + data


def made(names=(ONE, TWO, THREE, FOUR), order=(0, 1, 2, 3), build_hash="0123456789abcdef"):
    """A store and a scene. The last two meshes are equal, but each has its place."""
    values = ((1.0, 2.0), (3.0, 4.0), (5.0, 6.0), (5.0, 6.0))
    listed = [{"uri": f"r/{names[i]}.glb", "error": 0.25 * i} for i in order]
    tileset = {"build_hash": build_hash, "content": listed}
    files = {
        "store/tileset.json": json.dumps(tileset, separators=(",", ":")).encode(),
        "store/lock": b"",
        "far/scene.pov": "".join(f'#include "r/{names[i]}.inc"\n' for i in order).encode(),
        "store/i/picture.png": b"\x89PNG\0" + ONE.encode(),
    }
    for name, numbers in zip(names, values):
        files[f"store/r/{name}.glb"] = glb(name, numbers)
        files[f"far/r/{name}.inc"] = f"#declare LDS_R_{name} = mesh2{{{numbers}}}\n".encode()
    return files


def different(before, after, ignore=None):
    return same_bits.compared(before, after, re.compile(ignore) if ignore else None).differences


class Names(unittest.TestCase):
    def test_equal_files_are_the_same_bits(self):
        verdict = same_bits.compared(made(), made())
        self.assertEqual((verdict.differences, verdict.renamed, verdict.files), ([], 0, 12))

    def test_one_renaming_of_all_files_is_the_same_bits(self):
        after = made(tuple(OLD_TO_NEW.values()))
        verdict = same_bits.compared(made(), after)
        self.assertEqual((verdict.differences, verdict.renamed), ([], 8))
        found = same_bits.matched(
            *({k: same_bits.content_of(v) for k, v in side.items()} for side in (made(), after))
        )
        self.assertEqual(found, OLD_TO_NEW)

    def test_a_few_new_names_among_kept_ones(self):
        verdict = same_bits.compared(made(), made((ONE, "b" * 16, THREE, "d" * 16)))
        self.assertEqual((verdict.differences, verdict.renamed), ([], 4))

    def test_a_new_name_of_something_declared_that_has_no_file(self):
        before, after = made(), made()
        before["far/scene.pov"] += b"pigment{LDS_I_5555555555555555}"
        after["far/scene.pov"] += b"pigment{LDS_I_eeeeeeeeeeeeeeee}"
        self.assertEqual(different(before, after), [])

    def test_a_hash_that_names_nothing_may_not_change(self):
        told = different(made(), made(build_hash="f" * 16))
        self.assertEqual(len(told), 1)
        self.assertIn("store/tileset.json", told[0])
        self.assertIn("0123456789abcdef", told[0])

    def test_a_renaming_that_is_not_the_same_in_one_file(self):
        names = tuple(OLD_TO_NEW.values())
        after = made(names)
        scene = after["far/scene.pov"]
        after["far/scene.pov"] = scene.replace(names[0].encode(), names[1].encode())
        self.assertTrue(any("far/scene.pov" in text for text in different(made(), after)))

    def test_digits_of_numbers_are_no_names(self):
        for text in ("0.1234567890123456", "7.439450655510882e-08", f"{ONE}0", f"x{ONE}"):
            self.assertEqual(same_bits.TOKEN.findall(text), [], text)
        self.assertEqual(same_bits.TOKEN.findall(f"r/{ONE}.glb LDS_R_{TWO}"), [ONE, TWO])


class Hostile(unittest.TestCase):
    """Each is a difference, with the names as they were and with new ones."""

    def check(self, change, *, names_one="", count=None):
        for names in (tuple(OLD_TO_NEW), tuple(OLD_TO_NEW.values())):
            after = made(names)
            change(after, names)
            told = different(made(), after)
            self.assertTrue(told)
            self.assertTrue(any(names_one in text for text in told), told)
            if count is not None:
                self.assertEqual(len(told), count, told)
            self.assertTrue(different(after, made()))

    def test_a_missing_file(self):
        self.check(lambda files, names: files.pop(f"store/r/{names[1]}.glb"), names_one="only in")
        self.check(lambda files, names: files.pop("store/lock"), names_one="store/lock", count=1)

    def test_an_extra_file(self):
        def add(files, names):
            files["store/r/eeeeeeeeeeeeeeee.glb"] = files[f"store/r/{names[0]}.glb"]

        self.check(add, names_one="only in AFTER")

    def test_a_truncated_file(self):
        for cut in (4, 1):

            def truncate(files, names, cut=cut):
                files[f"store/r/{names[2]}.glb"] = files[f"store/r/{names[2]}.glb"][:-cut]

            self.check(truncate, names_one=".glb")
        for name in ("store/i/picture.png", "far/scene.pov", "store/tileset.json"):

            def shorten(files, names, name=name):
                files[name] = files[name][:-1]

            self.check(shorten, names_one=name, count=1)

    def test_one_bit_of_one_number(self):
        def flip(files, names):
            data = bytearray(files[f"store/r/{names[0]}.glb"])
            data[-3] ^= 1
            files[f"store/r/{names[0]}.glb"] = bytes(data)

        self.check(flip, names_one=".glb")

    def test_two_contents_swapped(self):
        def swap(files, names):
            one, two = (f"far/r/{name}.inc" for name in names[:2])
            files[one], files[two] = files[two], files[one]

        self.check(swap, names_one=".inc")

    def test_two_names_swapped_in_one_text(self):
        def swap(files, names):
            files["far/scene.pov"] = made(names, (1, 0, 2, 3))["far/scene.pov"]

        self.check(swap, names_one="far/scene.pov", count=1)

    def test_two_equal_files_swapped_in_one_text_of_two(self):
        def swap(files, names):
            files["far/scene.pov"] = made(names, (0, 1, 3, 2))["far/scene.pov"]

        self.check(swap)

    def test_one_name_for_two_files(self):
        def merge(files, names):
            for path in [path for path in files if names[3] in path]:
                del files[path]
            for path in ("far/scene.pov", "store/tileset.json"):
                files[path] = files[path].replace(names[3].encode(), names[2].encode())

        self.check(merge)

    def test_bytes_that_are_no_text(self):
        self.check(lambda files, names: files.update({"store/lock": b"\xff"}), names_one="lock")
        self.check(lambda files, names: files.update({"store/lock": b"glTF\1"}), names_one="lock")
        broken = glb(ONE, (1.0,)).replace(b"meshes", b"m\xffshes")
        self.assertEqual(same_bits.joined(same_bits.content_of(broken)), broken)


class Lines(unittest.TestCase):
    def test_json_is_cut_outside_of_its_strings(self):
        text = '{"a,b":[1.50,"}\\",{"],"c":{}}'
        lines = same_bits.lines_of(text)
        self.assertEqual("".join(lines), text)
        self.assertEqual(lines[:4], ["{", '"a,b":[', "1.50,", '"}\\",{"]'])

    def test_only_what_is_named_may_differ(self):
        after = made(build_hash="f" * 16)
        self.assertEqual(different(made(), after, '^"build_hash":'), [])
        self.assertTrue(different(made(), after, '^"source_hash":'))
        after["store/tileset.json"] = after["store/tileset.json"].replace(b"0.25", b"0.26")
        told = different(made(), after, '^"build_hash":')
        self.assertIn("0.26", told[0])

    def test_a_line_that_is_gone(self):
        after = made()
        after["far/scene.pov"] = after["far/scene.pov"].replace(b"\n", b"", 1)
        self.assertTrue(different(made(), after))
        shorter = made()
        shorter["far/scene.pov"] = b"".join(shorter["far/scene.pov"].splitlines(True)[:-1])
        self.assertIn("lines", different(made(), shorter)[0])

    def test_summaries(self):
        verdict = same_bits.Verdict(files=2842)
        self.assertEqual(same_bits.summary("street", verdict), "street: 2,842 files, the same bits")
        verdict.differences = ["store/r/x.glb: only in BEFORE", "store/lock (AFTER: l): y"]
        self.assertEqual(same_bits.summary("s", verdict), "s: 2 of 2,842 files differ")
        self.assertEqual(same_bits.suffixes(verdict), "1 .glb, 1 others")


class Folders(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def written(self, name, files):
        for path, data in files.items():
            place = self.folder / name / path
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(data)
        return self.folder / name

    def test_as_on_the_disk(self):
        before = self.written("before", made())
        same = same_bits.compare(before, self.written("same", made()))
        self.assertEqual((same.files, same.differences), (12, []))
        after = self.written("after", made(tuple(OLD_TO_NEW.values())))
        self.assertEqual(same_bits.compare(before, after).renamed, 8)
        (after / "far/scene.pov").unlink()
        self.assertEqual(
            same_bits.compare(before, after).differences, ["far/scene.pov: only in BEFORE"]
        )

    def test_a_checkout_that_is_not_built(self):
        with contextlib.redirect_stderr(io.StringIO()) as said:
            code = compare_checkouts.main([str(self.folder), str(self.folder)])
        self.assertEqual(code, 2)
        self.assertIn("cmake --preset release", said.getvalue())

    def test_logs_are_not_compared_but_what_is_in_stores_is(self):
        files = self.written(
            "files", {"store.log": b"0:01", "store/r/odd.log": b"", "1px/a.pov": b""}
        )
        compare_checkouts.set_aside_logs(files, self.folder)
        self.assertEqual(sorted(same_bits.listed(files)), ["1px/a.pov", "store/r/odd.log"])
        self.assertEqual((self.folder / "store.log").read_bytes(), b"0:01")

    def test_which_scenes(self):
        files = self.written("real", {f"{name}.blend": b"x" * size for name, size in SIZES.items()})
        real = sorted(files.glob("*.blend"))

        def names(wanted, quick):
            found = compare_checkouts.chosen(wanted, quick, Path("/b/street.blend"), real)
            return [scene.name for scene in found], found

        self.assertEqual(names(["street", "real"], False)[0], ["street", *sorted(SIZES)])
        self.assertEqual(names(["street", "real"], True)[0], ["street", "hut", "shed"])
        self.assertEqual(names(["town"], True)[0], ["town"])
        cameras = {o[o.index("--camera") + 1] for _, o in names(["street"], False)[1][0].exports}
        self.assertEqual(cameras, {"far", "middle", "near"})
        for wrong in (["moon"], ["street", "moon"]):
            with self.assertRaises(compare_checkouts.Unusable):
                names(wrong, False)


SIZES = {"hut": 3, "shed": 1, "town": 9}


if __name__ == "__main__":
    unittest.main()
