"""What a record says in words, and as one HTML page that needs nothing beside it.

Numbers are written for people: `1.4834 ± 0.0021`, `(3.1 ± 0.4) × 10⁻⁷`, with a true minus sign. Texts of a record are
plain text; on the page `F_A` and `R^0.5` become index and exponent.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from contact1d.workflow.pages.parts import embedded, environment, text_of
from validation.judging.check import Check, Evidence
from validation.judging.words import duration, limits, ours, outcome, printed, ratio, reference, tolerance
from validation.paper.record import Record, StudyRecord

EVIDENCE: dict[Evidence, str] = {
    "closed form": "an equation that is evaluated without any part of this program",
    "independent solver": "a solver in validation/references, which shares no code with what it judges",
    "printed value": "a number that the paper prints, good to its digits: it shows that the model is the paper's, not "
    "that the model is right",
    "paper's words": "something that the paper says without a number for it, put into one",
    "set bound": "a limit that was set beforehand where nobody gives a number, such as how closely curves fall "
    "together",
}
"""What a row is held against, the strongest evidence first, and what that is."""


@dataclass(frozen=True)
class Failure:
    """A row that fails, and the `id` that it has on the page."""

    anchor: str
    study: StudyRecord
    check: Check


def failures(record: Record) -> tuple[Failure, ...]:
    """Every row that fails, in the record's order."""
    return tuple(
        Failure(anchor(study, index), study, check)
        for study in record.studies
        for index, check in enumerate(study.checks)
        if check.verdict == "FAIL"
    )


def anchor(study: StudyRecord, index: int) -> str:
    """Return the `id` of a row on the page."""
    return f"{study.name}-{index + 1}"


def html_page(record: Record, folder: Path) -> str:
    """Return reproduce.html: every study with its rows and figures, without scripts or anything outside the file.

    Args:
        record: what was found.
        folder: where the figures are; one that is not there is named as missing on the page.
    """
    made = environment()
    made.filters |= {
        "anchor": anchor, "duration": duration, "limits": limits, "ours": ours, "outcome": outcome, "printed": printed,
        "ratio": ratio, "reference": reference, "tolerance": tolerance,
    }  # fmt: skip
    figures = {name: embedded(folder / name) for study in record.studies for name in study.figures}
    return made.from_string(text_of("validation.paper", "page.html")).render(
        record=record, failures=failures(record), figures=figures
    )
