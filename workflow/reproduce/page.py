"""What a record says in words, and as one HTML page that needs nothing beside it.

Numbers are written for people: `1.4834 ± 0.0021`, `(3.1 ± 0.4) × 10⁻⁷`, with a true minus sign. Texts of a record are
plain text; on the page `F_A` and `R^0.5` become index and exponent.
"""

from __future__ import annotations

import base64
import html
import re
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from jinja2 import Environment, StrictUndefined

from contact1d.workflow.judging.check import Check, Evidence
from contact1d.workflow.judging.words import duration, limits, ours, outcome, printed, ratio, reference, tolerance
from contact1d.workflow.reproduce.record import Record, StudyRecord

EVIDENCE: dict[Evidence, str] = {
    "closed form": "an equation that is evaluated without any part of this program",
    "independent solver": "the energy minimiser in analysis/reference, which shares no code with what it judges",
    "printed value": "a number that the paper prints, good to its digits: it shows that the model is the paper's, not "
    "that the model is right",
    "paper's words": "something that the paper says without a number for it, put into one",
    "set bound": "a limit that was set beforehand where nobody gives a number, such as how closely curves fall "
    "together",
}
"""What a row is held against, the strongest evidence first, and what that is."""

INDEX = re.compile(r"(?<!\w)([^\W\d_][\u0303\u0304]?)_(\w{1,3})(?!\w)")
TOGETHER = re.compile(r" ?= ?(?=[\d−-])|(?<=\d) (?=(?:LU|FU|nm|[µm]N|[MG]Pa)\b|%)")
EXPONENT = re.compile(r"\^(?:\{([^{}]+)\}|([−-]?\d+(?:[./]\d+)?|[a-z](?!\w)))")


def symbols(text: str) -> str:
    """Return `text` as HTML, escaped: `F_A` has an index, `R^{2/3}` an exponent, no line ends inside `R = 1000 LU`."""
    whole = TOGETHER.sub(lambda found: found[0].replace(" ", "\u00a0"), html.escape(text))
    indexed = INDEX.sub(r"<i>\1</i><sub>\2</sub>", whole)
    return EXPONENT.sub(lambda found: f"<sup>{found[1] or found[2]}</sup>", indexed)


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
    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters |= {
        "anchor": anchor, "duration": duration, "limits": limits, "ours": ours, "outcome": outcome,
        "paragraphs": paragraphs, "printed": printed, "ratio": ratio, "reference": reference, "symbols": symbols,
        "tolerance": tolerance,
    }  # fmt: skip
    text = files("contact1d.workflow.reproduce").joinpath("page.html").read_text(encoding="utf-8")
    figures = {name: _figure(folder / name) for study in record.studies for name in study.figures}
    return environment.from_string(text).render(record=record, failures=failures(record), figures=figures)


def paragraphs(text: str) -> Sequence[str]:
    """Return the parts of a text that empty lines separate."""
    return [part.strip() for part in re.split(r"\n\s*\n", text) if part.strip()]


def _figure(path: Path) -> str | None:
    """Return a PNG as a `data:` address, or None where it can't be read."""
    try:
        return "data:image/png;base64," + base64.b64encode(path.read_bytes()).decode("ascii")
    except OSError:
        return None
