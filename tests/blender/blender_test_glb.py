# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards textured GLB files as Blender's importer sees them: pictures, where they lie, alpha."""

import base64
import json
import math
import os
import struct
import subprocess
import tempfile
import unittest

import bpy

import blender_scenes as scenes

SIDE = 8  # squares of the grid


def _picture(path):
    """An 8 x 8 PNG whose texels all differ; half of them have holes."""
    image = bpy.data.images.new("tiles", 8, 8, alpha=True)
    image.alpha_mode = "CHANNEL_PACKED"
    pixels = []
    for i in range(64):
        pixels += [(i % 8) / 7, (i // 8) / 7, (37 * i % 64) / 63, 1 if i % 2 else 0.5]
    image.pixels[:] = pixels
    image.filepath_raw = path
    image.file_format = "PNG"
    image.save()
    bpy.data.images.remove(image)


def _gltf(path, picture):
    """A grid in the xz plane; its texture is turned, stretched, moved, clamped, and has holes."""
    n = SIDE + 1
    positions = [(i / SIDE, 0, j / SIDE) for j in range(n) for i in range(n)]
    uvs = [(i / SIDE, j / SIDE) for j in range(n) for i in range(n)]
    corners = []
    for j in range(SIDE):
        for i in range(SIDE):
            a = j * n + i
            corners += [a, a + n, a + n + 1, a, a + n + 1, a + 1]
    arrays = [
        struct.pack(f"<{3 * n * n}f", *(x for p in positions for x in p)),
        struct.pack(f"<{2 * n * n}f", *(x for uv in uvs for x in uv)),
        struct.pack(f"<{len(corners)}I", *corners),
    ]
    with open(picture, "rb") as file:
        arrays.append(file.read())
    views, at = [], 0
    for array in arrays:
        views.append({"buffer": 0, "byteOffset": at, "byteLength": len(array)})
        at += len(array)
    texture = {
        "index": 0,
        "extensions": {
            "KHR_texture_transform": {"offset": [0.25, -0.5], "rotation": 0.5, "scale": [1.5, 0.75]}
        },
    }
    material = {
        "name": "leaf",
        "pbrMetallicRoughness": {"baseColorTexture": texture, "metallicFactor": 0},
        "alphaMode": "MASK",
        "alphaCutoff": 0.75,
    }
    document = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_texture_transform"],
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "grid"}],
        "meshes": [
            {
                "name": "grid",
                "primitives": [
                    {
                        "attributes": {"POSITION": 0, "TEXCOORD_0": 1},
                        "indices": 2,
                        "material": 0,
                    }
                ],
            }
        ],
        "materials": [material],
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"wrapS": 33071, "wrapT": 33071, "magFilter": 9728}],
        "images": [{"bufferView": 3, "mimeType": "image/png", "name": "tiles"}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": n * n,
                "type": "VEC3",
                "min": [0, 0, 0],
                "max": [1, 0, 1],
            },
            {"bufferView": 1, "componentType": 5126, "count": n * n, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5125, "count": len(corners), "type": "SCALAR"},
        ],
        "bufferViews": views,
        "buffers": [
            {
                "byteLength": at,
                "uri": "data:application/octet-stream;base64,"
                + base64.b64encode(b"".join(arrays)).decode(),
            }
        ],
    }
    with open(path, "w", encoding="utf-8") as file:
        json.dump(document, file)


def _imported(path):
    """What Blender makes of a file: mesh, image node, mapping node, material."""
    import numpy

    if "bool" not in vars(numpy):
        numpy.bool = bool  # Blender 3.4's importer wants the old name
    scenes.fresh()
    bpy.ops.import_scene.gltf(filepath=path)
    thing = next(o for o in bpy.data.objects if o.type == "MESH")
    material = thing.material_slots[0].material
    nodes = {node.type: node for node in material.node_tree.nodes}
    return thing.data, nodes["TEX_IMAGE"], nodes["MAPPING"], material


class TexturedGlb(unittest.TestCase):
    def facts(self, path):
        mesh, image, mapping, material = _imported(path)
        layer = mesh.uv_layers[0].data
        offsets = [
            math.dist(
                layer[loop.index].uv,
                (mesh.vertices[loop.vertex_index].co.x, 1 + mesh.vertices[loop.vertex_index].co.y),
            )
            for loop in mesh.loops
        ]
        return {
            "triangles": len(mesh.polygons),
            "uv": max(offsets),
            "pixels": [round(255 * x) for x in image.image.pixels],
            "layout": (image.extension, image.interpolation),
            "mapping": [
                x
                for name in ("Location", "Rotation", "Scale")
                for x in mapping.inputs[name].default_value
            ],
            "alpha": (material.blend_method, material.alpha_threshold),
        }

    def test_a_simplified_textured_model_looks_the_same_to_blender(self):
        with tempfile.TemporaryDirectory() as folder:
            model, small = os.path.join(folder, "grid.gltf"), os.path.join(folder, "small.glb")
            picture = os.path.join(folder, "tiles.png")
            _picture(picture)
            _gltf(model, picture)
            subprocess.run(
                [os.environ["LODESTONE_COMMAND"], "simplify", "--ratio", "0.25", model, small],
                check=True,
                stdout=subprocess.DEVNULL,
            )
            before, after = self.facts(model), self.facts(small)
        self.assertEqual(before["triangles"], 2 * SIDE * SIDE)
        self.assertLessEqual(after["triangles"], SIDE * SIDE // 2)
        for x, y in zip(after.pop("mapping"), before.pop("mapping"), strict=True):
            self.assertAlmostEqual(x, y, places=5)
        self.assertLess(before.pop("uv"), 1e-6)
        self.assertLess(after.pop("uv"), 1e-4)
        del before["triangles"], after["triangles"]
        self.assertEqual(after, before)
        self.assertEqual(before["layout"], ("EXTEND", "Closest"))
        self.assertEqual(before["alpha"], ("CLIP", 0.75))
