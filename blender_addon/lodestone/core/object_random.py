# SPDX-License-Identifier: GPL-3.0-or-later
"""Object random: the number that Blender gives each object by its name: Object Info's Random."""

GRADES = 8  # the values among objects that share a mesh, each of which has levels of its own
MEAN = 0.5  # of no object in particular
_BITS = 0xFFFFFFFF


def random_of(name: str, instancer: str = "") -> float:
    """0...1, as Cycles has it for an object that is no instance. One that is has another number
    there, by its place in what instances it."""
    value = _mixed(_hash(name))
    if instancer:
        value ^= _mixed(_hash(instancer))
    return value / _BITS


def graded(value: float) -> float:
    """The middle of the value's grade."""
    return (min(int(value * GRADES), GRADES - 1) + 0.5) / GRADES


def _hash(name: str) -> int:
    value = 0
    for byte in name.encode("utf-8", "surrogateescape"):
        value = (value * 37 + byte) & _BITS
    return value


def _mixed(value: int) -> int:
    """Jenkins' final mix of lookup3, of this number and 0."""
    a = b = c = 0xDEADBEEF + (2 << 2) + 13
    a = (a + value) & _BITS

    def turned(number: int, by: int) -> int:
        return (number << by | number >> (32 - by)) & _BITS

    c = ((c ^ b) - turned(b, 14)) & _BITS
    a = ((a ^ c) - turned(c, 11)) & _BITS
    b = ((b ^ a) - turned(a, 25)) & _BITS
    c = ((c ^ b) - turned(b, 16)) & _BITS
    a = ((a ^ c) - turned(c, 4)) & _BITS
    b = ((b ^ a) - turned(a, 14)) & _BITS
    return ((c ^ b) - turned(b, 24)) & _BITS
