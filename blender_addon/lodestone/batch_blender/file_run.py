# SPDX-License-Identifier: GPL-3.0-or-later
"""The half of batch.py that runs inside Blender: one file, one reading of it per frame."""

import contextlib
import json
import resource
import signal
import sys
import time
import traceback
from dataclasses import replace
from pathlib import Path

import bpy

PACKAGE = Path(__file__).resolve().parents[1]
if __name__ == "__main__":  # never enabled in any preferences: registered from its own folder
    sys.path.insert(0, str(PACKAGE.parent))

import lodestone  # noqa: E402
from lodestone.batch_blender.picture_work import BlenderPictureWork, SceneFolders  # noqa: E402
from lodestone.bridge import quality_settings  # noqa: E402
from lodestone.bridge.checks import blend_check, picture_requirements  # noqa: E402
from lodestone.bridge.motion import motion_sampling  # noqa: E402
from lodestone.bridge.scene import deforming_poses  # noqa: E402
from lodestone.bridge.scene_settings import SceneSettings  # noqa: E402
from lodestone.core import progress_text, report_parts, run_report  # noqa: E402
from lodestone.core.background_calls import Stopped, Work  # noqa: E402
from lodestone.core.batch import blend_header, input_stamps, process_session  # noqa: E402
from lodestone.core.batch.file_jobs import FileJob, PictureRequest  # noqa: E402
from lodestone.core.batch.picture_making import MAKERS  # noqa: E402
from lodestone.core.batch.verbs import verb_of  # noqa: E402
from lodestone.core.exit_codes import ExitCode, Failed  # noqa: E402
from lodestone.core.locked_folder import InUse  # noqa: E402
from lodestone.core.native import lodestone_native as native  # noqa: E402
from lodestone.core.picture import unseen_detail  # noqa: E402
from lodestone.core.picture.cost_model import CostMemory  # noqa: E402
from lodestone.core.picture.picture_maker import remove_others, used_files  # noqa: E402
from lodestone.core.problems import Problems  # noqa: E402
from lodestone.core.store import motion_file, store_path  # noqa: E402
from lodestone.engines import extract_engine  # noqa: E402


