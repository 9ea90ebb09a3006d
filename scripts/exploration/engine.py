"""Runs a plan with Snakemake, and reports progress."""
import shutil
import subprocess
import sys
import time
from pathlib import Path

from plan_file import write_plan

# Runs that Snakemake is given at a time: its scheduler looks at every waiting run whenever one ends (README.md).
PORTION = 2000
HERE = Path(__file__).resolve().parent


class Progress:
    """Counts results as they appear. Checks cost at most a tenth of the time."""

    def __init__(self, store, keys, out=sys.stderr):
        self.store = store
        self.missing = list(keys)
        self.count = len(self.missing)
        self.begin = time.monotonic()
        self.out = out
        self.next = self.begin

    def done(self):
        self.missing = [key for key in self.missing if not self.store.has(key)]
        return self.count - len(self.missing)

    def report(self):
        begin = time.monotonic()
        if begin < self.next:
            return
        done = self.done()
        left = (begin - self.begin) * len(self.missing) / done if done else None
        print(f"  {done} of {self.count} runs" + (f", {duration(left)} left" if left is not None else ""),
              end="\r" if self.out.isatty() else "\n", file=self.out, flush=True)
        self.next = begin + max(2 if self.out.isatty() else 10, 10 * (time.monotonic() - begin))


def duration(seconds):
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def snakemake_command(options, sweep, store, target, config):
    # Absolute: jobs of a cluster run wherever the scheduler starts them.
    command = [shutil.which("snakemake"), target, "--snakefile", HERE / "Snakefile", "--directory", options.output.resolve(),
               "--config", f"store={store.folder.resolve()}", f"program={options.program.resolve()}",
               f"python={sys.executable}", *config]
    # Results appear complete or not at all, and are addressed by content: neither age nor interruption makes them stale.
    command += ["--rerun-triggers", "mtime", "--ignore-incomplete", "--nolock", "--keep-going", "--scheduler", "greedy",
                "--quiet"]
    if options.slurm:
        command += ["--profile", options.profile or HERE / "slurm"]
        command += ["--group-components", f"designs={options.group}"]
        if options.jobs:
            command += ["--jobs", options.jobs]
    else:
        command += ["--cores", options.jobs]
    return [str(word) for word in command]


def call_snakemake(options, sweep, store, target, config, report):
    """Snakemake's exit code. Its own output goes to snakemake.log in the sweep's folder."""
    command = snakemake_command(options, sweep, store, target, config)
    with open(options.output / "snakemake.log", "a", encoding="utf-8") as log:
        # Snakemake ends with this process, even if that is killed.
        with subprocess.Popen(["setpriv", "--pdeathsig", "TERM", *command], stdout=log, stderr=log) as process:
            try:
                while process.poll() is None:
                    report()
                    time.sleep(0.1)
            except KeyboardInterrupt:
                process.terminate()
                raise
            return process.returncode


def run_designs(options, sweep, store, designs):
    """Computes the results that are missing."""
    missing = list({design.key: design for design in designs if design.key and not store.has(design.key)}.values())
    if not missing:
        return
    plan = options.output.resolve() / "plan.sqlite"
    progress = Progress(store, [design.key for design in missing])
    config = [f"plan={plan}", f"measures_error={int(sweep.measures_error)}", f"longest={sweep.longest_run or 0}"]
    codes = []
    for begin in range(0, len(missing), PORTION):
        write_plan(plan, missing[begin:begin + PORTION])
        codes.append(call_snakemake(options, sweep, store, "all", config, progress.report))
    done = progress.done()
    print(f"  {done} of {progress.count} runs in {duration(time.monotonic() - progress.begin)}", file=sys.stderr)
    if any(codes):
        print(f"  {progress.count - done} runs came to no result; {options.output}/snakemake.log says why", file=sys.stderr)


def run_search(options, sweep, store, runs, storage):
    """Optuna's workers, as jobs of Snakemake. `storage` is a file, or a database's address."""
    config = [f"sweep={sweep.path.resolve()}", f"storage={storage}", f"runs={runs}", f"workers={options.workers}",
              f"finished={options.output.resolve()}"]
    for finished in options.output.glob("worker_*"):
        finished.unlink()
    begin = time.monotonic()
    if call_snakemake(options, sweep, store, "search", config, lambda: None) != 0:
        print(f"  a worker ended early; {options.output}/snakemake.log says why", file=sys.stderr)
    print(f"  searched for {duration(time.monotonic() - begin)}", file=sys.stderr)
