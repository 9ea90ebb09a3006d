"""Runs a sweep; see scripts/sweep."""
import argparse
import os
import statistics
import sys
from pathlib import Path

from engine import SHORTEST_JOB, duration, lock, run_search, run_tasks
from page import write_page
from plan import Planner
from run_job import perform
from store import Store
from sweep_file import SweepError, read_sweep
from table import make_table, measured, remarks, write_csv, write_sqlite


def options_from(arguments):
    parser = argparse.ArgumentParser(prog="scripts/sweep", description="Runs many designs and compares them.")
    parser.add_argument("file", type=Path, metavar="FILE", help="sweep file (TOML)")
    parser.add_argument("--check", action="store_true", help="check the file, count its runs, estimate their time, and exit")
    parser.add_argument("--report", action="store_true", help="write table and page of the existing results, and exit")
    parser.add_argument("--search", action="store_true", help="let Optuna choose designs instead of running all")
    parser.add_argument("--workers", type=int, default=4, help="of a search (%(default)s)")
    parser.add_argument("--storage", help="of a search: a file, or the address of a database (search.journal in the output folder)")
    parser.add_argument("--output", type=Path, help="folder of table and page (runs/sweeps/NAME)")
    parser.add_argument("--store", type=Path, default=Path("runs/sweeps/results"),
                        help="folder of the results, which sweeps share (%(default)s)")
    parser.add_argument("--jobs", type=int, help="runs at a time (all cores; with --slurm, the profile's number)")
    parser.add_argument("--slurm", action="store_true", help="run on Slurm; the folders must be visible to all nodes")
    parser.add_argument("--profile", type=Path, help="Snakemake profile instead of scripts/exploration/slurm")
    parser.add_argument("--group", type=int, help="runs in a job (50 with --slurm, else as many as take two seconds)")
    parser.add_argument("--program", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    options.output = options.output or Path("runs/sweeps") / (options.file.stem + ("_search" if options.search else ""))
    options.program = options.program.resolve()
    if options.slurm:
        options.group = options.group or 50
    else:
        options.jobs = options.jobs or os.cpu_count()
    return options


def with_new_values(designs, seen):
    """Of these designs, those with a value of an axis that neither the seen ones nor those before have."""
    values = {place for design in seen for place in enumerate(design.positions)}
    for design in designs:
        if not values.issuperset(enumerate(design.positions)):
            values.update(enumerate(design.positions))
            yield design


def probe(sweep, planner, store, designs):
    """Runs a design of each scene, unless there is a result; checks the figures' names, if need be with a run for each value
    of the axes, since a figure may belong to some designs only. Returns seconds per run by scene."""
    seconds, known, tried = {}, set(), []

    def look_at(result):
        if result["exit_code"] == 0:
            tried.append(result)
            known.update(result["figures"])
            known.update(measured(sweep, result)[0])

    runnable = [design for design in designs if design.key]
    for scene in sweep.scenes:
        here = [design for design in runnable if design.scene == scene]
        if here and not any(store.has(design.key) for design in here):
            perform(store, planner.task(here[0]), sweep.longest_run)
        results = [store.read(design.key) for design in here if store.has(design.key)][:100]
        if results:
            seconds[scene] = statistics.mean(result["seconds"] for result in results)
        for result in results:
            look_at(result)
    for design in with_new_values(runnable, [design for design in runnable if store.has(design.key)]):
        if known.issuperset(sweep.wanted):
            break
        perform(store, planner.task(design), sweep.longest_run)
        if store.has(design.key):
            look_at(store.read(design.key))
    if not tried:
        print("scripts/sweep: no design finished; the names of the figures are not checked", file=sys.stderr)
        return seconds
    for name in sweep.wanted:
        if name not in known:
            close = [each for each in sorted(known) if each.split(".")[-1] == name.split(".")[-1]]
            raise sweep.error(f"no run has the figure `{name}`" + (f"; did you mean {', '.join(close[:5])}?" if close else
                              "; statistics.csv of a run lists them"), sweep.line_of(name))
    return seconds


def announce(options, sweep, store, designs, seconds):
    missing = {design.key: design for design in designs if design.key and not store.has(design.key)}
    left = sum(seconds.get(design.scene, 0) for design in missing.values())
    refused = sum(1 for design in designs if design.refused)
    text = f"{sweep.name}: {len(designs)} designs"
    if refused:
        text += f", {refused} of them refused by the program"
    text += f"; {len(missing)} runs to do"
    if missing:
        text += f", {duration(left)} of processor time" + ("" if options.slurm else
                                                          f", about {duration(left / options.jobs)} on {options.jobs} cores")
    print(text, file=sys.stderr, flush=True)


def search(options, sweep, planner, store):
    """The designs that Optuna tried, in the order of the grid."""
    from search import designs_of, open_study, release  # Optuna takes a second to load
    if not sweep.objectives:
        raise sweep.error("a search needs `minimise` or `maximise`")
    runs = sweep.search.get("runs") or max(1, round(planner.size * sweep.search["share"]))
    print(f"{sweep.name}: {planner.size} designs, a search of {runs} with {options.workers} workers", file=sys.stderr, flush=True)
    storage = options.storage or str(options.output / "search.journal")
    scheme = "sqlite:///" if storage.startswith("sqlite:///") else ""
    if scheme or "://" not in storage:  # a file; the workers have another working directory
        storage = scheme + str(Path(storage.removeprefix(scheme)).resolve())
    study = open_study(planner, storage, 0)
    if not options.storage:  # others may share a database
        release(study)
    run_search(options, sweep, store, runs, storage)
    tried = set(designs_of(study).values())
    designs = [planner.complete(planner.design(planner.number(*place), *place)) for place in tried]
    return sorted(designs, key=lambda design: design.number)


def report(options, sweep, designs, store):
    table = make_table(sweep, options.program, designs, store)
    write_csv(table, options.output / "table.csv")
    write_sqlite(table, options.output / "table.sqlite")
    counts = {status: sum(1 for row in table.rows if row.status == status) for status in
              ("ok", "failed", "refused", "no result")}
    print(", ".join(f"{count} {status}" for status, count in counts.items() if count)
          + (f"; {sum(row.front for row in table.rows)} on the front" if sweep.objectives else ""), file=sys.stderr)
    for remark in remarks(table):
        print(remark, file=sys.stderr)
    write_page(table, options.output / "index.html")
    print(options.output / "index.html")
    if counts["failed"] and not counts["ok"]:
        print("scripts/sweep: no design finished; the first says: "
              + next(row.reason for row in table.rows if row.status == "failed"), file=sys.stderr)
        return 1
    return 1 if counts["no result"] else 0


def main():
    options = options_from(sys.argv[1:])
    try:
        sweep = read_sweep(options.file)
        planner = Planner(sweep, options.program)
        planner.check_keys()
        options.output.mkdir(parents=True, exist_ok=True)
        held = lock(options.output, "scripts/sweep")
        store = Store(options.store)
        if options.search:
            return report(options, sweep, search(options, sweep, planner, store), store)
        designs = planner.grid(os.cpu_count())
        if not options.report:
            seconds = probe(sweep, planner, store, designs)
            announce(options, sweep, store, designs, seconds)
            if options.check:
                return 0
            tasks = [(seconds.get(design.scene, SHORTEST_JOB), planner.task(design)) for design in designs if design.key]
            run_tasks(options, store, sorted(tasks, key=lambda task: -task[0]), sweep.longest_run)
        return report(options, sweep, designs, store)
    except (SweepError, OSError) as error:
        print(f"scripts/sweep: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("\nscripts/sweep: interrupted; the same command resumes here", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
