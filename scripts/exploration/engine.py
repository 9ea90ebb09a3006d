"""Runs tasks with Snakemake, and reports progress."""
import fcntl
import json
import shlex
import shutil
import subprocess
import sys
import time
from pathlib import Path

from plan_file import write_plan

SHORTEST_JOB = 2  # seconds: shorter runs share a job, since Snakemake and Python need 0.1 s for each
# Jobs passed to Snakemake at a time: its scheduler examines every waiting one whenever one ends (README.md).
MOST_JOBS = 2000
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


def lock(folder, script):
    """Waits for another process in this folder. The lock ends with this one."""
    file = open(folder / "lock", "w", encoding="utf-8")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        print(f"{script}: waiting for another one in {folder}", file=sys.stderr)
        fcntl.flock(file, fcntl.LOCK_EX)
    return file


def call_snakemake(options, words, count, cores, report):
    """Runs Python with these arguments and a number, for each number below count. Snakemake's exit code; its output goes to
    snakemake.log."""
    # Absolute: a cluster's scheduler may start jobs in any working directory.
    folder = options.output.resolve()
    config = {"count": count, "finished": f"{folder}/finished",
              "command": shlex.join([sys.executable, "-B", *map(str, words)])}
    (folder / "engine.json").write_text(json.dumps(config), encoding="utf-8")
    shutil.rmtree(folder / "finished", ignore_errors=True)  # from an interrupted sweep
    command = [shutil.which("snakemake"), "--snakefile", HERE / "Snakefile", "--directory", folder,
               "--configfile", folder / "engine.json", "--ignore-incomplete", "--drop-metadata", "--nolock", "--keep-going",
               "--rerun-triggers", "mtime", "--scheduler", "greedy", "--quiet"]
    if options.slurm:
        command += ["--profile", options.profile or HERE / "slurm", *(["--jobs", options.jobs] if options.jobs else [])]
    else:
        command += ["--cores", cores]
    with open(folder / "snakemake.log", "a", encoding="utf-8") as log:
        # Snakemake ends with this process, even if this process is killed.
        with subprocess.Popen(["setpriv", "--pdeathsig", "TERM", *map(str, command)], stdout=log, stderr=log) as process:
            try:
                while process.poll() is None:
                    report()
                    time.sleep(0.1)
            except KeyboardInterrupt:
                process.terminate()
                raise
            return process.returncode


def in_jobs(tasks, group, cores):
    """Groups tasks, given as pairs of seconds and task: `group` tasks each, or as many as take SHORTEST_JOB."""
    room, jobs = 0, []
    # A small number of tasks is spread over the cores.
    most = group or min(SHORTEST_JOB, sum(seconds for seconds, _ in tasks) / (4 * cores))
    for seconds, task in tasks:
        if room <= 0:
            jobs.append([])
            room = most
        jobs[-1].append(task)
        room -= 1 if group else seconds
    return jobs


def run_tasks(options, store, tasks, longest=None):
    """Computes the missing results. tasks: pairs of the seconds that a task may take, and the task."""
    missing = list({task.key: (seconds, task) for seconds, task in tasks if not store.has(task.key)}.values())
    if not missing:
        return
    plan = options.output.resolve() / "plan.sqlite"
    progress = Progress(store, [task.key for _, task in missing])
    jobs = in_jobs(missing, options.group, options.jobs or 1)
    codes = []
    for begin in range(0, len(jobs), MOST_JOBS):
        portion = jobs[begin:begin + MOST_JOBS]
        write_plan(plan, portion)
        # -S: system packages are not needed, and the search for them takes time.
        words = ["-S", HERE / "run_job.py", store.folder.resolve(), plan, longest or 0]
        codes.append(call_snakemake(options, words, len(portion), options.jobs, progress.report))
    done = progress.done()
    print(f"  {done} of {progress.count} runs in {duration(time.monotonic() - progress.begin)}", file=sys.stderr)
    if any(codes):
        print(f"  {progress.count - done} runs without a result; see {options.output}/snakemake.log", file=sys.stderr)


def run_search(options, sweep, store, runs, storage):
    """Optuna's workers. `storage` is a file, or a database's address."""
    begin = time.monotonic()
    words = [HERE / "search.py", sweep.path.resolve(), options.program, store.folder.resolve(), storage, runs]
    if call_snakemake(options, words, options.workers, options.workers, lambda: None) != 0:
        print(f"  a worker ended early; see {options.output}/snakemake.log", file=sys.stderr)
    print(f"  searched for {duration(time.monotonic() - begin)}", file=sys.stderr)
