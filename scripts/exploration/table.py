"""The table of a sweep: one row a run, as CSV and SQLite."""
import csv
import re
import sqlite3
import subprocess
from dataclasses import dataclass, field


@dataclass
class Row:
    design: object
    status: str  # ok, failed, refused, no result
    reason: str
    figures: dict  # of Sweep.wanted; a figure missing from the run is absent
    front: bool = False
    timing: str = ""
    bottleneck: str = ""


@dataclass
class Table:
    sweep: object
    units: dict
    rows: list = field(default_factory=list)
    queues: set = field(default_factory=set)  # whether there are designs whose queue's memory is counted, and others

    @property
    def axes(self):
        return [column for axis in self.sweep.axes for column in axis.columns]

    @property
    def columns(self):
        """(name, unit)"""
        return [("run", ""), ("scene", ""), *((name, self.units.get(name, "")) for name in (*self.axes, *self.sweep.wanted)),
                ("front", ""), ("status", ""), ("reason", ""), ("result", "")]

    def cells(self, row):
        figures = [row.figures.get(name) for name in self.sweep.wanted]
        return [row.design.number, row.design.scene, *row.design.cells, *figures, int(row.front), row.status,
                row.reason.split("\n")[0], row.design.key]


def key_units(program):
    """{key: unit} from `tessera keys`."""
    text = subprocess.run([program, "keys"], capture_output=True, text=True, check=True).stdout
    rows = re.findall(r"^\| `([\w.]+)` \| (?:[^|]*\|){2} ([^|]*) \|", text, re.MULTILINE)
    return {key: "" if unit == "-" else unit for key, unit in rows}


def measured(sweep, result):
    """({figure: value}, {figure: unit}) that the sweep requests of a result."""
    values = {name: value for name, (value, _) in result["figures"].items()}
    units = {name: unit for name, (_, unit) in result["figures"].items()}
    for name, derived in sweep.derived.items():
        value = derived.expression.value(values)
        if value is not None:
            values[name] = value
        units[name] = derived.unit
    return ({name: values[name] for name in sweep.wanted if name in values},
            {name: units[name] for name in sweep.wanted if name in units})


def costs(sweep, figures):
    """The objectives, each to be minimised; None unless all are numbers."""
    values = [figures.get(name) for name in sweep.objectives]
    if any(isinstance(value, (str, type(None))) for value in values):
        return None
    return tuple(sign * value for sign, value in zip(sweep.objectives.values(), values))


def front_of(costs_of):
    """Indices of the non-dominated costs: no other is as good in all objectives and better in one."""
    front = []
    for index in sorted(range(len(costs_of)), key=lambda k: costs_of[k]):
        own = costs_of[index]
        if not any(costs_of[other] != own and all(a <= b for a, b in zip(costs_of[other], own)) for other in front):
            front.append(index)
    return front


def mark_fronts(sweep, rows):
    """A front for each scene: figures of different scenes are not compared."""
    for scene in sweep.scenes:
        judged = [row for row in rows if row.design.scene == scene and row.status == "ok"
                  and costs(sweep, row.figures) is not None]
        for index in front_of([costs(sweep, row.figures) for row in judged]) if sweep.objectives else ():
            judged[index].front = True


def idle_axes(table):
    """The axes, as text, along which no figure changes, nor whether a run finishes: in no two runs that differ in that axis
    alone, one of them finished."""
    idle, first = [], 0
    for axis in table.sweep.axes:
        after = first + len(axis.columns)
        groups = {}
        for row in table.rows:
            if row.status in ("ok", "failed"):
                cells = row.design.cells
                others = repr((row.design.scene, cells[:first], cells[after:]))
                groups.setdefault(others, []).append((cells[first:after], (row.status, row.figures)))
        compared = [group for group in groups.values() if any(cells != group[0][0] for cells, _ in group)
                    and any(status == "ok" for _, (status, _) in group)]
        if compared and all(result == group[0][1] for group in compared for _, result in group):
            idle.append(", ".join(axis.columns))
        first = after
    return idle


def remarks(table):
    """What a reader of the table may miss."""
    found = [f"axis {axis} changed no figure" for axis in idle_axes(table)]
    if len(table.queues) > 1 and table.sweep.read & {"area.total_memory_bits", "area.triangle_queue_memory_bits"}:
        found.append("the area does not count unbounded queues: compare it among designs with bounded ones only")
    return found


def make_table(sweep, program, designs, store):
    table = Table(sweep, key_units(program))
    for design in designs:
        if design.refused:
            table.rows.append(Row(design, "refused", design.refused, {}))
        elif not store.has(design.key):
            table.rows.append(Row(design, "no result", store.failure(design.key), {}))
        else:
            result = store.read(design.key)
            figures, units = measured(sweep, result)
            table.units.update(units)
            failed = result["exit_code"] != 0
            if not failed and "area.triangle_queue_memory_bits" in result["figures"]:
                table.queues.add(result["figures"]["area.triangle_queue_memory_bits"][0] > 0)
            table.rows.append(Row(
                design, "failed" if failed else "ok", f"exit code {result['exit_code']}: {result['reason']}" if failed else "",
                figures, timing=result["timing"],
                bottleneck=result["figures"].get("timing.bottleneck_in_words", [""])[0]))
    mark_fronts(sweep, table.rows)
    return table


def heading(column):
    name, unit = column
    return f"{name} [{unit}]" if unit else name


def write_csv(table, path):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([heading(column) for column in table.columns])
        writer.writerows(table.cells(row) for row in table.rows)


def write_sqlite(table, path):
    """Tables: runs, and columns with their units."""
    path.unlink(missing_ok=True)
    names = [name for name, _ in table.columns]
    quoted = ", ".join(f'"{name}"' for name in names)
    with sqlite3.connect(path) as database:
        database.execute("create table columns (name text primary key, unit text)")
        database.executemany("insert into columns values (?, ?)", table.columns)
        database.execute(f"create table runs ({quoted})")
        database.executemany(f"insert into runs values ({', '.join('?' * len(names))})",
                             ([str(cell) if isinstance(cell, (list, tuple)) else cell for cell in table.cells(row)]
                              for row in table.rows))
    database.close()