class FileRun:
    """Everything done with one file; `result` is its report."""

    def __init__(self, job: FileJob) -> None:
        self.job = job
        self.verb = verb_of(job.verb)
        self.result = run_report.file_report(job.verb, job.file, ExitCode.DONE)
        self.problems = Problems()
        self.work = Work()
        self.clock = progress_text.StageClock(0)
        self._said = 0.0
        self._still = None
        self._poses: deforming_poses.Poses | None = None
        self._folders = SceneFolders(job)
        self._costs = CostMemory()
        self._told = 0  # problems

    def run(self) -> ExitCode:
        code, text = ExitCode.DONE, ""
        try:
            self._check_outputs()
            self._open()
            with contextlib.closing(self), self._folders:
                self._frames()
        except (Stopped, KeyboardInterrupt):
            code, text = ExitCode.CANCELLED, "cancelled"
        except Failed as error:
            code, text = error.code, str(error)
        except native.LodestoneError as error:
            code, text = _code_of(error), str(error)
        except (extract_engine.CameraMissing, InUse) as error:
            code, text = ExitCode.FAILED, str(error)
        except Exception as error:
            traceback.print_exc()
            code, text = ExitCode.FAILED, f"Lodestone failed: {error!r}"
        if code == ExitCode.DONE and self.problems.wrong:
            code = ExitCode.FAILED if self.job.strict else ExitCode.INCOMPLETE
            text = f"the picture is incomplete: {self.problems.wrong[0].sentence}"
        self.result.update(run_report.file_report(self.job.verb, self.job.file, code, text))
        self.result["problems"] = run_report.problems_part(self.problems)
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
        self.result["memory"] = {"blender_peak_bytes": peak}
        run_report.write(self.job.report, self.result)
        return code

    # ---- Before ----

    def _check_outputs(self) -> None:
        """Hours of work must not end at a folder that cannot be written."""
        for picture in self.job.pictures:
            self.verb.check_output(picture.out)

    def _open(self) -> None:
        try:
            blend = input_stamps.read(self.job.file, ())  # before anybody can change it
            bpy.ops.wm.open_mainfile(
                filepath=self.job.file, load_ui=False, use_scripts=self.job.trust_scripts
            )
        except (OSError, RuntimeError) as error:
            text = " ".join(str(error).split()).removeprefix("Error: ")
            text += blend_header.written_by(self.job.file)
            raise Failed(ExitCode.UNREADABLE, f"Blender cannot read the file: {text}") from None
        others = bpy.utils.blend_paths(absolute=True, packed=False, local=False)
        self._tell(inputs={**blend, "others": input_stamps.stamps(others)})
        blend_check.repair_names(self.problems)
        blend_check.check_file(self.problems, self.job.trust_scripts)

    # ---- Pictures ----

    def _frames(self) -> None:
        scene = bpy.context.scene
        first, last = self.job.frames or (scene.frame_current, scene.frame_current)
        pictures: list[dict] = []
        if self.verb.runs_povray:
            picture_requirements.post_processing(scene, self.problems)
        if self.job.frames:
            # The same frames whichever part of the scene's range this process renders
            self._sample(scene, min(first, scene.frame_start), max(last, scene.frame_end))
        for frame in range(first, last + 1):
            requests = self.job.pictures
            if self.job.frames:
                requests = tuple(picture.for_frame(frame) for picture in requests)
            requests = tuple(picture for picture in requests if picture.out not in self.job.skip)
            if self.job.pictures and not requests:
                continue
            scene.frame_set(frame)
            self.clock = progress_text.StageClock(frame)
            pictures += [
                {**({"frame": frame} if self.job.frames else {}), **made}
                for made in self._frame(scene, requests)
            ]
            if pictures:
                many = self.job.many_pictures
                self.result.update({"pictures": pictures} if many else pictures[0])

    def _sample(self, scene, first: int, last: int) -> None:
        """Finds out which animated objects rest after all."""
        frames = motion_sampling.frames_to_sample(first, last)
        still = motion_sampling.sample(scene, bpy.context.view_layer, frames, self._tick)
        try:
            motion_file.write(store_path.store_folder(self.job.file, self.job.store), still)
        except OSError:
            pass  # a hint for the next job; this one has it
        self._still = still

    def _frame(self, scene, requests: tuple[PictureRequest, ...]) -> list[dict]:
        requests = tuple(_filled_up(scene, picture) for picture in requests)
        self.verb.check_requests(requests)
        builds = self.verb.builds_levels(requests)
        store = store_path.store_folder(self.job.file, self.job.store)
        request = extract_engine.Request(
            cameras=[(picture.camera, picture.size) for picture in requests],
            tick=self._tick,
            still=self._still,
            with_poses=self._poses is None and builds,
            structured=builds,  # pictures of the originals ask for no groups
            store=str(store),
        )
        wall, cpu = time.monotonic(), time.process_time()
        try:
            extraction = extract_engine.extract_now(scene, request)
        finally:
            if request.with_poses:
                self._poses = request.poses
        self.problems.extend(extraction.problems)
        if self.verb.asks_for_pictures:
            picture_requirements.grease_pencil(self.problems)
        with extraction.model as model:
            totals = model.totals()
            self.result.setdefault("model", report_parts.model_part(totals))
            spent = {"cpu_s": time.process_time() - cpu, "wall_s": time.monotonic() - wall}
            self.result.setdefault("extract", spent)
            if totals.occurrences == 0 and not picture_requirements.something(scene, self.problems):
                raise Failed(ExitCode.FAILED, picture_requirements.NOTHING)
            self.clock.tail = f"{progress_text.count(totals.triangles_placed)} triangles"
            self.result["store"] = str(store)
            try:
                built = {}
                if builds:
                    part = self._build(model, store)
                    built = {"build": part} if self.job.frames else {}
                made, used = [], set()
                seen = zip(requests, request.frames, request.modifiers)
                for picture, (view, size), modifiers in seen:
                    modifiers = _asked(modifiers, picture)
                    work = BlenderPictureWork(
                        self.job, picture, scene, model, view, size, modifiers,
                        store, self._costs, self._folders, self.work, self._say,
                    )  # fmt: skip
                    made.append({**work.about, **MAKERS[self.job.verb](work), **built})
                    self.problems.extend_native(model.problems())
                    self.problems.extend(work.problems)
                    self._tell_picture(picture.out, made[-1])
                    if self._folders.shared is not None:
                        used |= used_files(self._folders.shared.path)
                if self._folders.shared is not None:
                    remove_others(self._folders.shared.path, used)
            finally:
                self.problems.extend_native(model.problems())
        return made

    def close(self) -> None:
        """Frees the poses that levels follow."""
        if self._poses is not None:
            self._poses.close()

    def _build(self, model, store: Path) -> dict:
        try:
            store.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise Failed(ExitCode.FAILED, f"cannot make the folder of the levels: {error}")
        models = self._poses.models if self._poses is not None else ()
        options = native.BuildOptions(threads=self.job.threads, poses=models)
        options.of_one_frame = 1 if self.job.frames else 0
        done = self._long(lambda: model.build(str(store), options, self.work.new_job("Levels")))
        part = report_parts.build_part(done)
        self.result.setdefault("build", part)
        return part

    # ---- What is told at once, for the case that this process does not live to its report ----

    def _tell(self, **event) -> None:
        path = Path(self.job.report).with_name(run_report.EVENTS)
        with open(path, "a", encoding="utf-8") as file:
            file.write(json.dumps(event) + "\n")

    def _tell_picture(self, out: str, made: dict) -> None:
        problems = run_report.problems_part(self.problems)
        new, self._told = problems[self._told :], len(problems)
        self._tell(out=out, made={**made, **({"problems": new} if new else {})})

    # ---- Progress ----

    def _long(self, function):
        return self.work.run(function, self._say)

    def _tick(self) -> None:
        if self.work.stopping:
            raise Stopped
        self._print("Extract", None)

    def _say(self) -> None:
        stage = self.work.stage
        if self.work.library_stage == native.Stage.PARSE:
            stage = "Parse"
        self._print(stage, self.work.fraction)

    def _print(self, stage: str, fraction: float | None) -> None:
        now = time.monotonic()
        line = self.clock.line(stage, now, fraction)
        if now - self._said > 0.5:
            self._said = now
            print(f"Lodestone: progress: {line}", flush=True)


