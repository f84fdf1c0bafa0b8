# SPDX-License-Identifier: GPL-3.0-or-later
"""What Pixel Error buys on scenes made by others: triangles, memory, time and likeness over it.

    /usr/bin/python3 samples/curves.py --data FOLDER [--out build/curves] [--write]

Renders the scenes of real_scenes.py at full detail and at Pixel Error 0.25 to 8 (Figure 5.10 of the
dissertation); writes report.md and curves.svg. Shares are of full detail; bytes are the memory of
POV-Ray that the export foretells, which small scenes do not lose among what an empty one takes.
With --write the curves and the table go to samples/docs.
"""

import argparse
import sys
from pathlib import Path

import real_scenes
from chart import Chart, svg

PIXEL_ERRORS = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0)


def charts(found: dict[str, dict[float, dict]]) -> list[Chart]:
    """Of what real_scenes.render() gives."""
    sys.path.insert(0, str(real_scenes.ADDON))
    import lodestone_native as native

    measures = {
        "triangles, % of full detail": lambda made: made["cut"]["triangles"],
        "bytes, % of full detail": lambda made: made["cut"]["bytes"],
        "CPU seconds, % of full detail": lambda made: (
            made["povray"]["parse_cpu_s"] + made["povray"]["trace_cpu_s"]
        ),
    }
    made_of = []
    for title, measure in measures.items():
        lines = {}
        for name, pictures in found.items():
            whole = measure(pictures[0.0]) or 1
            lines[name] = [100 * measure(pictures[t]) / whole for t in PIXEL_ERRORS]
        made_of.append(Chart(title, 0, 120, (0, 20, 40, 60, 80, 100, 120), lines))
    likeness = {
        name: [
            native.image_compare(pictures[0.0]["picture"], pictures[t]["picture"]).ssim
            for t in PIXEL_ERRORS
        ]
        for name, pictures in found.items()
    }
    marks = (0.75, 0.8, 0.85, 0.9, 0.95, 1)
    return [*made_of, Chart("SSIM, whole picture", 0.75, 1, marks, likeness)]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder with scenes/ in it")
    parser.add_argument("--out", type=Path, default=Path("build/curves"))
    parser.add_argument("--size", default="640x360", metavar="WxH")
    parser.add_argument("--write", action="store_true", help="also the page of results")
    options = parser.parse_args()
    out = options.out.resolve()
    blends = real_scenes.prepare(options.data.resolve(), out)
    found = real_scenes.render(blends, out, options.size, (0.0, *PIXEL_ERRORS))
    drawn = svg(charts(found), [f"{t:g}" for t in PIXEL_ERRORS], "Pixel Error, px")
    (out / "curves.svg").write_text(drawn, "utf-8")
    text = real_scenes.table(found, options.size)
    (out / "report.md").write_text("# Real scenes over Pixel Error\n\n" + text, "utf-8")
    print(f"\n{text}\ncurves: {out / 'curves.svg'}\nreport: {out / 'report.md'}")
    if options.write:
        (real_scenes.HERE / "docs" / "curves.svg").write_text(drawn, "utf-8")
        real_scenes.write_page("curves", "Real scenes over Pixel Error", text, found)


if __name__ == "__main__":
    main()
