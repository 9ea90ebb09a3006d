"""Lines and branches of modules/ and golden/ that the tests executed; see scripts/checks/coverage."""
import json
import os
import re
import subprocess
import sys
import tomllib
from collections import defaultdict
from pathlib import Path

ROOMS = ("modules/", "golden/")
WANTED = 99.4  # percent, of lines and of branches


class File:
    """The counts of one source file: lines by number; branches by line, by the condition's position in the line and by
    direction, with the largest count of all copies. Without what the compiler decides: `if constexpr`, and the branch
    past all cases of a switch, since -Wswitch requires a case for every value."""

    def __init__(self, text):
        self.text = text
        self.lines = {}
        self.branches = defaultdict(dict)

    def add_line(self, line, times):
        self.lines[line] = max(self.lines.get(line, 0), times)

    def add_branch(self, line, branch, times):
        if re.match(r"\s*(?:\} else |else )?(?:if constexpr|switch) \(", self.text[line - 1]):
            return
        self.branches[line][branch] = max(self.branches[line].get(branch, 0), times)

    def leave_out_function(self, head):
        """Removes the counts of the function that begins with this line; returns whether there is one."""
        begin = next((k for k, text in enumerate(self.text, 1) if text.strip() == head), None)
        if begin is None:
            return False
        end = self.text.index("}", begin) + 1
        for line in range(begin, end + 1):
            self.lines.pop(line, None)
            self.branches.pop(line, None)
        return True

    def unreached_lines(self):
        return sorted(line for line, count in self.lines.items() if count == 0)

    def unreached_branches(self):
        """Line and (column, end line, end column, direction) of each."""
        return sorted((line, branch) for line, branches in self.branches.items()
                      for branch, count in branches.items() if count == 0)

    def unreached(self):
        """{line: its unreached parts}"""
        faults = defaultdict(list)
        for line in self.unreached_lines():
            faults[line].append("never executed")
        for line, (column, end_line, end_column, way) in self.unreached_branches():
            condition = self.text[line - 1][column - 1:end_column - 1 if end_line == line else None]
            faults[line].append(f"`{condition}` never {'true' if way else 'false'}")
        return faults

    def branch_count(self):
        return sum(len(branches) for branches in self.branches.values())


def count(root, folder):
    """{path from the root: File}. A branch of a template or header is reached if any of its copies is."""
    merged = folder / "counts.profdata"
    counts = sorted(str(path) for path in (folder / "counts").glob("*.profraw"))
    if not counts:
        sys.exit(f"scripts/check coverage: no counts in {folder}/counts; run scripts/check coverage without --report-only")
    subprocess.run(["llvm-profdata", "merge", "--sparse", "-o", merged, *counts], check=True)
    programs = sorted(path for path in (folder / "testbench").rglob("*")
                      if path.is_file() and path.parent.name in ("tests", "commands")
                      and path.stat().st_mode & 0o111 and path.suffix == "")
    objects = [str(programs[0])] + [f"--object={path}" for path in programs[1:]]
    files = {}

    def file_of(path):
        path = Path(os.path.normpath(folder / path))  # a compiler cache may have made it relative to the build
        name = str(path.relative_to(root)) if path.is_relative_to(root) else ""
        if not name.startswith(ROOMS):
            return None
        if name not in files:
            files[name] = File(path.read_text().splitlines())
        return files[name]

    def exported(form):
        return subprocess.run(["llvm-cov", "export", f"--format={form}", "--skip-functions",
                               f"--instr-profile={merged}", *objects], check=True, capture_output=True, text=True).stdout

    # In the lcov format each copy of a template has separate branches; only the JSON format identifies them.
    for record in exported("lcov").splitlines():
        kind, _, rest = record.partition(":")
        if kind == "SF":
            file = file_of(rest)
        elif file is not None and kind == "DA":
            line, times = rest.split(",")[:2]
            file.add_line(int(line), int(times))
    for counted in json.loads(exported("text"))["data"][0]["files"]:
        file = file_of(counted["filename"])
        for line, column, end_line, end_column, taken, passed_by, *_ in counted["branches"] if file is not None else ():
            place = (column, end_line, end_column)
            file.add_branch(line, (*place, True), taken)
            file.add_branch(line, (*place, False), passed_by)
    return files


