# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards --skip-existing: half a picture is no picture."""

import struct
import tempfile
import unittest
import zlib
from pathlib import Path

import addon_path  # noqa: F401
from lodestone.core.batch import blend_header, png_check


def chunk(name, data=b""):
    checksum = zlib.crc32(name + data)
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", checksum)


WHOLE = (
    b"\x89PNG\r\n\x1a\n"
    + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 0, 0, 0, 0))
    + chunk(b"IDAT", zlib.compress(b"\0\0"))
    + chunk(b"IEND")
)


class Png(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name) / "a.png"

    def whole(self, data):
        self.path.write_bytes(data)
        return png_check.is_whole(self.path)

    def test_a_whole_one_is(self):
        self.assertTrue(self.whole(WHOLE))

    def test_nothing_a_folder_and_an_empty_file_are_not(self):
        self.assertFalse(png_check.is_whole(self.path))
        self.assertFalse(png_check.is_whole(self.path.parent))
        self.assertFalse(self.whole(b""))

    def test_no_part_of_one_is(self):
        for end in range(len(WHOLE)):
            self.assertFalse(self.whole(WHOLE[:end]), end)

    def test_one_wrong_byte_is_seen(self):
        for at in range(len(WHOLE)):
            data = bytearray(WHOLE)
            data[at] ^= 0x40
            self.assertFalse(self.whole(data), at)

    def test_chunks_without_a_picture_are_none(self):
        self.assertFalse(self.whole(WHOLE[:8] + WHOLE[8:33] + chunk(b"IEND")))


class BlendHeader(unittest.TestCase):
    def test_versions_of_old_and_new_headers(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "a.blend"
            for data, expected in (
                (b"BLENDER-v304REND", (3, 4)),
                (b"BLENDER_V279REND", (2, 79)),
                (b"BLENDER-v402REND", (4, 2)),
                (b"BLENDER17-01v0500REND", (5, 0)),
                (b"\x28\xb5\x2f\xfd compressed", None),
                (b"", None),
                (b"BLENDER", None),
            ):
                path.write_bytes(data)
                self.assertEqual(blend_header.version(str(path)), expected, data)
            self.assertIsNone(blend_header.version(folder + "/nowhere"))


if __name__ == "__main__":
    unittest.main()
