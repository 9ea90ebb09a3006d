"""Reads a sweep file. README.md describes its keys."""
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from expression import Expression
from program import located

JOBS = Path(__file__).resolve().parent.parent.parent / "testbench/examples/jobs"
TOP_KEYS = {"job", "scenes", "set", "axis", "constraints", "figures", "derived", "minimise", "maximise", "search",
            "longest_run"}
LONGEST_AXIS = 100_000  # points; a step near zero would exhaust the memory


class SweepError(Exception):
    """A sweep file that cannot be run; the text begins with file and line."""


@dataclass
class Point:
    """A position on an axis. `cells` are its entries in the table, one per column of the axis."""

    cells: tuple
    settings: dict


@dataclass
class Axis:
    columns: tuple
    points: list
    line: int


@dataclass
class Derived:
    expression: Expression
    unit: str


@dataclass
class Sweep:
    path: Path
    text: str
    scenes: dict  # name in the table: path of the job file
    settings: dict
    axes: list
    constraints: list
    figures: list
    derived: dict
    objectives: dict  # figure: 1 to minimise, -1 to maximise
    search: dict = field(default_factory=dict)
    longest_run: float = None

    @property
    def name(self):
        return self.path.stem

    @property
    def wanted(self):
        """Figures of the table: requested ones, derived ones, objectives."""
        return list(dict.fromkeys([*self.figures, *self.derived, *self.objectives]))

    @property
    def read(self):
        """Figures that the table has or calculates from."""
        return {*self.wanted, *(name for each in self.derived.values() for name in each.expression.names)}

    @property
    def measures_error(self):
        return any(name.startswith("error.") for name in self.read)

    def line_of(self, words, first=1):
        """The first line from `first` that contains the words; `first` if none does."""
        for number, line in enumerate(self.text.splitlines(), 1):
            if number >= first and words in line.split("#")[0]:
                return number
        return first

    def error(self, what, line=1):
        return SweepError(f"{self.path}:{line}: {what}")


def axis_lines(text):
    return [number for number, line in enumerate(text.splitlines(), 1) if line.strip().startswith("[[axis]]")]


def values_of(table):
    """The values of an axis of one key: a list, or a range with a step or a factor."""
    if "values" in table:
        if not isinstance(table["values"], list):
            raise ValueError("`values` must be a list")
        return table["values"]
    low, high = table["from"], table["to"]
    if any(isinstance(each, bool) or not isinstance(each, (int, float)) for each in (low, high)):
        raise ValueError("`from` and `to` must be numbers")
    step, factor = table.get("step", 0 if "factor" in table else 1), table.get("factor", 1)
    if not (step > 0 or (factor > 1 and low > 0)):
        raise ValueError("`step` must be above 0, or `factor` above 1 and `from` above 0")
    values = []
    while True:
        # Multiples of the step, since its sums would miss `to` by rounding.
        value = low + len(values) * step if step else low * factor ** len(values)
        if value > high * (1 + 1e-12) or len(values) > LONGEST_AXIS:
            break
        values.append(round(value, 12) if isinstance(value, float) else value)
    return values


KINDS = ({"key", "values"}, {"key", "from", "to"}, {"keys", "values"}, {"name", "points"})


def axis_of(table, line):
    """Raises ValueError."""
    if set(table) - {"step", "factor"} not in KINDS:
        raise ValueError("an axis needs `key` and `values`, or `key`, `from`, `to` and `step` or `factor`, or `keys` and "
                         f"`values`, or `name` and `points`; not {', '.join(f'`{key}`' for key in table)}")
    if "points" in table:
        if not all(isinstance(settings, dict) for settings in table["points"].values()):
            raise ValueError("each of `points` must be a table of keys and values")
        return Axis((table["name"],), [Point((label,), settings) for label, settings in table["points"].items()], line)
    if "keys" in table:
        keys = tuple(table["keys"])
        for row in table["values"]:
            if not isinstance(row, list) or len(row) != len(keys):
                raise ValueError(f"each of `values` must be a list of {len(keys)}, as `keys` is; not {row}")
        return Axis(keys, [Point(tuple(row), dict(zip(keys, row))) for row in table["values"]], line)
    return Axis((table["key"],), [Point((value,), {table["key"]: value}) for value in values_of(table)], line)


def scene_path(name, folder):
    """A name in testbench/examples/jobs, or a path from the sweep file's folder."""
    example = JOBS / f"{name}.toml"
    path = example if example.is_file() else folder / name
    return path.resolve() if path.is_file() else None


def read_sweep(path):
    text = path.read_text(encoding="utf-8")
    sweep = Sweep(path, text, {}, {}, [], [], [], {}, {})
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise SweepError(f"{path}: {error}") from None
    for key in content:
        if key not in TOP_KEYS:
            raise sweep.error(f"unknown entry `{key}`; the entries are {', '.join(sorted(TOP_KEYS))}", sweep.line_of(key))
    for key, kind in (("scenes", list), ("set", dict), ("axis", list), ("constraints", list), ("figures", list),
                      ("derived", dict), ("minimise", list), ("maximise", list), ("search", dict),
                      ("longest_run", (int, float)), ("job", str)):
        if key in content and not isinstance(content[key], kind):
            raise sweep.error(f"`{key}` has the wrong type", sweep.line_of(key))
    if ("job" in content) == ("scenes" in content):
        raise sweep.error("name a `job`, or several in `scenes`")
    for name in content.get("scenes", [content.get("job")]):
        sweep.scenes[Path(name).stem] = scene_path(name, path.parent)
        if sweep.scenes[Path(name).stem] is None:
            raise sweep.error(f"there is no job `{name}`", sweep.line_of(name))
    sweep.settings = located(content.get("set", {}), path.parent)
    for table, line in zip(content.get("axis", []), axis_lines(text)):
        try:
            axis = axis_of(table, line)
        except (ValueError, TypeError) as error:
            raise sweep.error(error, line) from None
        if not axis.points:
            raise sweep.error("this axis has no values: the product is empty", line)
        if len(axis.points) > LONGEST_AXIS:
            raise sweep.error(f"this axis has more than {LONGEST_AXIS} values", line)
        for point in axis.points:
            point.settings = located(point.settings, path.parent)
        sweep.axes.append(axis)
    if not sweep.axes:
        raise sweep.error("there is no [[axis]]")
    read_results(sweep, content)
    return sweep


def read_results(sweep, content):
    """Constraints, figures, objectives, search."""
    def expression(text):
        try:
            return Expression(text)
        except ValueError as error:
            raise sweep.error(error, sweep.line_of(text)) from None

    sweep.constraints = [expression(text) for text in content.get("constraints", [])]
    sweep.figures = content.get("figures", [])
    for name, entry in content.get("derived", {}).items():
        if not isinstance(entry, dict) or set(entry) - {"unit"} != {"is"}:
            raise sweep.error(f"`{name}` must be {{ is = \"expression\", unit = \"bit\" }}", sweep.line_of(name))
        sweep.derived[name] = Derived(expression(entry["is"]), entry.get("unit", ""))
    sweep.objectives = {name: sign for key, sign in (("minimise", 1), ("maximise", -1)) for name in content.get(key, [])}
    sweep.longest_run = content.get("longest_run")
    sweep.search = {"share": 0.2, "seed": 1, **content.get("search", {})}
    for key in sweep.search:
        if key not in ("share", "seed", "runs"):
            raise sweep.error(f"unknown entry `{key}` in [search]; the entries are runs, share, seed", sweep.line_of(key))
