"""How numbers and rows are said: `1.4834 ± 0.0021`, `(3.1 ± 0.4) × 10⁻⁷`, with a true minus sign."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from contact1d.workflow.units import rounded
from validation.judging.check import Check

NO_NUMBER = "no number"
SMALL, WIDE = 1e-3, 100.0
"""Below SMALL a number and its uncertainty share a power of ten, and so they do where the uncertainty is WIDE."""
FINE = 1e-7
"""A relative uncertainty below it is written apart, beside seven digits of the value."""
SHARE_OF_PERCENT = 1e-4
"""A relative tolerance or deviation below it is not written in percent."""
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


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


def _with_unit(text: str, unit: str) -> str:
    return text if unit in ("", "1") else f"{text} {unit}"


def _power(exponent: int) -> str:
    return f" × 10{str(exponent).translate(SUPERSCRIPTS)}"
