"""The tasks of one job: run_job.py STORE PLAN LONGEST JOB. Started by the Snakefile."""
import subprocess
import sys

from plan_file import read_plan
from program import run
from store import Store


def perform(store, task, longest):
    """Whether a result is stored; a run that the program itself ended is a result, with any exit code."""
    try:
        with store.folder_for(task) as folder:
            store.write(task.key, run(task, folder, longest))
    except subprocess.TimeoutExpired:
        store.write_failure(task.key, f"took longer than {longest:g} s")
    except OSError as error:
        store.write_failure(task.key, str(error))
    return store.has(task.key)


def main():
    folder, plan, longest, job = sys.argv[1:]
    store = Store(folder)
    # Another sweep, or this job before its node failed, may have stored some.
    missing = [task for task in read_plan(plan, int(job)) if not store.has(task.key)]
    return 0 if all([perform(store, task, float(longest) or None) for task in missing]) else 1


if __name__ == "__main__":
    sys.exit(main())
