# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards the materials' way through the C interface: each field of lds_material comes to the store
under its name, so that none is forgotten between the header and the backend."""

import ctypes
import json
import tempfile
import unittest
from array import array
from pathlib import Path

import addon_path  # noqa: F401
import lodestone_native as native
from lodestone_native import structs
from lodestone_native.buffers import MeshBuffers

NUMBER = 0.140625  # no field has it by default, and all may have it but the IOR
IOR = 1.140625
NOT_FIELDS = ("struct_size", "name")


def unusual(model, field, kind):
    """A value that no new material has, and that value as the store says it."""
    if issubclass(kind, structs.Texture):
        pixels = array("f", [0.0, 0.5, 1.0, 1.0])
        picture = model.add_picture("dot", pixels=pixels, size=(1, 1), linear=True)
        return native.texture(picture, scale=(NUMBER,) * 3), {"scale": [NUMBER] * 3}
    if issubclass(kind, ctypes.Array):
        return (NUMBER,) * 3, [NUMBER] * 3
    if issubclass(kind, ctypes.c_double):
        number = IOR if field == "ior" else NUMBER
        return number, number
    if field == "other":
        return 1 + model.add_material("other", roughness=NUMBER), {"roughness": NUMBER}
    if field == "alpha_mode":
        return int(native.AlphaMode.CLIP), int(native.AlphaMode.CLIP)
    return 1, True


def needed(model, field):
    """The fields without which this one says nothing."""
    if field == "alpha_cutoff":
        return {"alpha_mode": int(native.AlphaMode.CLIP)}
    if field in ("mix", "mix_texture"):
        return {"other": 1 + model.add_material("other")}
    return {}


class MaterialFields(unittest.TestCase):
    def stored(self, model, material):
        quad = MeshBuffers(
            array("f", [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]), array("i", [0, 1, 2, 0, 2, 3])
        )
        model.set_root(model.add_mesh("quad", "quad", quad, [material]))
        with tempfile.TemporaryDirectory() as folder:
            model.build(folder)
            text = json.loads((Path(folder) / "tileset.json").read_text())
        return text["asset"]["extras"]["lodestone"]["materials"][material]

    def test_each_field_of_the_c_struct_comes_to_the_store(self):
        fields = [one for one in structs.Material._fields_ if one[0] not in NOT_FIELDS]
        self.assertGreater(len(fields), 20)
        for field, kind in fields:
            with self.subTest(field), native.Model() as model:
                given, wanted = unusual(model, field, kind)
                material = model.add_material("it", **needed(model, field), **{field: given})
                found = self.stored(model, material)
                self.assertIn(field, found)
                if isinstance(wanted, dict):
                    self.assertEqual(wanted | found[field], found[field])
                else:
                    self.assertEqual(found[field], wanted)

    def test_a_new_material_is_stored_with_the_values_it_always_has(self):
        with native.Model() as model:
            found = self.stored(model, model.add_material("plain"))
        self.assertEqual(
            sorted(found), ["base_color", "emission", "metallic", "name", "roughness", "specular"]
        )


if __name__ == "__main__":
    unittest.main()
