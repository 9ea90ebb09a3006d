"""One run of a sweep: run_design.py PROGRAM STORE PLAN KEY MEASURES_ERROR LONGEST. Started by the Snakefile."""
import subprocess
import sys

from plan_file import read_plan
from program import run
from store import Store


def perform(store, key, program, job, settings, measures_error, longest):
    """Whether a result is stored; a run that the program itself ended is one, whatever its exit code."""
    try:
        store.write(key, run(program, job, settings, measures_error, longest))
    except subprocess.TimeoutExpired:
        store.write_failure(key, f"took longer than {longest:g} s")
    except OSError as error:
        store.write_failure(key, str(error))
    return store.has(key)


def main():
    program, folder, plan, key, measures_error, longest = sys.argv[1:]
    store = Store(folder)
    if store.has(key):  # another sweep left it meanwhile
        return 0
    job, settings = read_plan(plan, key)
    return 0 if perform(store, key, program, job, settings, measures_error == "1", float(longest) or None) else 1


if __name__ == "__main__":
    sys.exit(main())
