"""What `stability` found: stability.json, and the table in Markdown with date and kind of machine.

margin = what the rule of a row allows over what was found: 1 at the bound, below it FAIL; none where the two are equal.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from contact1d.workflow.judging.check import Check
from contact1d.workflow.judging.markdown import prose, table
from contact1d.workflow.judging.words import duration, number, ours, reference, tolerance
from contact1d.workflow.stability.case import Class, Findings

RECORD, TABLE = "stability.json", "stability.md"


@dataclass(frozen=True)
class Answer:
    """A class that was measured, and the wall time that took [s]."""

    asked: Class
    found: Findings
    seconds: float


@dataclass(frozen=True)
class Stability:
    """All that was measured.

    Attributes:
        answers: in the order of the classes.
        form: "quick" or "full".
        date: day on which it ran.
        machine: kind of machine, without names.
        versions: of the programs.
        wall_s: wall time of all [s].
    """

    answers: tuple[Answer, ...]
    form: str
    date: str
    machine: str
    versions: Mapping[str, str]
    wall_s: float

    @property
    def checks(self) -> tuple[Check, ...]:
        """The rows of all classes."""
        return tuple(check for answer in self.answers for check in answer.found.checks)

    @property
    def failed(self) -> tuple[Check, ...]:
        """The rows that fail."""
        return tuple(check for check in self.checks if check.verdict == "FAIL")

    def document(self) -> dict[str, Any]:
        """Return what stability.json holds."""
        return {
            "form": self.form,
            "date": self.date,
            "machine": self.machine,
            "passed": len(self.checks) - len(self.failed),
            "failed": len(self.failed),
            "rows": [check.as_row() for check in self.checks],
            "classes": [
                {
                    "name": answer.asked.name,
                    "title": answer.asked.title,
                    "question": answer.asked.question,
                    "figure": answer.found.figure,
                    "caption": answer.found.caption,
                    "wall_s": answer.seconds,
                }
                for answer in self.answers
            ],
            "versions": dict(self.versions),
            "wall_s": self.wall_s,
        }

    def to_json(self) -> str:
        """Return the text of stability.json."""
        return json.dumps(self.document(), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def stability_markdown(document: Mapping[str, Any], figures: str = "") -> str:
    """Return the section of VALIDATION.md, from what stability.json holds; `figures`: their folder, with a slash."""
    rows = [Check.from_row(row) for row in document["rows"]]
    command = "contact1d stability" + (" --full" if document["form"] == "full" else "")
    parts = [
        f"## Hard cases\n\nWritten by `{command}` on {document['date']}, on {document['machine']}, in "
        f"{duration(document['wall_s'])}. **{document['passed']} of {len(rows)} rows pass.** A row that fails stays. "
        "The margin is what the bound allows over what was found."
    ]
    for one in document["classes"]:
        parts.append(f"### {prose(one['title'])} (`{one['name']}`)\n\n{prose(one['question'])}")
        cells = [
            (c.name, ours(c), bound(c), c.source, _margin(c), c.limited_by, _badge(c))
            for c in rows
            if c.study == one["name"]
        ]
        parts.append(table(("case", "measured", "bound", "from", "margin", "limited by", "verdict"), cells).rstrip())
        if one["figure"]:
            parts.append(f"Figure: [{prose(one['caption'])}]({figures}{one['figure']})")
    return "\n\n".join(parts) + "\n"


def bound(check: Check) -> str:
    """The reference with what is allowed beside it."""
    return tolerance(check) if check.comparison == "at most" else f"{reference(check)}, {tolerance(check)}"


def _margin(check: Check) -> str:
    if not math.isfinite(check.value):
        return "–"
    return number(check.margin, 2) if math.isfinite(check.margin) else "exact"


def _badge(check: Check) -> str:
    return "**FAIL**" if check.verdict == "FAIL" else "PASS"
