"""An experiment's results for the page: claims with verdicts, pictures, charts and tables."""
from dataclasses import dataclass, field
from pathlib import Path

REPRODUCED = "reproduced"
PARTLY = "partly"
NOT_REPRODUCED = "not reproduced"
MEASURED = "measured"  # the paper makes no claim that could fail
FAILED = "failed"  # the program failed: the evaluation ends with an exit code


@dataclass
class Claim:
    """One statement of the paper, and the measurement. `verdict` follows from the figures in `measured`."""

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
    """Columns are (name, unit); an empty unit is omitted. Written as NAME.csv and as a table of the page."""

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
    sources: list = field(default_factory=list)  # data sources whose licence requires attribution


@dataclass(frozen=True)
class Experiment:
    """`measure(study)` returns a Section; it may raise study.ProgramError."""

    name: str
    title: str
    figure: str  # of the paper
    shows: str  # one sentence for readers who do not know the paper
    measure: object


def reproduced_if(condition):
    return REPRODUCED if condition else NOT_REPRODUCED
