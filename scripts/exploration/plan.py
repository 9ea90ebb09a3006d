"""The runs of a sweep: the product of its scenes and axes, each with its effective job and the address of its result."""
import itertools
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

from program import QUIET, ContentHash, Refused, Task, effective_job, files_of, run_commands


@dataclass
class Design:
    number: int
    scene: str
    cells: tuple  # of the table's axis columns
    job: Path
    settings: dict
    key: str = ""
    inputs: dict = field(default_factory=dict)  # of the task
    refused: str = ""  # why the program does not accept the job
    positions: tuple = field(default=())


class Planner:
    def __init__(self, sweep, program):
        self.sweep = sweep
        self.program = program
        self.hash = ContentHash(program)

    def check_keys(self):
        """Every key of the sweep file is one of the program's, and every file that it names exists."""
        sweep, jobs = self.sweep, {}
        for scene, job in sweep.scenes.items():
            try:
                known = jobs[scene] = effective_job(self.program, job, {})
            except Refused as refused:
                raise sweep.error(refused, sweep.line_of(scene)) from None
        taken = {}
        entries = [(key, sweep.line_of("[set]")) for key in sweep.settings]
        entries += [(key, axis.line) for axis in sweep.axes for key in {k: 0 for p in axis.points for k in p.settings}]
        for key, line in entries:
            place = sweep.line_of(key, line)
            if key not in known:
                raise sweep.error(f"unknown key `{key}`; `tessera keys` lists them all", place)
            if key in taken and taken[key] != sweep.line_of("[set]"):
                raise sweep.error(f"`{key}` is also on another axis, line {taken[key]}", place)
            taken[key] = line
        for scene, keys in jobs.items():
            self._check_files({key: value for key, value in keys.items() if key not in taken}, sweep.scenes[scene].parent,
                              lambda _, scene=scene: sweep.line_of(scene))
        for settings, line in [(sweep.settings, sweep.line_of("[set]")),
                               *((point.settings, axis.line) for axis in sweep.axes for point in axis.points)]:
            self._check_files(settings, sweep.path.parent, lambda path, line=line: sweep.line_of(path.name, line))
        for constraint in sweep.constraints:
            for name in constraint.names - set(known):
                raise sweep.error(f"unknown key `{name}` in a constraint", sweep.line_of(constraint.text))

    def _check_files(self, keys, folder, line_of):
        for key, paths in files_of(keys, folder).items():
            for path in paths:
                if not path.is_file():
                    raise self.sweep.error(f"`{key}`: there is no file {path}", line_of(path))

    def content(self):
        """What the sweep depends on besides the program: its text, its jobs, and the files that they and the axes name."""
        settings = [self.sweep.settings, *(point.settings for axis in self.sweep.axes for point in axis.points)]
        return [self.sweep.text, *([self.hash.job(keys, job.parent) for keys in [effective_job(self.program, job, {}), *settings]]
                                   for job in self.sweep.scenes.values())]

    @property
    def size(self):
        size = len(self.sweep.scenes)
        for axis in self.sweep.axes:
            size *= len(axis.points)
        return size

    def product(self):
        """Every design, without its key."""
        number = itertools.count()
        ranges = [range(len(axis.points)) for axis in self.sweep.axes]
        for scene in self.sweep.scenes:
            for positions in itertools.product(*ranges):
                yield self.design(next(number), scene, positions)

    def number(self, scene, positions):
        number = list(self.sweep.scenes).index(scene)
        for axis, position in zip(self.sweep.axes, positions):
            number = number * len(axis.points) + position
        return number

    def design(self, number, scene, positions):
        sweep = self.sweep
        points = [axis.points[position] for axis, position in zip(sweep.axes, positions)]
        settings = {**QUIET, **sweep.settings}
        for point in points:
            settings.update(point.settings)
        if sweep.measures_error:
            settings["output.ply"] = True
        cells = tuple(cell for point in points for cell in point.cells)
        return Design(number, scene, cells, sweep.scenes[scene], settings, positions=positions)

    def complete(self, design):
        """Adds key or refusal; None if a constraint excludes the design."""
        design.inputs = self.hash.inputs_of_job(design.job)
        try:
            keys = effective_job(self.program, design.job, design.settings)
        except Refused as refused:
            design.refused = str(refused)
            return design
        if not all(constraint.value(keys) for constraint in self.sweep.constraints):
            return None
        design.key = self.hash.address(self.hash.job(keys, design.job.parent), self.sweep.measures_error)
        design.inputs.update(self.hash.inputs(keys, design.job.parent))
        return design

    def task(self, design):
        return Task(design.key, run_commands(self.program, design.job, design.settings, self.sweep.measures_error), False,
                    design.inputs)

    def grid(self, jobs):
        """All designs that the constraints allow."""
        with ThreadPoolExecutor(jobs) as pool:
            designs = [design for design in pool.map(self.complete, self.product()) if design]
        self._check_grid(designs)
        return designs

    def _check_grid(self, designs):
        sweep = self.sweep
        if not designs:
            raise sweep.error("the constraints exclude every design: the product is empty", sweep.line_of("constraints"))
        for index, axis in enumerate(sweep.axes):
            for position, point in enumerate(axis.points):
                here = [design for design in designs if design.positions[index] == position]
                if here and all(design.refused for design in here):
                    words = next(iter(point.settings), axis.columns[0])
                    raise sweep.error(here[0].refused, sweep.line_of(words, axis.line))
