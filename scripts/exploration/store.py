"""Results, one compressed file each, addressed by content. A file appears when it is complete."""
import fcntl
import gzip
import json
import os
import shutil
import tempfile
from contextlib import contextmanager
from pathlib import Path


class Store:
    def __init__(self, folder):
        self.folder = Path(folder)

    def path(self, key):
        return self.folder / key[:2] / f"{key}.json.gz"

    def has(self, key):
        return self.path(key).is_file()

    def files(self, key):
        """The folder of a result whose files are kept."""
        return self.folder / key[:2] / key

    @contextmanager
    def folder_for(self, task):
        """An empty folder. Kept files are written in their final place, since they refer to one another."""
        if task.kept:
            folder = self.files(task.key)
            folder.parent.mkdir(parents=True, exist_ok=True)
            with open(f"{folder}.lock", "w", encoding="utf-8") as lock:
                # The process of a killed evaluation may still be writing.
                fcntl.flock(lock, fcntl.LOCK_EX)
                shutil.rmtree(folder, ignore_errors=True)
                folder.mkdir()
                yield folder
        else:
            with tempfile.TemporaryDirectory(prefix="tessera_run_") as folder:
                yield Path(folder)

    def read(self, key):
        return json.loads(gzip.decompress(self.path(key).read_bytes()))

    def write(self, key, result):
        self._replace(self.path(key), gzip.compress(json.dumps(result).encode(), mtime=0))
        self._failure(key).unlink(missing_ok=True)

    def _failure(self, key):
        return self.path(key).with_name(f"{key}.failure")

    def write_failure(self, key, reason):
        """Why a run gave no result. The next sweep repeats it."""
        self._replace(self._failure(key), reason.encode())

    def failure(self, key):
        path = self._failure(key)
        return path.read_text(encoding="utf-8") if path.is_file() else "not run"

    def keep_only(self, keys):
        """Removes all other results."""
        for path in self.folder.glob("*/*"):
            if path.name.split(".")[0] not in keys:
                shutil.rmtree(path) if path.is_dir() else path.unlink()

    @staticmethod
    def _replace(path, content):
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_name(f"{path.name}.{os.uname().nodename}.{os.getpid()}.part")
        part.write_bytes(content)
        part.replace(path)
