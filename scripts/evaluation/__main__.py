"""Runs the paper's evaluation; see scripts/figures."""
import argparse
import importlib
import sys
import traceback
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from page import write_page
from section import FAILED, Claim, Section
from study import ROOT, ProgramError, Study

# In the order of the page.
NAMES = ["text_plane", "two_tests", "view_distances", "crater_lake", "teapot", "tex_coord_test", "generation_limit",
         "triangulation", "tests_units", "designs", "ladder", "off_chip", "host_bandwidth", "highlight_test", "curved_surfaces",
         "displacement_scale"]
LONGEST_FIRST = ["crater_lake", "off_chip", "ladder", "view_distances", "tests_units", "designs", "two_tests", "teapot",
                 "tex_coord_test"]


def options_from(arguments):
    parser = argparse.ArgumentParser(prog="scripts/figures", description="Runs the paper's evaluation on tessera.")
    parser.add_argument("--output", type=Path, help="folder to leave (runs/figures; with --only runs/figures_only, so that the whole page stays)")
    parser.add_argument("--only", action="append", choices=NAMES, metavar="NAME", help="this experiment; may be repeated")
    parser.add_argument("--list", action="store_true", help="name the experiments and stop")
    parser.add_argument("--jobs", type=int, default=2, help="experiments at a time (%(default)s)")
    parser.add_argument("--picture-width", type=int, default=800, help="pixels (%(default)s)")
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/testbench/commands/tessera",
                        help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    options.output = options.output or Path("runs/figures_only" if options.only else "runs/figures")
    return options


def load(name):
    return importlib.import_module(f"experiments.{name}").EXPERIMENT


def perform(experiment, options):
    """(Section, commands). A failed command becomes a claim, so that the page is still written."""
    folder = (options.output / "runs" / experiment.name).resolve()
    study = Study(options.program, folder, options.picture_width)

    def nameless(text):
        """Removes this machine's paths from the page."""
        for place, name in ((f"{folder}/", f"runs/figures/runs/{experiment.name}/"), (f"{ROOT}/", ""),
                            (str(options.program), "tessera")):
            text = text.replace(place, name)
        return text

    print(f"  {experiment.name}: begun", file=sys.stderr, flush=True)
    try:
        section = experiment.measure(study)
    except Exception as error:  # after any error the page of the other experiments is still written
        print(f"  {experiment.name}: {FAILED}: {error}", file=sys.stderr, flush=True)
        if not isinstance(error, ProgramError):
            traceback.print_exc()
        section = Section(claims=[Claim(f"{experiment.figure}: {experiment.title}", experiment.figure,
                                        nameless(f"{type(error).__name__}: {error}"), FAILED)])
    else:
        print(f"  {experiment.name}: done", file=sys.stderr, flush=True)
    return section, [nameless(command) for command in study.commands]


def main():
    options = options_from(sys.argv[1:])
    if options.list:
        for name in NAMES:
            print(f"{name:20} {load(name).title} ({load(name).figure})")
        return 0
    names = [name for name in NAMES if not options.only or name in options.only]
    order = sorted(names, key=lambda name: LONGEST_FIRST.index(name) if name in LONGEST_FIRST else len(LONGEST_FIRST))
    for taken in ("pictures", "tables"):
        if (options.output / taken).exists() and not (options.output / "index.html").is_file():
            print(f"scripts/figures: --output {options.output}: {options.output / taken} would be replaced, and no evaluation left "
                  "it: there is no index.html beside it; choose another folder", file=sys.stderr)
            return 2
    options.output.mkdir(parents=True, exist_ok=True)
    print(f"{len(names)} experiments, {options.jobs} at a time", file=sys.stderr)
    with ThreadPoolExecutor(options.jobs) as pool:
        pending = {name: pool.submit(perform, load(name), options) for name in order}
        results = {name: pending[name].result() for name in names}
    write_page(options.output, [(load(name), *results[name]) for name in names])
    print(options.output / "index.html")
    verdicts = [claim.verdict for section, _ in results.values() for claim in section.claims]
    return 1 if FAILED in verdicts else 0


if __name__ == "__main__":
    sys.exit(main())
