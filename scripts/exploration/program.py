"""The program: effective jobs, and runs of it with what they leave."""
import hashlib
import json
import re
import resource
import subprocess
import tempfile
from pathlib import Path

# Files that no figure needs. A sweep's `set` may ask for them.
QUIET = {"output.picture": False, "output.ply": False, "output.obj": False}


class Refused(Exception):
    """The program does not accept a job; the text is its own."""


def toml(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml(item) for item in value) + "]"
    return str(value)


def set_options(settings):
    return [word for key, value in settings.items() for word in ("--set", f"{key}={toml(value)}")]


def effective_job(program, job, settings):
    """{key: value} of every key. Raises Refused."""
    import tomllib  # a run does not need it
    done = subprocess.run([program, "run", job, *set_options(settings), "--dump-config"], capture_output=True,
                          text=True, check=False)
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


class ContentHash:
    """Addresses a result: a hash of the effective job, of the files it names, and of the program."""

    def __init__(self, program, data=None):
        self.version = file_hash(program)
        self.data = data
        self.files = {}

    def _file(self, name, folder):
        path = Path(self.data or ".") / name.removeprefix("data:") if name.startswith("data:") else folder / name
        if path.is_dir():
            path = path / "mesh.ply"
        if path not in self.files:
            self.files[path] = file_hash(path) if path.is_file() else "absent"
        return self.files[path]

    def of(self, keys, folder, measures_error):
        content = {key: value for key, value in keys.items() if key != "output.folder"}
        for key in ("mesh.file", "map.file"):
            if content.get(key):
                content[key] = self._file(content[key], folder)
        text = json.dumps([self.version, measures_error, content], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:32]


def figures_of(path, prefix=""):
    """{"group.name": [value, unit]} of a JSON report; empty if there is none."""
    if not path.is_file():
        return {}
    groups = {name: group for name, group in json.loads(path.read_text()).items() if isinstance(group, dict)}
    return {f"{prefix}{group}.{name}": [figure["value"], figure["unit"]] for group, figures in groups.items()
            for name, figure in figures.items() if isinstance(figure, dict) and "value" in figure}


def run(program, job, settings, measures_error, longest):
    """The result of a run: exit code, reason of a failure, figures, timing table, seconds of processor time.

    Raises OSError or subprocess.TimeoutExpired if the program came to no end of its own.
    """
    with tempfile.TemporaryDirectory(prefix="tessera_run_") as name:
        folder = Path(name, "run")
        begin = resource.getrusage(resource.RUSAGE_CHILDREN)

        def call(*arguments):
            done = subprocess.run([program, *arguments], capture_output=True, text=True, check=False, timeout=longest)
            if done.returncode < 0:
                raise OSError(f"signal {-done.returncode} ended the program")
            return done

        done = call("run", job, *set_options({**settings, "output.folder": folder}))
        if done.returncode == 0 and measures_error:
            done = call("compare", folder)
        end = resource.getrusage(resource.RUSAGE_CHILDREN)
        figures = {**figures_of(folder / "statistics.json"), **figures_of(folder / "conformance.json"),
                   **figures_of(folder / "error.json", "error.")}
        mesh, timing = folder / "mesh.ply", folder / "timing.txt"
        if mesh.is_file():
            figures["mesh.sha256"] = [file_hash(mesh), ""]
        reason = "" if done.returncode == 0 else done.stderr.replace(str(folder), "RUN").strip()
        return {"exit_code": done.returncode, "reason": reason.removeprefix("tessera: "), "figures": figures,
                "timing": timing.read_text() if timing.is_file() else "",
                "seconds": round(end.ru_utime + end.ru_stime - begin.ru_utime - begin.ru_stime, 3)}
