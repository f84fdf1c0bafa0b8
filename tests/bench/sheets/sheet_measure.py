# SPDX-License-Identifier: GPL-3.0-or-later
"""What the sheet tells from pictures and from stored meshes."""

import json
from pathlib import Path

import numpy


def samples(four, number: int) -> list:
    """Pictures of so many samples a pixel, from one of four a pixel."""
    quarters = [four[y::2, x::2] for y, x in ((0, 0), (1, 1), (0, 1), (1, 0))]
    chosen = [[(i + k) % 4 for k in range(number)] for i in range(4)]
    if number == 2:
        chosen = [[0, 1], [2, 3]]
    if number == 4:
        chosen = [[0, 1, 2, 3]]
    return [sum(quarters[i] for i in each) / number for each in chosen]


def seen(picture):
    """Display-encoded over a middle grey."""
    light = numpy.clip(picture[:, :, :3] + 0.214 * (1 - picture[:, :, 3:]), 0, 1)
    return numpy.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def _read(stored: Path) -> tuple:
    data = stored.read_bytes()
    length = int.from_bytes(data[12:16], "little")
    return json.loads(data[20 : 20 + length]), data[28 + length :]


def painted(stored: Path) -> bool:
    """Whether a stored mesh has colors of vertices."""
    primitives = _read(stored)[0]["meshes"][0]["primitives"]
    return any("COLOR_0" in primitive["attributes"] for primitive in primitives)


def parts_of(stored: Path) -> int:
    """How many parts a stored mesh has that share no corner."""
    text, binary = _read(stored)

    def read(number: int):
        accessor = text["accessors"][number]
        view = text["bufferViews"][accessor["bufferView"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        of = {5121: "u1", 5123: "u2", 5125: "u4", 5126: "f4"}[accessor["componentType"]]
        numbers = accessor["count"] * (3 if accessor["type"] == "VEC3" else 1)
        return numpy.frombuffer(binary, of, numbers, start).reshape(-1, 3)

    first: dict[bytes, int] = {}
    above: list[int] = []

    def top(i: int) -> int:
        while above[i] != i:
            above[i] = above[above[i]]
            i = above[i]
        return i

    for primitive in text["meshes"][0]["primitives"]:
        numbers = []
        for place in read(primitive["attributes"]["POSITION"]):
            numbers.append(first.setdefault(place.tobytes(), len(above)))
            if numbers[-1] == len(above):
                above.append(len(above))
        for a, b, c in read(primitive["indices"]):
            above[top(numbers[b])] = top(numbers[a])
            above[top(numbers[c])] = top(numbers[a])
    return len({top(i) for i in range(len(above))})
