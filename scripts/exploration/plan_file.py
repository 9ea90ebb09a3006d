"""The tasks to do, in jobs of Snakemake: a file that their processes read."""
import json
import sqlite3

from program import Task


def write_plan(path, jobs):
    """jobs: a list of tasks for each job."""
    part = path.with_name(f"{path.name}.part")
    part.unlink(missing_ok=True)
    with sqlite3.connect(part) as database:
        database.execute("create table tasks (job integer, task text)")
        database.executemany("insert into tasks values (?, ?)",
                             ((number, json.dumps(task)) for number, tasks in enumerate(jobs) for task in tasks))
        database.execute("create index jobs on tasks (job)")
    database.close()
    part.replace(path)


def read_plan(path, job):
    database = sqlite3.connect(f"file:{path}?mode=ro&immutable=1", uri=True)
    tasks = [Task(*json.loads(task)) for task, in
             database.execute("select task from tasks where job = ? order by rowid", (job,))]
    database.close()
    return tasks