def _filled_up(scene, picture: PictureRequest) -> PictureRequest:
    """What neither the command line nor a profile says is as the file has it."""
    own = SceneSettings(scene)
    error, budget = picture.pixel_error, picture.budget
    overrides = {**quality_settings.overrides(own), **picture.overrides}
    if picture.antialias is not None:
        overrides["antialias"] = picture.antialias.upper()
    return replace(
        picture,
        pixel_error=quality_settings.pixel_error(own) if error is None else error,
        budget=quality_settings.budget(own) if budget is None else budget,
        overrides=overrides,
    )


def _asked(modifiers, picture: PictureRequest):
    """The file's, with what a picture says about what it does not show."""
    changed = {}
    if picture.off_screen is not None:
        changed["off_screen"] = native.OffScreen[picture.off_screen.upper()]
    if picture.ray_classes is not None:
        changed["ray_classes"] = unseen_detail.rays_of(picture.ray_classes)
    if not changed:
        return modifiers
    return replace(native.Modifiers() if modifiers is None else modifiers, **changed)


def _code_of(error) -> ExitCode:
    if error.status in (native.Status.POVRAY_MISSING, native.Status.POVRAY_FAILED):
        return ExitCode.POVRAY
    return ExitCode.CANCELLED if error.cancelled else ExitCode.FAILED


def main() -> None:
    job = FileJob.load(Path(sys.argv[sys.argv.index("--") + 1]).read_text("utf-8"))
    process_session.follow(job.supervisor)
    process_session.speak_in_lines()
    lodestone.register(data_only=True)
    run = FileRun(job)
    signal.signal(signal.SIGTERM, lambda number, frame: run.work.stop())
    run.run()
    process_session.end_at_once()


if __name__ == "__main__":
    main()
