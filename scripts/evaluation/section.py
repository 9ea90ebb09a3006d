"""What an experiment leaves for the page: claims with verdicts, pictures, charts and tables."""
from dataclasses import dataclass, field
from pathlib import Path

REPRODUCED = "reproduced"
PARTLY = "partly"
NOT_REPRODUCED = "not reproduced"
MEASURED = "measured"  # the paper makes no claim that could fail
FAILED = "failed"  # the program refused or broke: the evaluation ends with an exit code


@dataclass
class Claim:
    """One statement of the paper, and what was found. `verdict` follows from the figures in `measured`."""

    paper: str
    source: str  # section or figure of the paper
    measured: str
    verdict: str


@dataclass
class Picture:
    path: Path
    caption: str


@dataclass
class Chart:
    svg: str
    caption: str


@dataclass
class Table:
    """Columns are (name, unit); an empty unit is left out. Becomes NAME.csv and a table of the page."""

    name: str
    caption: str
    columns: list
    rows: list


@dataclass
class Section:
    claims: list = field(default_factory=list)
    pictures: list = field(default_factory=list)
    charts: list = field(default_factory=list)
    tables: list = field(default_factory=list)
    notes: list = field(default_factory=list)
    sources: list = field(default_factory=list)  # of data that a licence asks to be named


@dataclass(frozen=True)
class Experiment:
    """`measure(study)` returns a Section; it may raise study.ProgramError."""

    name: str
    title: str
    figure: str  # of the paper
    shows: str  # one sentence for somebody who does not know the paper
    measure: object


def reproduced_if(condition):
    return REPRODUCED if condition else NOT_REPRODUCED
