# SPDX-License-Identifier: GPL-3.0-or-later
"""The rival of every level of detail: the same picture of full detail, sampled less finely.

    /usr/bin/python3 tests/bench/peers/bench_rival.py [--views zengarden/near ...] [--resume]
        [--pixel-errors 1 2 4 8] [--size 320 180] [--cache FOLDER] [--write]

Views, scenes and CPU seconds as in bench_real.py. The rival's pictures are one export at Pixel
Error 0 for each number of rays along the edge of a lamp (1, 3, 5), drawn by POV-Ray without
antialiasing, with 2 x 2 samples where neighbors differ by 0.4, and with 3 x 3 where they differ by
0.1; blurred by the same filter and shown by the same view transform, which costs it nothing. Of
those that take no longer than ours at a Pixel Error the best one is told beside ours, by SSIM to
full detail with 16 samples in every pixel; where all take longer, the fastest. No number makes it
fail.
"""

import json
import re
import shutil
import sys
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from bench import benching  # noqa: E402
from bench.peers import bench_real  # noqa: E402

AREA_SAMPLES = (1, 3, 5)
FILTER_SIZE = 1.5  # Blender's own, which the scenes have


class RivalSampling(NamedTuple):
    word: str
    threshold: float  # 0: no antialiasing
    depth: int


SAMPLINGS = (
    RivalSampling("off", 0, 1),
    RivalSampling("0.4, 2 x 2", 0.4, 2),
    RivalSampling("0.1, 3 x 3", 0.1, 3),
)


def sampled(ini: str, sampling: RivalSampling) -> str:
    """The text of scene.ini with another antialiasing."""
    kept = [line for line in ini.splitlines() if not re.match("Antialias|Sampling_Method", line)]
    if sampling.threshold == 0:
        return "\n".join([*kept, "Antialias=Off", ""])
    own = [
        "Antialias=On", "Sampling_Method=1", f"Antialias_Threshold={sampling.threshold}",
        f"Antialias_Depth={sampling.depth}", "",
    ]  # fmt: skip
    return "\n".join([*kept, *own])


class RivalView(bench_real.View):
    """A view, and its pictures by the rival."""

    def measure_rival(self) -> dict:
        """All numbers of the view."""
        opening = self.opening()
        mask = self.cycles(4, transparent=True)
        self.batch("build", "build")
        reference = self.drawn("reference", 0, "--antialias", "reference").picture

        def ssim(picture: Path) -> float:
            compare = self.options.native.image_compare
            return compare(str(reference), str(picture), str(mask)).ssim

        found: dict = {"ours": {}, "rival": []}
        for error in self.options.pixel_errors:
            cpu, picture, _ = self.drawn(f"{error:g}px", error)
            found["ours"][f"{error:g}"] = {"cpu_s": cpu - opening, "ssim": ssim(picture)}
        drawn = {}
        for area in AREA_SAMPLES:
            folder = self.out / f"rival_{area}"
            shutil.rmtree(folder, ignore_errors=True)
            more = ("--antialias", "final", "--area-samples", str(area))
            _, export = self.seen("export", folder.name, folder, 0, *more)
            ini = (folder / "scene.ini").read_text("utf-8")
            for sampling in SAMPLINGS:
                before = bench_real.children_cpu()
                exr = self._trace(folder, ini, sampling)
                cpu = export - opening + bench_real.children_cpu() - before
                drawn[str(exr)] = str(exr.with_suffix(".png"))
                found["rival"].append(
                    {"antialias": sampling.word, "area_samples": area, "cpu_s": cpu,
                     "picture": drawn[str(exr)]}
                )  # fmt: skip
        self._show(drawn)
        for one in found["rival"]:
            one["ssim"] = ssim(Path(one.pop("picture")))
        return found

    def _trace(self, folder: Path, ini: str, sampling: RivalSampling) -> Path:
        """The folder's picture by POV-Ray, as it computes it."""
        native = self.options.native
        (folder / "scene.ini").write_text(sampled(ini, sampling), "utf-8")
        options = native.PovrayOptions(
            antialias=native.Antialias.FINAL if sampling.threshold else native.Antialias.OFF,
            antialias_depth=sampling.depth,
            filter_size=FILTER_SIZE,
        )
        name = f"rival_{sampling.depth}.exr"
        try:
            native.povray_run(str(folder), name, options)
        except native.LodestoneError as error:
            raise bench_real.Missing(f"POV-Ray failed in {folder}: {error}") from error
        return folder / name

    def _show(self, pictures: dict[str, str]) -> None:
        """Saves pictures as F12 would, by the view transform of the file."""
        asked = self.out / "rival_shown.json"
        asked.write_text(json.dumps({"pictures": pictures}), "utf-8")
        command = ["blender", "-b", "--factory-startup", self.blend, "--python-exit-code", "1"]
        command += ["--python", bench_real.INSIDE, "--", "show", asked]
        bench_real.cpu_of(command, self.out / "rival_shown.log")


def best(rival: list[dict], cpu_s: float) -> tuple[dict, bool]:
    """The nearest of those that take no longer, and True; where there are none, the fastest."""
    within = [one for one in rival if one["cpu_s"] <= cpu_s]
    if within:
        return max(within, key=lambda one: one["ssim"]), True
    return min(rival, key=lambda one: one["cpu_s"]), False


def table(found: dict[str, dict]) -> list[str]:
    lines = [
        "| view | Pixel Error | our CPU s | our SSIM | the rival's antialiasing, area samples "
        "| its CPU s | its SSIM | nearer |",
        "|---|---|---|---|---|---|---|---|",
    ]
    words: dict[str, list[str]] = {}
    for name, view in found.items():
        for error, ours in view["ours"].items():
            one, in_time = best(view["rival"], ours["cpu_s"])
            word = "ours" if ours["ssim"] >= one["ssim"] else "the rival"
            if not in_time:
                word += ", but it takes longer" if word == "the rival" else "; it takes longer"
            words.setdefault(error, []).append(word)
            lines.append(
                f"| {name} | {error} | {ours['cpu_s']:.1f} | {ours['ssim']:.3f} "
                f"| {one['antialias']}; {one['area_samples']} | {one['cpu_s']:.1f} "
                f"| {one['ssim']:.3f} | {word} |"
            )
    lines.append("")
    for error, found_words in words.items():
        lost = found_words.count("the rival")
        slower = sum(word.endswith("longer") for word in found_words)
        nearer = found_words.count("the rival, but it takes longer")
        lines.append(
            f"- At {error} px, {len(found_words)} views: in {lost} a rival's picture is nearer "
            f"that takes no longer. In {slower} none is as fast; the fastest is nearer in {nearer}."
        )
    return lines


def main() -> None:
    options = bench_real.options_of(about=__doc__, errors=(1, 2, 4, 8))
    options.native = bench_real.staged_native()
    busy = benching.load()
    shown = bench_real.measured(
        options, "rival.json",
        lambda name, scenes: RivalView(name, scenes, options).measure_rival(), table,
    )  # fmt: skip
    told = benching.Told()
    told.tell(f"{options.size[0]} x {options.size[1]}.\n")
    told.tell("\n".join(table(shown)))
    page = benching.results_path(options, "rival")
    benching.write_results(page, "The rival", told, {"load_before": busy, "views": shown})


if __name__ == "__main__":
    main()
