"""What a record says in words, and as one HTML page that needs nothing beside it.

Numbers are written for people: `1.4834 ± 0.0021`, `(3.1 ± 0.4) × 10⁻⁷`, with a true minus sign. Texts of a record are
plain text; on the page `F_A` and `R^0.5` become index and exponent.
"""

from __future__ import annotations

import base64
import html
import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from jinja2 import Environment, StrictUndefined

from contact1d.workflow.reproduce.check import Check, Evidence
from contact1d.workflow.reproduce.record import Record, StudyRecord
from contact1d.workflow.units import rounded

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

NO_NUMBER = "no number"
SMALL, WIDE = 1e-3, 100.0
"""Below SMALL a number and its uncertainty share a power of ten, and so they do where the uncertainty is WIDE."""
FINE = 1e-7
"""A relative uncertainty below it is written apart, beside seven digits of the value."""
SHARE_OF_PERCENT = 1e-4
"""A relative tolerance or deviation below it is not written in percent."""
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
INDEX = re.compile(r"(?<!\w)([^\W\d_][\u0303\u0304]?)_(\w{1,3})(?!\w)")
TOGETHER = re.compile(r" ?= ?(?=[\d−-])|(?<=\d) (?=(?:LU|FU|nm|[µm]N|[MG]Pa)\b|%)")
EXPONENT = re.compile(r"\^(?:\{([^{}]+)\}|([−-]?\d+(?:[./]\d+)?|[a-z](?!\w)))")


def number(value: float, digits: int = 5) -> str:
    """`value` with at most `digits` significant digits."""
    if math.isnan(value):
        return NO_NUMBER
    mantissa, _, exponent = f"{value:.{digits}g}".replace("inf", "∞").partition("e")
    return mantissa.replace("-", "−") + (_power(int(exponent)) if exponent else "")


def measured(value: float, uncertainty: float, unit: str) -> str:
    """`value ± uncertainty unit`; the uncertainty has two digits, and is left out where there is none to speak of."""
    if not math.isfinite(value):
        return NO_NUMBER
    if not math.isfinite(uncertainty) or uncertainty <= 0.0:
        return _with_unit(number(value), unit)
    if uncertainty < FINE * abs(value):  # more digits than anybody reads
        return _with_unit(f"{number(value, 7)} ± {number(uncertainty, 1)}", unit)
    size = max(abs(value), uncertainty)
    if size >= SMALL and uncertainty < WIDE:
        return _with_unit(rounded(value, uncertainty).replace("-", "−"), unit)
    power = math.floor(math.log10(size))
    text = rounded(value / 10.0**power, uncertainty / 10.0**power).replace("-", "−")
    return _with_unit(f"({text}){_power(power)}", unit)


def ours(check: Check) -> str:
    """What this program finds."""
    return measured(check.value, check.uncertainty, check.unit)


def printed(check: Check) -> str:
    """The value that the paper prints, or a dash."""
    return "–" if check.paper is None else _with_unit(number(check.paper, 6), check.unit)


def reference(check: Check) -> str:
    """What the row is held against."""
    return _with_unit(number(check.reference, 6), check.unit)


def ratio(check: Check) -> str:
    """Ours over the reference, with as many places as show how far it is from 1, or a dash."""
    if check.ratio is None or not math.isfinite(check.ratio):
        return "–"
    deviation = abs(check.ratio - 1.0)
    if deviation > 0.5:
        return number(check.ratio, 3)
    places = 10 if deviation == 0.0 else 1 - math.floor(math.log10(deviation))
    return f"{check.ratio:.{places}f}" if places <= 8 else "1"


def tolerance(check: Check) -> str:
    """What the comparison allows."""
    match check.comparison:
        case "relative":
            return f"within {share(check.tolerance, 4)}"
        case "absolute":
            return f"within {_with_unit(number(check.tolerance, 3), check.unit)}"
        case "at most":
            return f"at most {reference(check)}"
        case "uncertainty":
            bound = f", itself at most {share(check.tolerance)}" if check.tolerance else ""
            return f"within the uncertainty{bound}"


def share(part: float, digits: int = 2) -> str:
    """A relative difference: in percent, or as a power of ten where that would be a row of zeros."""
    if 0.0 < part < SHARE_OF_PERCENT:
        return number(part, digits)
    return f"{number(100.0 * part, digits if part < 0.09 else max(digits, 3))} %"


def duration(seconds: float) -> str:
    """A time as a person says it."""
    if seconds < 60.0:
        return f"{number(seconds, 2)} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


def limits(check: Check) -> str:
    """What keeps the two apart, why the row allows more than it needs, and what it says to warnings of its runs."""
    wide = (f"wider than needed: {check.wide}",) if check.wide and check.is_wide else ()
    answers = (f"warning {name}: {answer or 'not answered'}" for name, answer in check.warnings.items())
    return "; ".join((check.limited_by, *wide, *answers))


def passed(checks: Iterable[Check]) -> int:
    """How many rows pass."""
    return sum(check.verdict == "PASS" for check in checks)


def judged(checks: Iterable[Check]) -> tuple[Check, ...]:
    """The rows that count: not those that repeat another or are true by construction."""
    return tuple(check for check in checks if check.standing == "judged")


def outcome(checks: Sequence[Check]) -> str:
    """How the rows came out: "12 of 14 rows pass, 2 differ as expected; apart from these 3 repeat another"."""
    own = judged(checks)
    differ = sum(check.verdict == "DIFFERS" for check in own)
    asked = len(own) - sum(check.differs for check in own)
    parts = [f"{passed(own)} of {asked} rows pass"] if asked or not differ else []
    failing = sum(check.differs for check in own) - differ
    parts += [f"{differ} differ{'s' * (differ == 1)} as expected"] * bool(differ)
    parts += [f"{failing} expected to differ do not"] * bool(failing)
    apart = [
        f"{len(rows)} {words}"
        for standing, words in (("repeats", "repeat another"), ("by construction", "true by construction"))
        if (rows := [check for check in checks if check.standing == standing])
    ]
    return ", ".join(parts) + (f"; counted apart: {', '.join(apart)}" if apart else "")


def agreement(checks: Sequence[Check]) -> str:
    """What rows say together, for a sentence: "all 8 rows pass", "2 of 8 rows fail"."""
    failed = sum(check.verdict == "FAIL" for check in checks)
    return f"{failed} of {len(checks)} rows fail" if failed else f"all {len(checks)} rows pass"


def worst_deviation(checks: Iterable[Check]) -> float:
    """Largest |ours/reference − 1|; infinite where a row has no number."""
    return max(math.inf if math.isnan(d) else d for d in (abs(c.value / c.reference - 1.0) for c in checks))


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


def _with_unit(text: str, unit: str) -> str:
    return text if unit in ("", "1") else f"{text} {unit}"


def _power(exponent: int) -> str:
    return f" × 10{str(exponent).translate(SUPERSCRIPTS)}"
