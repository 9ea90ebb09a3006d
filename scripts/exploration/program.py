"""The program: effective jobs, addresses of results, and runs with what they leave."""
import hashlib
import json
import os
import re
import resource
import subprocess
from collections import namedtuple
from pathlib import Path

# Files that no figure needs. A sweep's `set` may enable them.
QUIET = {"output.picture": False, "output.ply": False, "output.obj": False}
FOLDER = "{folder}"  # in a command's arguments: the folder for its files

# The folder of `data:` paths, as in the program. Absolute, and set for all processes started from here, since these have
# other working directories.
DATA = Path(os.environ.get("TESSERA_DATA", Path(__file__).resolve().parents[2] / "../shared/data")).resolve()
os.environ["TESSERA_DATA"] = str(DATA)
# Libraries of height tests, part of the program.
HEIGHT_TESTS = [Path(name).resolve() for name in os.environ.get("TESSERA_HEIGHT_TESTS", "").split(":") if name]
os.environ["TESSERA_HEIGHT_TESTS"] = ":".join(map(str, HEIGHT_TESTS))

# Commands with one result. Each starts if the previous one ended with exit code 0. `kept`: their files stay in the store.
# `inputs`: {path: stamp} of the files they read, as they were when the key was made.
Task = namedtuple("Task", "key commands kept inputs")


class Refused(Exception):
    """The program does not accept a job; the text is the program's message."""


def toml(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml(item) for item in value) + "]"
    return str(value)


def set_options(settings):
    return [word for key, value in settings.items() for word in ("--set", f"{key}={toml(value)}")]


def run_commands(program, job, settings, measures_error):
    """A run, and its error. job: None for the default."""
    place = f"{FOLDER}/run"
    run = [str(program), "run", *([str(job)] if job else []), *set_options({**settings, "output.folder": place})]
    return [run, [str(program), "compare", place]] if measures_error else [run]


def effective_job(program, job, settings):
    """{key: value} of every key. Raises Refused."""
    import tomllib  # not needed by runs
    done = subprocess.run([program, "run", *([job] if job else []), *set_options(settings), "--dump-config"],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        words = done.stderr.strip().removeprefix("tessera: ") or f"exit code {done.returncode}"
        raise Refused(re.sub(r"^--set [^`]*: (?=`|unknown)", "", words))
    keys = {}
    for section, content in tomllib.loads(done.stdout).items():
        keys.update({f"{section}.{name}": value for name, value in content.items()} if isinstance(content, dict)
                    else {section: content})
    return keys


def file_hash(path):
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def stamp(path):
    """Changes with the file's content, in all likelihood; None if there is no such file."""
    try:
        status = os.stat(path)
    except OSError:
        return None
    return [status.st_mtime_ns, status.st_size]


def paths_of(keys):
    """{key: path} of the keys that name a file or folder."""
    return {key: keys[key] for key in ("mesh.file", "map.file") if isinstance(keys.get(key), str) and keys[key]}


def located(settings, folder):
    """The settings with paths from this folder made absolute, since runs have other working directories."""
    return {**settings, **{key: str(folder.resolve() / name) for key, name in paths_of(settings).items()
                           if not name.startswith("data:")}}


def files_of(keys, folder):
    """{key: files} that a run reads besides its job; `folder`: of the job. Of an earlier run it reads two."""
    files = {}
    for key, name in paths_of(keys).items():
        path = DATA / name.removeprefix("data:") if name.startswith("data:") else folder.resolve() / name
        files[key] = [path / "mesh.ply", path / "job.toml"] if path.is_dir() else [path]
    return files


class ContentHash:
    """Addresses of results: hashes of the program and of its commands' inputs."""

    def __init__(self, program):
        self.program = Path(program)
        self.stamps, self.files = {}, {}
        self.version = "".join(self.file(path) for path in (self.program, *HEIGHT_TESTS))

    def seen(self, path):
        """The file's stamp at its first use."""
        return self.stamps.setdefault(str(path), stamp(path))

    def file(self, path):
        self.seen(path)
        if path not in self.files:
            self.files[path] = file_hash(path) if path.is_file() else "absent"
        return self.files[path]

    def job(self, keys, folder):
        """The inputs of a run: its effective job, and the content of the files it names."""
        files = {key: [self.file(path) for path in paths] for key, paths in files_of(keys, folder).items()}
        return {**{key: value for key, value in keys.items() if key != "output.folder"}, **files}

    def inputs_of_job(self, job):
        """Stamps of the program and of a job's file, to be taken before the program reads it; job: None for the default."""
        return {str(path): self.seen(path) for path in (self.program, *HEIGHT_TESTS, job) if path}

    def inputs(self, keys, folder):
        """Stamps of the files that a job names."""
        return {str(path): self.seen(path) for paths in files_of(keys, folder).values() for path in paths}

    def address(self, *content):
        return hashlib.sha256(json.dumps([self.version, *content], sort_keys=True).encode()).hexdigest()[:32]


def figures_of(path, prefix=""):
    """{"group.name": [value, unit]} of a JSON report; empty if there is none. Numbers without a unit beside them, as in
    conformance.json, have the unit ""."""
    def figures(name, part):
        if isinstance(part, dict) and "value" in part:
            yield name, [part["value"], part["unit"]]
        elif isinstance(part, dict):
            for key, member in part.items():
                yield from figures(f"{name}.{key}", member)
        elif type(part) in (int, float):
            yield name, [part, ""]

    report = json.loads(path.read_text()) if path.is_file() else {}
    return {prefix + name: figure for group, part in report.items() if isinstance(part, dict)
            for name, figure in figures(group, part)}


def run(task, folder, longest):
    """The result of a task: exit code, reason of a failure, figures, timing table, seconds of processor time, and the
    output of a task without figures.

    Raises OSError if a command did not end by itself or a file it reads is missing or has changed,
    subprocess.TimeoutExpired.
    """
    begin = resource.getrusage(resource.RUSAGE_CHILDREN)
    for command in task.commands:
        # In its own folder: a sweep's folder may be removed while a run of a killed sweep is still active.
        done = subprocess.run([word.replace(FOLDER, str(folder)) for word in command], capture_output=True, text=True,
                              check=False, timeout=longest, cwd=folder)
        if done.returncode < 0:
            raise OSError(f"signal {-done.returncode} ended the program")
        if done.returncode > 0:
            break
    for path, before in task.inputs.items():
        if before is None:
            raise OSError(f"there is no file {path}")
        if stamp(path) != before:
            raise OSError(f"{path} was changed since this began; start it again")
    end = resource.getrusage(resource.RUSAGE_CHILDREN)
    place = Path(folder, "run")
    figures = {**figures_of(place / "statistics.json"), **figures_of(place / "conformance.json"),
               **figures_of(place / "error.json", "error.")}
    mesh, report = place / "mesh.ply", place / "report.txt"
    timing = re.search(r"^timing\n.*?(?=\n\n|\Z)", report.read_text(), re.M | re.S) if report.is_file() else None
    if mesh.is_file():
        figures["mesh.sha256"] = [file_hash(mesh), ""]
    reason = "" if done.returncode == 0 else done.stderr.replace(str(place), "RUN").strip()
    return {"exit_code": done.returncode, "reason": reason.removeprefix("tessera: "), "figures": figures,
            "timing": timing.group() if timing else "", "output": "" if figures else done.stdout,
            "seconds": round(end.ru_utime + end.ru_stime - begin.ru_utime - begin.ru_stime, 3)}
