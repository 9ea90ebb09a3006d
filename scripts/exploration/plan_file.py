"""The runs to do, for run_design.py and the Snakefile: a table of addresses, jobs and settings."""
import json
import sqlite3


def write_plan(path, designs):
    """What run_design.py needs, one row a run."""
    part = path.with_name(f"{path.name}.part")
    part.unlink(missing_ok=True)
    rows = {design.key: (design.key, str(design.job), json.dumps(design.settings)) for design in designs if design.key}
    with sqlite3.connect(part) as database:
        database.execute("create table runs (key text primary key, job text, settings text)")
        database.executemany("insert into runs values (?, ?, ?)", rows.values())
    database.close()
    part.replace(path)


def read_plan(path, key):
    """(job, settings)"""
    database = sqlite3.connect(f"file:{path}?mode=ro&immutable=1", uri=True)
    job, settings = database.execute("select job, settings from runs where key = ?", (key,)).fetchone()
    database.close()
    return job, json.loads(settings)


def planned_keys(path):
    database = sqlite3.connect(f"file:{path}?mode=ro&immutable=1", uri=True)
    keys = [key for key, in database.execute("select key from runs order by rowid")]
    database.close()
    return keys
