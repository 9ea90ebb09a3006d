"""Runs of the program, on the engine of sweeps, and their results: figures, errors, pictures, meshes.

measure() of an experiment declares its runs, yields, and then reads their results. The runs of all experiments are executed together.
"""
import json
import shlex
import tomllib
from functools import cached_property
from pathlib import Path

from emitted_mesh import read_mesh
from program import FOLDER, Task, effective_job, run_commands, set_options
from sweep_file import JOBS

ROOT = Path(__file__).resolve().parent.parent.parent


class ProgramError(Exception):
    """A command ended with an unexpected exit code, or did not end."""


class Study:
    """The runs of an experiment, and its pictures."""

    # The golden model checks every edge of every run; files that are not used here are not written.
    QUIET = {"mode": "functional", "check.end_to_end": False, "output.obj": False, "output.picture": False}

    def __init__(self, name, options, store, content_hash):
        self.place = f"runs/figures/runs/{name}"
        self.program = options.program
        self.picture_width = options.picture_width
        self.store = store
        self.hash = content_hash
        self.runs = []
        self.pictures = []

    def run(self, name, job=None, settings=None, error=False, keep=True):
        """job: a name in testbench/examples/jobs, or None for the half donut. error: measured as `tessera compare` does.
        keep: keep the files, for meshes and pictures."""
        job, settings = job and JOBS / f"{job}.toml", {**self.QUIET, **(settings or {})}
        content, inputs = self._content(job, settings)
        return self.add(name, [content, error], run_commands(self.program, job, settings, error), keep, inputs)

    def tune(self, name, triangles, job=None, tests="normal,summed_height", settings=None, grid=None, metric=None, run=True):
        """A run with the thresholds (and, with `grid`, the base mesh) of least error for a number of triangles; without `run`
        only the result of `tessera tune`."""
        job, settings, tuned = job and JOBS / f"{job}.toml", settings or {}, f"{FOLDER}/tuned.toml"
        tune = self.words("tune", job, "--triangles", triangles, "--tests", tests, "--output", tuned, grid and "--grid", grid,
                          metric and "--metric", metric, *set_options(settings))
        content, inputs = self._content(job, settings)
        return self.add(name, [content, tune[1:], self.QUIET],
                        [tune, *(run_commands(self.program, tuned, self.QUIET, True) if run else [])], inputs=inputs)

    def bake(self, name, surface, mesh=None):
        """A run on the map baked from a surface file, over the mesh of a job."""
        bake = self.words("bake", surface, mesh and "--mesh", mesh, "--output", f"{FOLDER}/{name}.exr")
        content, inputs = self._content(mesh, {}) if mesh else ({}, {})
        return self.add(name, [self.hash.file(surface), content, self.QUIET],
                        [bake, *run_commands(self.program, f"{FOLDER}/{name}.job.toml", self.QUIET, True)],
                        inputs={**inputs, str(surface): self.hash.seen(surface)})

    def words(self, *arguments):
        return [str(word) for word in (self.program, *arguments) if word is not None]

    def _content(self, job, settings):
        """What a run depends on, and its task's inputs."""
        inputs = self.hash.inputs_of_job(job)
        keys = effective_job(self.program, job, settings)
        folder = job.parent if job else Path()
        return self.hash.job(keys, folder), {**inputs, **self.hash.inputs(keys, folder)}

    def add(self, name, content, commands, keep=True, inputs=None):
        """content: everything that the result depends on."""
        self.runs.append(Run(self, name, Task(self.hash.address(content, keep), commands, keep, inputs or {})))
        return self.runs[-1]

    @property
    def commands(self):
        """In the form shown on the page."""
        return [self.nameless(shlex.join(word.replace(FOLDER, f"{self.place}/{run.name}") for word in
                                         [Path(command[0]).name, *command[1:]]))
                for run in self.runs for command in run.task.commands]

    def nameless(self, text):
        """Removes paths of this machine."""
        for run in self.runs:
            text = text.replace(str(run.files), f"{self.place}/{run.name}")
        return text.replace(f"{ROOT}/", "").replace(str(self.program), "tessera")


class Run:
    def __init__(self, study, name, task):
        self.study = study
        self.name = name
        self.task = task
        self.files = study.store.files(task.key)
        self.folder = self.files / "run"

    @cached_property
    def result(self):
        key, store = self.task.key, self.study.store
        if not store.has(key):
            raise ProgramError(f"{self.name}: {store.failure(key)}")
        return store.read(key)

    def finished(self):
        """The result of a run that did not fail."""
        if self.result["exit_code"] != 0:
            raise ProgramError(f"{self.name}: exit code {self.result['exit_code']}: {self.result['reason']}")
        return self.result

    @cached_property
    def figures(self):
        return {name: value for name, (value, _) in self.finished()["figures"].items()}

    @property
    def triangles(self):
        return self.figures["mesh.triangles"]

    @cached_property
    def error(self):
        return {name.removeprefix("error."): value for name, value in self.figures.items() if name.startswith("error.")}

    @cached_property
    def mesh(self):
        self.finished()
        return read_mesh(self.folder / "mesh.ply")

    @cached_property
    def job(self):
        """Every key."""
        self.finished()
        return tomllib.loads((self.folder / "job.toml").read_text())

    @property
    def tuned(self):
        """The result of `tessera tune`."""
        self.finished()
        return json.loads((self.files / "tuned.json").read_text())

    def render(self, view, name=None, **options):
        """A picture, NAME.png, drawn after the page's figures; options of `tessera render` with underscores for hyphens."""
        width = self.study.picture_width
        file, words = f"{name or view}.png", []
        for option, value in {"size": f"{width}x{width * 3 // 4}", **options}.items():
            words += ["--" + option.replace("_", "-"),
                      *(value if isinstance(value, (list, tuple)) else [] if value is True else [value])]
        render = self.study.words("render", self.folder, "--view", view, "--output", f"{FOLDER}/{file}", *words)
        self.study.pictures.append(self.study.add(self.name, render[1:], [render]))
        return self.study.pictures[-1].files / file
