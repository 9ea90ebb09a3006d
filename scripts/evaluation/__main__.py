"""Runs the paper's evaluation; see scripts/figures."""
import argparse
import importlib
import os
import shutil
import sys
import traceback
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parent.parent / "exploration"))

from engine import SHORTEST_JOB, lock, run_tasks  # noqa: E402  (the path must be set before)
from page import write_page  # noqa: E402
from program import ContentHash, Refused  # noqa: E402
from section import FAILED, Claim, Section  # noqa: E402
from store import Store  # noqa: E402
from study import ROOT, ProgramError, Study  # noqa: E402

# In the order of the page.
NAMES = ["text_plane", "two_tests", "view_distances", "crater_lake", "rank_test", "rivals", "teapot", "tex_coord_test", "generation_limit",
         "triangulation", "tests_units", "designs", "ladder", "off_chip", "host_bandwidth", "highlight_test", "curved_surfaces",
         "displacement_scale"]


def options_from(arguments):
    parser = argparse.ArgumentParser(prog="scripts/figures", description="Runs the paper's evaluation on tessera.")
    parser.add_argument("--output", type=Path, help="output folder (runs/figures; with --only runs/figures_only, which keeps the whole page)")
    parser.add_argument("--only", action="append", choices=NAMES, metavar="NAME", help="run only this experiment; may be repeated")
    parser.add_argument("--list", action="store_true", help="list the experiments and exit")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="parallel runs (all cores)")
    parser.set_defaults(slurm=False, group=1)
    parser.add_argument("--picture-width", type=int, default=800, help="width of pictures in pixels (%(default)s)")
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/testbench/commands/tessera",
                        help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    options.output = options.output or Path("runs/figures_only" if options.only else "runs/figures")
    options.program = options.program.resolve()
    return options


def load(name):
    return importlib.import_module(f"experiments.{name}").EXPERIMENT


def steps(experiment, study):
    """measure() of the experiment, with its pictures. A failed run becomes a claim, so that the page is still written."""
    try:
        section = yield from experiment.measure(study)
        yield
        for picture in study.pictures:
            picture.finished()
    except Exception as error:  # after any error the page of the other experiments is still written
        print(f"  {experiment.name}: {FAILED}: {error}", file=sys.stderr, flush=True)
        if not isinstance(error, (ProgramError, Refused)):
            traceback.print_exc()
        section = Section(claims=[Claim(f"{experiment.figure}: {experiment.title}", experiment.figure,
                                        study.nameless(f"{type(error).__name__}: {error}"), FAILED)])
    return section


def measure_all(experiments, options, store):
    """{name: (Section, Study)}."""
    content_hash = ContentHash(options.program)
    studies = {each.name: Study(each.name, options, store, content_hash) for each in experiments}
    waiting = {each.name: steps(each, studies[each.name]) for each in experiments}
    results = {}
    while waiting:
        for name, generator in list(waiting.items()):
            try:
                next(generator)
            except StopIteration as end:
                results[name] = (end.value, studies[name])
                del waiting[name]
        run_tasks(options, store, [(SHORTEST_JOB, run.task) for name in waiting for run in studies[name].runs])
    return results


def link_runs(folder, studies):
    """The files of runs by name: FOLDER/EXPERIMENT/RUN."""
    shutil.rmtree(folder, ignore_errors=True)
    for study in studies:
        for run in study.runs:
            link = folder / Path(study.place).name / run.name
            if run.folder.is_dir():
                link.parent.mkdir(parents=True, exist_ok=True)
                link.symlink_to(os.path.relpath(run.files, link.parent))


def main():
    options = options_from(sys.argv[1:])
    if options.list:
        for name in NAMES:
            print(f"{name:20} {load(name).title} ({load(name).figure})")
        return 0
    names = [name for name in NAMES if not options.only or name in options.only]
    for taken in ("pictures", "tables", "runs"):
        if (options.output / taken).exists() and not (options.output / "index.html").is_file():
            print(f"scripts/figures: --output {options.output}: {options.output / taken} would be replaced, but is not from an "
                  "evaluation: there is no index.html beside it; choose another folder", file=sys.stderr)
            return 2
    options.output.mkdir(parents=True, exist_ok=True)
    held = lock(options.output, "scripts/figures")
    store = Store(options.output.resolve() / "results")
    results = measure_all([load(name) for name in names], options, store)
    link_runs(options.output / "runs", [study for _, study in results.values()])
    write_page(options.output, [(load(name), results[name][0], results[name][1].commands) for name in names])
    if not options.only:
        store.keep_only({run.task.key for _, study in results.values() for run in study.runs})
    print(options.output / "index.html")
    held.close()
    return 1 if FAILED in [claim.verdict for section, _ in results.values() for claim in section.claims] else 0


if __name__ == "__main__":
    sys.exit(main())
