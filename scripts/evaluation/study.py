"""Runs of the program, on the engine of sweeps, and their results: figures, errors, pictures, meshes.

measure() of an experiment names its runs, yields, and then reads them. What all experiments have named runs together.
"""
import json
import shlex
from functools import cached_property
from pathlib import Path

from emitted_mesh import read_mesh
from program import FOLDER, Task, effective_job, file_hash, run_commands, set_options
from sweep_file import JOBS

ROOT = Path(__file__).resolve().parent.parent.parent


class ProgramError(Exception):
    """A command ended with an unexpected exit code, or came to no end."""


class Study:
    """The runs of an experiment, and its commands as the page shows them."""

    # The golden model checks every edge of every run; files that are not used here are not written.
    QUIET = {"mode": "functional", "check.end_to_end": False, "output.obj": False, "output.picture": False}

    def __init__(self, name, options, store, content_hash, pool):
        self.place = f"runs/figures/runs/{name}"
        self.program = options.program
        self.picture_width = options.picture_width
        self.store = store
        self.hash = content_hash
        self.pool = pool  # for asking the program for effective jobs
        self.runs = {}
        self.pictures = []

    def run(self, name, job=None, settings=None, error=False, keep=True):
        """job: a name in testbench/examples/jobs, or None for the half donut. error: measured as `tessera compare` does.
        keep: the files stay, for meshes, pictures and frames."""
        job, settings = job and JOBS / f"{job}.toml", {**self.QUIET, **(settings or {})}
        return self._add(name, lambda: [self._content(job, settings), error, keep],
                         run_commands(self.program, job, settings, error), keep)

    def tune(self, name, triangles, job=None, tests="normal,summed_height", settings=None, grid=None):
        """A run with the thresholds (and, with `grid`, the base mesh) of least RMS error for a number of triangles."""
        job, tuned = job and JOBS / f"{job}.toml", f"{FOLDER}/tuned.toml"
        tune = [str(self.program), "tune", *([str(job)] if job else []), "--triangles", str(triangles), "--tests", tests,
                "--output", tuned, *(["--grid", grid] if grid else []), *set_options(settings or {})]
        return self._add(name, lambda: [self._content(job, settings or {}), tune[2:], self.QUIET],
                         [tune, *run_commands(self.program, tuned, self.QUIET, True)])

    def bake(self, name, surface, mesh=None):
        """A run on the map that a surface file gives over the mesh of another file."""
        bake = [str(self.program), "bake", str(surface), *(["--mesh", str(mesh)] if mesh else []),
                "--output", f"{FOLDER}/{name}.exr"]
        return self._add(name, lambda: [[file_hash(file) for file in (surface, mesh) if file], self.QUIET],
                         [bake, *run_commands(self.program, f"{FOLDER}/{name}.job.toml", self.QUIET, True)])

    def highlight_study(self):
        """The separate program that measures per-vertex light, on the half donut."""
        program = self.program.parent.parent / "benchmark/tessera_highlight_study"
        return self._add("study", lambda: [file_hash(program)], [[str(program)]], keep=False)

    def _content(self, job, settings):
        return self.hash.job(effective_job(self.program, job, settings), job.parent if job else Path())

    def _add(self, name, content, commands, keep=True):
        """content: called for what the result depends on."""
        run = Run(self, name, commands, keep, self.pool.submit(lambda: self.hash.address(*content())))
        self.runs[name] = run
        return run

    def tasks(self):
        """Those of the runs that the program does not refuse."""
        for run in [*self.runs.values(), *self.pictures]:
            if not run.address.exception():
                yield run.task

    @property
    def commands(self):
        named = [*self.runs.values(), *self.pictures]
        return [self.nameless(shlex.join(word.replace(FOLDER, f"{self.place}/{run.name}") for word in
                                         [Path(command[0]).name, *command[1:]]))
                for run in named for command in run.commands]

    def nameless(self, text):
        """Removes this machine's paths."""
        for run in self.runs.values():
            if not run.address.exception():
                text = text.replace(str(run.files), f"{self.place}/{run.name}")
        return text.replace(f"{ROOT}/", "").replace(str(self.program), "tessera")


class Run:
    def __init__(self, study, name, commands, keep, address):
        self.study = study
        self.name = name
        self.commands = commands
        self.keep = keep
        self.address = address  # a future

    @property
    def task(self):
        return Task(self.address.result(), self.commands, self.keep)

    @property
    def files(self):
        return self.study.store.files(self.address.result())

    @property
    def folder(self):
        return self.files / "run"

    @cached_property
    def result(self):
        key, store = self.address.result(), self.study.store
        if not store.has(key):
            raise ProgramError(f"{self.name}: {store.failure(key)}")
        return store.read(key)

    @property
    def exit_code(self):
        return self.result["exit_code"]

    def finished(self):
        """The result of a run that did not fail."""
        if self.exit_code != 0:
            raise ProgramError(f"{self.name}: exit code {self.exit_code}: {self.result['reason']}")
        return self.result

    @cached_property
    def figures(self):
        return {name: value for name, (value, _) in self.finished()["figures"].items()}

    @property
    def triangles(self):
        return self.figures["mesh.triangles"]

    @cached_property
    def mesh(self):
        self.finished()
        return read_mesh(self.folder / "mesh.ply")

    @property
    def tuned(self):
        """What `tessera tune` found; None for another run."""
        file = self.files / "tuned.json"
        return json.loads(file.read_text()) if file.is_file() else None

    @cached_property
    def error(self):
        """The error against the densely displaced surface with the map interpolated: see `tessera compare`."""
        return {name.removeprefix("error."): value for name, value in self.figures.items() if name.startswith("error.")}

    def render(self, view, name=None, part="", **options):
        """A picture, NAME.png, drawn at the end; options of `tessera render` with underscores for hyphens. part: of the
        run's folder, a frame."""
        self.finished()
        file = f"{name or view}.png"
        arguments = ["render", str(self.folder / part), "--view", view, "--output", f"{FOLDER}/{file}"]
        if "size" not in options:
            options["size"] = f"{self.study.picture_width}x{self.study.picture_width * 3 // 4}"
        for option, value in options.items():
            arguments.append("--" + option.replace("_", "-"))
            if value is not True:
                arguments += map(str, value if isinstance(value, (list, tuple)) else [value])
        picture = Run(self.study, self.name, [[str(self.study.program), *arguments]], True,
                      self.study.pool.submit(lambda: self.study.hash.address(arguments)))
        self.study.pictures.append(picture)
        return picture.files / file
