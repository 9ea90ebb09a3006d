"""The page of a sweep: one HTML file with its data and plotly, without any other file."""
import html
import json
import re
import shlex
from pathlib import Path

import plotly.offline

from program import QUIET, set_options
from sweep_file import JOBS
from table import remarks

HERE = Path(__file__).resolve().parent
MOST_TIMING_TABLES = 2000  # 4 kB each; with more runs only designs on a front have one


def command(design, measures_error):
    """The command that repeats the run, from the project's folder."""
    job = design.job.stem if design.job.parent == JOBS else design.job.name
    settings = {key: value for key, value in design.settings.items() if QUIET.get(key) != value}
    if not measures_error:
        return shlex.join(["scripts/run", job, *set_options(settings)])
    folder = f"runs/run_{design.number}"
    return (shlex.join(["scripts/run", job, *set_options({**settings, "output.folder": folder})])
            + f" && build/release/testbench/commands/tessera compare {folder}")


def json_text(content):
    return json.dumps(content, separators=(",", ":")).replace("</", "<\\/")


def write_page(table, path):
    sweep = table.sweep
    axes, figures = set(table.axes), set(sweep.wanted)
    columns = [{"name": name, "unit": unit, "kind": "axis" if name in axes else "figure" if name in figures else "note"}
               for name, unit in table.columns]
    all_tables = len(table.rows) <= MOST_TIMING_TABLES
    rows = [{"run": row.design.number, "cells": table.cells(row), "command": command(row.design, sweep.measures_error), "reason": row.reason,
             "bottleneck": row.bottleneck,
             "settings": {key: value for key, value in row.design.settings.items() if QUIET.get(key) != value},
             "timing": row.timing if all_tables or row.front else
             f"Tables of more than {MOST_TIMING_TABLES} designs are omitted from the page: run the command."}
            for row in table.rows]
    ok = sum(row.status == "ok" for row in table.rows)
    summary = f"{len(rows)} runs, {len(rows) - ok} of them without figures; {sum(row.front for row in table.rows)} on the front of " \
              + (", ".join(f"least {name}" if sign > 0 else f"most {name}" for name, sign in sweep.objectives.items()) or "nothing")
    summary += "".join(f"; {remark}" for remark in remarks(table))
    content = {"columns": columns, "rows": rows, "scenes": list(sweep.scenes), "objectives": sweep.objectives, "summary": summary}
    parts = {"title": html.escape(sweep.name), "style": (HERE / "page.css").read_text(encoding="utf-8"),
             "data": json_text(content), "plotly": plotly.offline.get_plotlyjs().replace("</script", "<\\/script"),
             "script": (HERE / "page.js").read_text(encoding="utf-8")}
    text = (HERE / "page.html").read_text(encoding="utf-8")
    part = path.with_name(f"{path.name}.part")
    part.write_text(re.sub(r"%(\w+)%", lambda match: parts[match[1]], text), encoding="utf-8")
    part.replace(path)
