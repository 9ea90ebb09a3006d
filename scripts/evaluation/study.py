"""Runs of the program and their results: figures, errors, pictures, meshes."""
import json
import shlex
import subprocess
from functools import cached_property
from pathlib import Path

from emitted_mesh import read_mesh

ROOT = Path(__file__).resolve().parent.parent.parent
JOBS = ROOT / "testbench/examples/jobs"


class ProgramError(Exception):
    """The program ended with an unexpected exit code."""


def toml(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml(item) for item in value) + "]"
    return str(value)


def figures_of(path):
    """{"group.name": value} of a JSON report of tessera, without non-numeric entries (a verdict, remarks)."""
    groups = {name: group for name, group in json.loads(path.read_text()).items() if isinstance(group, dict)}
    return {f"{group}.{name}": figure["value"] for group, figures in groups.items()
            for name, figure in figures.items() if isinstance(figure, dict) and "value" in figure}


class Study:
    """Runs the program in a separate folder per experiment and records every command."""

    # The golden model checks every edge of every run; files that are not used here are not written.
    QUIET = {"mode": "functional", "check.end_to_end": False, "output.obj": False, "output.picture": False}

    def __init__(self, program, folder, picture_width):
        self.program = program
        self.folder = folder
        self.picture_width = picture_width
        self.commands = []

    def call_highlight_study(self):
        """Runs the separate program that measures per-vertex light, on the half donut."""
        return self.call(program=self.program.parent.parent / "benchmark/tessera_highlight_study")

    def call(self, *arguments, exit_codes=(0,), program=None):
        command = [str(program or self.program), *(str(argument) for argument in arguments)]
        self.commands.append(shlex.join([Path(command[0]).name, *command[1:]]))
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode not in exit_codes:
            raise ProgramError(f"exit code {done.returncode} of {shlex.join(command)}\n{done.stderr.strip()}")
        return done

    def tune(self, name, triangles, job=None, tests="normal,summed_height", settings=None, grid=None):
        """A run with the thresholds (and, with `grid`, the base mesh) of least RMS error for a number of triangles."""
        self.folder.mkdir(parents=True, exist_ok=True)
        tuned = self.folder / f"{name}.toml"
        arguments = ["tune"] + ([] if job is None else [JOBS / f"{job}.toml"])
        arguments += ["--triangles", triangles, "--tests", tests, "--output", tuned]
        if grid is not None:
            arguments += ["--grid", grid]
        for key, value in (settings or {}).items():
            arguments += ["--set", f"{key}={toml(value)}"]
        self.call(*arguments)
        run = self.run(name, tuned)
        run.tuned = json.loads(tuned.with_suffix(".json").read_text())
        return run

    def run(self, name, job=None, settings=None, exit_codes=(0,)):
        """job: a name in testbench/examples/jobs, a path, or None for the half donut."""
        folder = self.folder / name
        arguments = ["run"]
        if job is not None:
            arguments.append(job if isinstance(job, Path) else JOBS / f"{job}.toml")
        for key, value in {**self.QUIET, **(settings or {}), "output.folder": folder}.items():
            arguments += ["--set", f"{key}={toml(value)}"]
        done = self.call(*arguments, exit_codes=exit_codes)
        return Run(self, folder, done.returncode)


class Run:
    """A finished run's folder."""

    def __init__(self, study, folder, exit_code=0):
        self.study = study
        self.folder = folder
        self.exit_code = exit_code
        self.tuned = None  # the JSON result of `tessera tune`

    @cached_property
    def figures(self):
        return figures_of(self.folder / "statistics.json")

    @cached_property
    def conformance(self):
        return figures_of(self.folder / "conformance.json")

    @property
    def triangles(self):
        return self.figures["mesh.triangles"]

    @cached_property
    def mesh(self):
        return read_mesh(self.folder / "mesh.ply")

    @cached_property
    def error(self):
        """The error against the densely displaced surface with the map interpolated: see `tessera compare`."""
        self.study.call("compare", self.folder)
        return figures_of(self.folder / "error.json")

    def render(self, view, name=None, **options):
        """A picture next to the mesh, or NAME.png; options of `tessera render` with underscores for hyphens."""
        output = self.folder / f"{name or view}.png"
        arguments = ["render", self.folder, "--view", view, "--output", output]
        if "size" not in options:
            options["size"] = f"{self.study.picture_width}x{self.study.picture_width * 3 // 4}"
        for option, value in options.items():
            arguments.append("--" + option.replace("_", "-"))
            if value is not True:
                arguments += value if isinstance(value, (list, tuple)) else [value]
        self.study.call(*arguments)
        return output
