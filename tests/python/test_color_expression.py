# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards expressions: folding agrees with the backend's bakes, and what is affine is found."""

import random
import unittest
from array import array

import addon_path  # noqa: F401
from lodestone.core.expression import node_math
from lodestone.core.expression import color_expression as e
from lodestone.core.expression.affine_texel import affine, peeled
from lodestone.core.expression.color_expression import Op
from lodestone.core.native import lodestone_native as native

OPERATIONS = [op for op in Op if op not in {Op.CONSTANT, Op.TEXEL, Op.CHANNEL, Op.LUMA}]
TABLE = array("f", [0.1, 0.9, 0.5, 1.0, 0.8, 0.2, 0.4, 1.0, 0.3, 0.3, 0.7, 1.0])


def built(op, a, b, c):
    """An operation on expressions."""
    if op == Op.RAMP:
        return e.ramp(e.channel(a, 0), TABLE)
    if op == Op.CURVES:
        return e.curves(a, TABLE)
    count = {Op.COMBINE: 3, Op.MIX: 3}.get(op, 2)
    if op in {Op.ABSOLUTE, Op.FLOOR, Op.TO_HSV, Op.FROM_HSV, Op.TO_SRGB, Op.FROM_SRGB}:
        count = 1
    return e.apply(op, *(a, b, c)[:count])


class Folding(unittest.TestCase):
    def test_constants_fold_to_what_the_backend_bakes(self):
        numbers = random.Random(1)
        with native.Model() as model:
            for op in OPERATIONS:
                for _ in range(4):
                    values = [tuple(numbers.random() for _ in range(3)) for _ in range(3)]
                    parts = [e.constant(value) for value in values]
                    folded = built(op, *parts)
                    self.assertTrue(folded.constant)
                    steps = [native.BakeStep(Op.CONSTANT, (), (*value, 1.0)) for value in values]
                    table = TABLE if op in {Op.RAMP, Op.CURVES} else None
                    steps.append(native.BakeStep(op, (0, 1, 2), (), table))
                    steps.append(native.BakeStep(Op.CONSTANT, (), (0.125,) * 4))
                    steps.append(native.BakeStep(Op.MULTIPLY, (3, 4)))  # within 0...1
                    index = model.bake_picture("x", steps, [], (1, 1), linear=True)
                    found = model.texture_mean(native.texture(index))
                    for ours, theirs in zip(folded.value, found):
                        self.assertAlmostEqual(
                            min(1.0, max(0.0, 0.125 * ours)), theirs, delta=0.0021, msg=op.name
                        )

    def test_what_does_nothing_vanishes(self):
        t = e.texel("image")
        for same in (
            e.add(t, e.ZERO),
            e.multiply(e.ONE, t),
            e.mix(t, e.ONE, e.ZERO),
            e.mix(e.ONE, t, e.ONE),
            e.subtract(t, e.ZERO),
            e.apply(Op.POWER, t, e.ONE),
            e.apply(Op.COMBINE, *(e.channel(t, k) for k in range(3))),
            e.clamp(t),
        ):
            self.assertIs(same, t)
        self.assertEqual(e.multiply(t, e.ZERO).value, (0.0, 0.0, 0.0))

    def test_bounds_hold_for_random_texels(self):
        numbers = random.Random(2)
        for _ in range(300):
            a, b, c = (self.random(numbers, 3) for _ in range(3))
            value = built(numbers.choice(OPERATIONS), a, b, c)
            low, high = e.bounds(value)
            for _ in range(5):
                texel = e.constant([numbers.random() for _ in range(3)])
                found = e.replaced(
                    value, lambda leaf, alpha: e.channel(texel, 0) if alpha else texel
                )
                self.assertTrue(found.constant)
                self.assertLessEqual(low, min(found.value) + 1e-6)
                self.assertGreaterEqual(high, max(found.value) - 1e-6)

    def random(self, numbers, depth):
        """An expression of one image."""
        pick = numbers.random()
        if depth == 0 or pick < 0.2:
            return e.texel("image") if pick < 0.5 else e.constant([numbers.random()] * 3)
        args = [self.random(numbers, depth - 1) for _ in range(3)]
        if pick < 0.3:
            return e.luma(args[0])
        return built(numbers.choice(OPERATIONS), *args)

    def test_affine_expressions_are_found_and_right(self):
        numbers = random.Random(3)
        found = 0
        for _ in range(2000):
            value = self.random(numbers, 3)
            form = affine(value)
            if form is None:
                continue
            found += 1
            texel = [numbers.random() for _ in range(4)]
            part = texel[:3]
            if form.channel == native.Channel.LUMA:
                part = [sum(w * c for w, c in zip(e.WEIGHTS, texel))] * 3
            elif form.channel != native.Channel.COLOR:
                part = [texel[form.channel - 1]] * 3
            expected = e.replaced(value, lambda leaf, alpha: e.constant(texel[:3])).value
            for k in range(3):
                self.assertAlmostEqual(form.offset[k] + form.scale[k] * part[k], expected[k])
        self.assertGreater(found, 200)

    def test_peeling_keeps_the_value(self):
        t = e.texel("image")
        inner = e.apply(Op.POWER, t, e.number(2.0))
        value = e.subtract(e.ONE, e.multiply(e.add(inner, e.number(0.5)), e.constant((2, 3, 4))))
        left, scale, offset = peeled(value)
        self.assertIs(left, inner)
        self.assertEqual(scale, (-2.0, -3.0, -4.0))
        self.assertEqual(offset, (0.0, -0.5, -1.0))

    def test_the_mean_of_what_is_unknown_is_the_ramps_mean(self):
        self.assertAlmostEqual(e.ramp(e.number(0.0, False), TABLE).value[0], 0.4)
        self.assertAlmostEqual(e.ramp(e.number(0.0), TABLE).value[0], 0.1)

    def test_unknown_operations_are_told(self):
        self.assertIsNone(node_math.maths("NEW IN 6.0", [e.ONE]))
        self.assertIsNone(node_math.maths("SINE", [e.texel("image")]))
        self.assertIsNone(node_math.blend("HUE", e.ONE, e.ONE, e.ONE))
        self.assertEqual(node_math.maths("LOGARITHM", [e.ZERO, e.ONE]).value[0], 0.0)


if __name__ == "__main__":
    unittest.main()
