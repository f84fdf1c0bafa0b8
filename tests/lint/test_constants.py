# SPDX-License-Identifier: GPL-3.0-or-later
"""Guards that every named number of the C++ sources says where it comes from: `Law:` (which one),
`Fitted:` (by which script, on which data) or `Taste:` (what a larger value does)."""

import unittest

from cpp_comments import named_numbers, not_agreed, product_sources, to_do
from repository import text_of

# Files with numbers that give no reason yet. The list only ever shrinks.
TO_DO = "constants_to_do.txt"


def unexplained(text: str) -> list[str]:
    return [f"{n.line}: {n.name}" for n in named_numbers(text) if not n.has_reason]


class TheCheck(unittest.TestCase):
    def names(self, text: str) -> list[str]:
        return [number.name for number in named_numbers(text)]

    def test_a_number_without_a_reason_is_found(self):
        for bad in (
            "constexpr double kMost = 3;\n",
            "// The most that are kept.\nconstexpr double kMost = 3;\n",
            "void f() {\n    constexpr size_t kMost{3};\n}\n",
            "struct Tree {\n    static constexpr int kMost = 3;  // nodes\n};\n",
            "// Taste: of another.\n\nconstexpr double kMost = 3;\n",
            "constexpr double kLess = 2;  // Taste: of another.\nconstexpr double kMost = 3;\n",
            "static const double kMost = [] {\n    return 3;\n}();\n",
            "constexpr glm::vec4 kMost(1);\n",
            'constexpr const char* kText = "Law: 3";\nconstexpr double kMost = 3;\n',
        ):
            self.assertEqual(len(unexplained(bad)), 1, bad)
            self.assertIn("kMost", unexplained(bad)[0])

    def test_a_reason_stands_above_or_behind(self):
        for good in (
            "constexpr double kMost = 3;  // Taste: a larger one is slower.\n",
            "/// The most. Law: Shannon 1949.\ninline constexpr double kMost = 3;\n",
            "// The most that are kept.\n// Fitted: by bench.py on the street.\n"
            "constexpr double kMost = 3;\n",
            "constexpr std::array<double, 2> kMost{1,  // Law: both are exact.\n    2};\n",
        ):
            self.assertEqual(self.names(good), ["kMost"], good)
            self.assertEqual(unexplained(good), [], good)

    def test_names_of_other_things_are_no_numbers(self):
        for other in (
            "constexpr uint32_t kNone = ~uint32_t{0};\n",
            'constexpr std::array<const char*, 3> kNames{"1", "2", "3"};\n',
            "constexpr float kPi = static_cast<float>(glm::pi);\n",
            "constexpr double kHuge = std::numeric_limits<double>::max();\n",
            "constexpr double cube(double x) { return 3 * x; }\n",
            "if constexpr (kMost == 3) {\n}\n",
            "double kept(const Mesh& mesh, double most = 3);\n",
            "// constexpr double kMost = 3;\n",
            'const char* text = R"(\nconstexpr double kMost = 3;\n)";\n',
        ):
            self.assertEqual(self.names(other), [], other)

    def test_digits_that_are_parted_do_not_open_a_text(self):
        text = "constexpr int kMost = 1'000'000;\nconstexpr int kFew = 1'0;  // Taste: a few.\n"
        self.assertEqual(self.names(text), ["kMost", "kFew"])
        self.assertEqual(unexplained(text), ["1: kMost"])


class TheSources(unittest.TestCase):
    maxDiff = None

    def test_every_named_number_gives_its_reason(self):
        sources = product_sources()
        self.assertGreater(len(sources), 400)
        found = {name: lines for name in sources if (lines := unexplained(text_of(name)))}
        self.assertEqual(not_agreed(found, to_do(TO_DO)), {})

    def test_many_numbers_are_looked_at(self):
        numbers = [n for name in product_sources() for n in named_numbers(text_of(name))]
        self.assertGreater(len(numbers), 400)


if __name__ == "__main__":
    unittest.main()