class Reasons:
    """The reasons for unreached lines, by file and by the line's text."""

    def __init__(self, path):
        entries = tomllib.loads(path.read_text())
        self.reasons = {(entry["file"], line): entry["reason"]
                        for entry in entries.get("unreached", []) for line in entry["lines"]}
        self.compiled = [(entry["file"], entry["function"]) for entry in entries["compiled"]]
        self.used = set()

    def leave_out_compiled(self, files):
        """Removes the counts of functions that the compiler alone executes; returns those that are absent."""
        return [f"{name}: {function}" for name, function in self.compiled
                if name not in files or not files[name].leave_out_function(function)]

    def of(self, name, text):
        key = (name, text.strip())
        if key in self.reasons:
            self.used.add(key)
        return self.reasons.get(key)

    def unused(self):
        return [f"{name}: {line}" for name, line in self.reasons if (name, line) not in self.used]


def percent(reached, of):
    return 100.0 * reached / of if of else 100.0


def row(name, lines, missed_lines, branches, missed_branches):
    return (f"{name:58} {lines:6} {missed_lines:6} {percent(lines - missed_lines, lines):7.2f}"
            f" {branches:9} {missed_branches:6} {percent(branches - missed_branches, branches):7.2f}")


def report(files, reasons):
    """(text, unexplained, percent of lines, percent of branches)"""
    text = [f"{'file':58} {'lines':>6} {'missed':>6} {'%':>7} {'branches':>9} {'missed':>6} {'%':>7}"]
    totals = defaultdict(lambda: [0, 0, 0, 0])
    explained, unexplained = [], []
    for name, file in sorted(files.items()):
        lines, branches = file.unreached_lines(), file.unreached_branches()
        figures = [len(file.lines), len(lines), file.branch_count(), len(branches)]
        text.append(row(name, *figures))
        for room in (name.split("/")[0] + "/", "all"):
            totals[room] = [a + b for a, b in zip(totals[room], figures)]
        for line, faults in sorted(file.unreached().items()):
            code = file.text[line - 1]
            reason = reasons.of(name, code)
            entry = f"{name}:{line}: {', '.join(faults)}: {code.strip()}"
            (explained if reason else unexplained).append(entry + (f"\n    {reason}" if reason else ""))
    text += [""] + [row(room, *figures) for room, figures in sorted(totals.items(), reverse=True)]
    for heading, entries in (("Not reached, with a reason", explained), ("Not reached, without a reason", unexplained)):
        if entries:
            text += ["", f"{heading} ({len(entries)}):", *entries]
    figures = totals["all"]
    return ("\n".join(text) + "\n", unexplained, percent(figures[0] - figures[1], figures[0]),
            percent(figures[2] - figures[3], figures[2]))


def main():
    root, folder = Path(sys.argv[1]), Path(sys.argv[2])
    reasons = Reasons(Path(__file__).with_name("unreached.toml"))
    files = count(root, folder)
    absent = reasons.leave_out_compiled(files)
    text, unexplained, lines, branches = report(files, reasons)
    (folder / "coverage.txt").write_text(text)
    print(text, end="")
    faults = [f"{what}: {value:.2f} %, expected {WANTED} %" for what, value in (("lines", lines), ("branches", branches))
              if value < WANTED]
    if unexplained:
        faults.append(f"{len(unexplained)} lines are not fully reached, and scripts/checks/coverage_report/unreached.toml gives "
                      "no reason")
    faults += [f"scripts/checks/coverage_report/unreached.toml: reached or no longer present: {entry}"
               for entry in absent + reasons.unused()]
    for fault in faults:
        print(f"scripts/check coverage: {fault}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
