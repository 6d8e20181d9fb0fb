"""What `reproduce` found, as one value: the checks of each study, its figures, what ran and on what."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, get_args

from validation.judging.check import Check, Standing

RECORD = "reproduce.json"


@dataclass(frozen=True)
class StudyRecord:
    """One study.

    Attributes:
        name: "fig8a".
        title: one line.
        statement: what the paper says, in a sentence or two of our own.
        finding: what was found, in a few sentences, with the numbers that matter.
        checks: the rows.
        figures: {file name beside reproduce.json: caption}.
        runs: how many runs it took, and the CPU seconds of LAMMPS in them.
    """

    name: str
    title: str
    statement: str
    finding: str
    checks: tuple[Check, ...]
    figures: Mapping[str, str] = field(default_factory=dict)
    runs: int = 0
    lammps_s: float = 0.0


@dataclass(frozen=True)
class Record:
    """All studies that were done, in the paper's order.

    Attributes:
        studies: see `StudyRecord`.
        versions: of the programs.
        wall_s: wall time of the call that wrote the record [s].
    """

    studies: tuple[StudyRecord, ...]
    versions: Mapping[str, str]
    wall_s: float

    @property
    def checks(self) -> tuple[Check, ...]:
        """The rows of all studies."""
        return tuple(check for study in self.studies for check in study.checks)

    @property
    def failed(self) -> tuple[Check, ...]:
        """The rows that fail, whatever their standing."""
        return tuple(check for check in self.checks if check.verdict == "FAIL")

    def to_json(self) -> str:
        """Return the text of reproduce.json."""
        document = {
            "verdicts": {
                standing: dict(Counter(check.verdict for check in self.checks if check.standing == standing))
                for standing in get_args(Standing)
            },
            "rows": [check.as_row() for check in self.checks],
            "studies": [
                {
                    "name": study.name,
                    "title": study.title,
                    "statement": study.statement,
                    "finding": study.finding,
                    "figures": dict(study.figures),
                    "runs": study.runs,
                    "lammps_s": study.lammps_s,
                }
                for study in self.studies
            ],
            "versions": dict(self.versions),
            "wall_s": self.wall_s,
        }
        return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def read_record(path: Path) -> Record:
    """Read a reproduce.json. Raises OSError, and ValueError where it is none."""
    document: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    rows: dict[str, list[Check]] = {}
    for row in document["rows"]:
        rows.setdefault(row["study"], []).append(Check.from_row(row))
    studies = tuple(StudyRecord(checks=tuple(rows.get(study["name"], ())), **study) for study in document["studies"])
    return Record(studies, document["versions"], document["wall_s"])
