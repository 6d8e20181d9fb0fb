"""What `stability` found: stability.json, and the table in Markdown with date and kind of machine.

margin = what the rule of a row allows over what was found: 1 at the bound, below it FAIL; none where the two are equal.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from validation.hard.case import Class, Findings
from validation.judging.check import Check
from validation.judging.markdown import prose, table
from validation.judging.words import duration, number, ours, reference, tolerance

RECORD, TABLE = "stability.json", "stability.md"


@dataclass(frozen=True)
class Answer:
    """A class that was measured: "quick" or "full", on which day, and the wall time that took [s]."""

    asked: Class
    found: Findings
    seconds: float
    form: str
    date: str


@dataclass(frozen=True)
class Stability:
    """All that was measured.

    Attributes:
        answers: in the order of the classes.
        machine: kind of machine, without names.
        versions: of the programs.
        wall_s: wall time of all [s].
    """

    answers: tuple[Answer, ...]
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
                    "form": answer.form,
                    "date": answer.date,
                }
                for answer in self.answers
            ],
            "versions": dict(self.versions),
            "wall_s": self.wall_s,
        }

    def to_json(self) -> str:
        """Return the text of stability.json."""
        return json.dumps(self.document(), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def stability_markdown(document: Mapping[str, Any], figures: str = "", names: Sequence[str] = ()) -> str:
    """Return the section of VALIDATION.md.

    Args:
        document: what stability.json holds.
        figures: their folder, with a slash.
        names: of all classes, so that those that the record lacks are named.
    """
    rows = [Check.from_row(row) for row in document["rows"]]
    classes = document["classes"]
    forms = {form: sum(one["form"] == form for one in classes) for form in ("full", "quick")}
    head = (
        f"## Hard cases\n\nWritten by `contact1d stability` (the long form with `--full`) on {document['machine']}: "
        f"{forms['full']} classes in the long form, {forms['quick']} in the quick one. "
        f"**{document['passed']} of {len(rows)} rows pass.** A row that fails stays. "
        "The margin is what the bound allows over what was found."
    )
    parts = [head]
    if missing := [name for name in names if name not in {one["name"] for one in classes}]:
        parts.append(f"Not measured for this record: {', '.join(f'`{name}`' for name in missing)}.")
    for one in classes:
        form = "long" if one["form"] == "full" else "quick"
        made = f"The {form} form, on {one['date']}, in {duration(one['wall_s'])} beside other work."
        parts.append(f"### {prose(one['title'])} (`{one['name']}`)\n\n{prose(one['question'])} {made}")
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
