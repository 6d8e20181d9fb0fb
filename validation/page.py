"""How numbers and rows are said, and the two pages: VALIDATION.md for a person, and the tables beside it."""

import math
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from validation.age import Measured, times
from validation.doors import rounded, write_whole
from validation.row import WIDE, Evidence, Row, judged, verdicts, worst
from validation.study import Answer, Record

NO_NUMBER = "no number"
SMALL, SPREAD = 1e-3, 100.0
"""Below SMALL a number and its uncertainty share a power of ten, and so they do where the uncertainty is SPREAD."""
FINE = 1e-7
"""A relative uncertainty below it is written apart, beside seven digits of the value."""
SHARE_OF_PERCENT = 1e-4
"""A relative tolerance or deviation below it is not written in percent."""
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
EVIDENCE: dict[Evidence, str] = {
    "closed form": "an equation, evaluated independently of this program",
    "independent solver": "a solver in validation/references, which shares no code with the program",
    "printed value": "a number in the paper, within its digits",
    "paper's words": "a qualitative statement of the paper, expressed as a number",
    "set bound": "a limit that was set in advance where there is no reference value",
}
"""What a row is held against, the strongest evidence first."""
TABLES = "validation/results/tables.md"


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
    if size >= SMALL and uncertainty < SPREAD:
        return _with_unit(rounded(value, uncertainty).replace("-", "−"), unit)
    power = math.floor(math.log10(size))
    text = rounded(value / 10.0**power, uncertainty / 10.0**power).replace("-", "−")
    return _with_unit(f"({text}){_power(power)}", unit)


def share(part: float, digits: int = 2) -> str:
    """A relative difference: in percent, or as a power of ten where that would be a row of zeros."""
    if 0.0 < part < SHARE_OF_PERCENT:
        return number(part, digits)
    return f"{number(100.0 * part, digits if part < 0.09 else max(digits, 3))} %"


def duration(seconds: float) -> str:
    """A time as a person says it."""
    minutes = round(seconds / 60.0)
    if minutes < 1:
        return f"{number(seconds, 2)} s"
    return f"{minutes} min" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


def agreement(rows: Sequence[Row]) -> str:
    """What rows say together, for a sentence: "all 8 rows pass", "5 of 8 rows pass, 2 fail, 1 differs as expected"."""
    failed, differing = len(verdicts(rows, "FAIL")), len(verdicts(rows, "DIFFERS"))
    short = [_counted(failed, "fail")] * bool(failed) + [_as_expected(differing)] * bool(differing)
    passed = f"{len(rows) - failed - differing} of" if short else "all"
    return ", ".join([f"{passed} {len(rows)} rows pass", *short])


def margins_of(record: Record) -> dict[str, list[float]]:
    """By class, the distance of each judged row from its reference over what is allowed, 1 at most."""
    found = {
        one.name: [row.off / row.allowed for row in judged(one.rows) if row.allowed > 0.0 and math.isfinite(row.off)]
        for one in record.answers
    }
    return {name: shares for name, shares in found.items() if shares}


def outcome(rows: Sequence[Row]) -> str:
    """How the rows came out: "12 of 14 rows pass, 2 differ as expected; counted separately: 3 repeat another"."""
    own = judged(rows)
    expected = [row for row in own if row.known is not None]
    differing, failing = len(verdicts(own, "DIFFERS")), len(verdicts(expected, "FAIL"))
    parts = [f"{len(verdicts(own, 'PASS'))} of {len(own)} rows pass"]
    parts += [_as_expected(differing)] if differing else []
    parts += [f"{failing} should differ and {'does' if failing == 1 else 'do'} not as expected"] if failing else []
    apart = Counter(row.standing for row in rows if row.standing != "judged")
    said = [f"{_counted(apart['repeats'], 'repeat')} another"] if apart["repeats"] else []
    said += [f"{apart['by construction']} true by construction"] if apart["by construction"] else []
    return ", ".join(parts) + (f"; counted separately: {', '.join(said)}" if said else "")


def _counted(count: int, verb: str) -> str:
    """ "1 repeats", "2 repeat"."""
    return f"{count} {verb}{'s' * (count == 1)}"


def _as_expected(count: int) -> str:
    """ "1 differs as expected", "2 differ as expected"."""
    return f"{_counted(count, 'differ')} as expected"


def reference(row: Row) -> str:
    """What the row is held against."""
    return _with_unit(number(row.reference.value, 6), row.unit)


def allowed(row: Row) -> str:
    """What the comparison allows."""
    match row.bound.kind:
        case "relative":
            return f"within {share(row.bound.size, 4)}"
        case "absolute":
            return f"within {_with_unit(number(row.bound.size, 3), row.unit)}"
        case "at most" | "at least":
            return f"{row.bound.kind} {reference(row)}"
        case "claim":
            most = f", itself at most {share(row.bound.size)}" if row.bound.size else ""
            return f"within the uncertainty{most}"


def limits(row: Row) -> str:
    """What keeps the two apart, why the row allows more than it needs, and what it says to warnings of its runs."""
    said = [row.bound.source]
    if row.wide and WIDE < row.margin < math.inf:
        said.append(f"wider than needed: {row.wide}")
    if row.known:
        near = number(row.known.margin, 2)
        said.append(f"known to be {number(row.known.value)} within {near}: {row.known.source}")
    said += [f"warning {name}: {answer or 'not answered'}" for name, answer in row.warnings.items()]
    return "; ".join(said)


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table; what would break a cell is escaped."""
    lines: list[Sequence[str]] = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(map(_cell, line)) + " |" for line in lines) + "\n"


def prose(text: str) -> str:
    """`text` with no tag in it, and `R^{2/3}` as R^(2/3)."""
    return re.sub(r"\^\{([^{}]+)\}", r"^(\1)", text.replace("<", "&lt;"))


def tables_page(records: Iterable[Record]) -> str:
    """Every row of every study."""
    parts = ["# Every row\n\nWritten by `make validation`; [VALIDATION.md](../../VALIDATION.md) is what to read first."]
    head = ("checked", "found", "reference", "allowed", "against", "limited by", "verdict")
    for answer in (answer for record in records for answer in record.answers):
        cells = [
            (row.name, measured(row.value, row.uncertainty, row.unit), reference(row), allowed(row),
             f"{row.reference.source} ({row.reference.evidence})", limits(row), _badge(row))
            for row in answer.rows
        ]  # fmt: skip
        parts += [f"## {prose(answer.title)} (`{answer.name}`)", prose(answer.text), table(head, cells).rstrip()]
    return "\n\n".join(filter(None, parts)) + "\n"


def summary(paper: Record, hard: Record, speed: Record) -> str:
    """VALIDATION.md: what was asked, what came out, some figures, and what is not validated."""
    counted = [
        (name, meaning, str(len(own)), str(len(verdicts(own, "PASS"))), str(len(verdicts(own, "DIFFERS"))))
        for name, meaning in EVIDENCE.items()
        if (own := [row for row in judged(paper.rows) if row.reference.evidence == name])
    ]
    made = ", ".join(f"{name} {version}" for name, version in paper.versions.items())
    took = duration(sum(answer.wall_s for answer in hard.answers))
    filled = {
        "paper": f"{outcome(paper.rows)} (measured {_when(paper.answers)})",
        "hard": f"{agreement(hard.rows)} (measured {_when(hard.answers)})",
        "speed": f"{agreement(speed.rows)} (measured {_when(speed.answers)})",
        "failing": _failing([*paper.answers, *hard.answers, *speed.answers]),
        "evidence": table(("reference", "meaning", "rows", "pass", "differ"), counted),
        "studies": table(("study", "subject", "result", "verdict", "measured"), map(_study, paper.answers)),
        "differing": _differing(paper),
        "classes": table(("class", "what is tested", "rows", "smallest margin", "measured"),
                         map(_class, hard.answers)),
        "kinds": _kinds(hard),
        "made": f"Made with {made}; the hard cases took {took}, one after the other, on {hard.machine}.",
    }  # fmt: skip
    return (Path(__file__).parent / "validation.md").read_text(encoding="utf-8").format(**filled)


def _kinds(record: Record) -> str:
    """How many rows count what must not be, and which classes are recorded in their short form."""
    none = sum(row.reference.value == 0.0 for row in record.rows)
    text = (
        f"{none} of {len(record.rows)} rows count errors that must not occur, such as a missing warning, and pass at "
        "0; the others compare numbers."
    )
    quick = [f"`{answer.name}`" for answer in record.answers if answer.form != "full"]
    return f"{text} Measured in their short form, without `--full`: {', '.join(quick)}." if quick else text


def speed_table(record: Record) -> str:
    """A row for each comparison of times."""
    rows = [
        (f"`{one.name}`", row.name, number(row.value, 3), allowed(row) + " **not reached**" * (row.verdict == "FAIL"))
        for one in record.answers
        for row in one.rows
    ]
    return f"{table(('study', 'measured', 'found', 'asked'), rows)}\nMeasured {_when(record.answers)}.\n"


def write_between(page: Path, name: str, text: str) -> None:
    """Put a text between the markers of that name on a page. Raises ValueError: the page has none."""
    begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->\n"
    before, first, rest = page.read_text(encoding="utf-8").partition(begin)
    _, last, after = rest.partition(end)
    if not (first and last):
        raise ValueError(f"{page} has no markers {begin.strip()} and {end.strip()}")
    write_whole(page, before + begin + text + end + after)


def _when(answers: Sequence[Answer]) -> str:
    return times(Measured(answer.date, answer.commit) for answer in answers)


def _differing(record: Record) -> str:
    """What the paper says and this program does not find: as printed, or a qualitative statement and how it is tested;
    as it is here, and why."""
    rows = [
        (f"`{answer.name}`", row.name,
         reference(row) if row.reference.evidence == "printed value"
         else f"{row.reference.source}; tested as {allowed(row)}, the uncertainty of the runs",
         measured(row.value, row.uncertainty, row.unit), row.known.source)
        for answer in record.answers
        for row in judged(answer.rows)
        if row.known and row.reference.evidence in ("printed value", "paper's words")
    ]  # fmt: skip
    return table(("study", "quantity", "in the paper", "here", "reason"), rows)


def _study(answer: Answer) -> tuple[str, ...]:
    words, own = outcome(answer.rows), judged(answer.rows)
    compared = [row for row in own if row.bound.kind in ("relative", "claim") and row.reference.value and not row.known]
    largest = worst([abs(row.value / row.reference.value - 1.0) for row in compared])
    if math.isfinite(largest):
        words += f"; largest relative deviation {share(largest)}"
    verdict = "**FAIL**" if verdicts(own, "FAIL") else "DIFFERS" if verdicts(own, "DIFFERS") else "PASS"
    return f"`{answer.name}`", answer.title, words, verdict, _when([answer])


def _class(answer: Answer) -> tuple[str, ...]:
    margins = [row.margin for row in answer.rows if math.isfinite(row.margin)]
    least = number(min(margins), 3) if margins else "no difference found"
    rows = f"{len(verdicts(answer.rows, 'PASS'))} of {len(answer.rows)}"
    return f"`{answer.name}`", f"{answer.title}: {answer.question}", rows, least, _when([answer])


def _failing(answers: Sequence[Answer]) -> str:
    failed = [(f"`{one.name}`", row.name, number(row.value), allowed(row)) for one in answers
              for row in verdicts(one.rows, "FAIL")]  # fmt: skip
    return f"These fail:\n\n{table(('study', 'checked', 'found', 'allowed'), failed)}" if failed else "No row fails."


def _badge(row: Row) -> str:
    word = f"**{row.verdict}**" if row.verdict == "FAIL" else row.verdict
    return word if row.standing == "judged" else f"{word}, {row.standing}"


def _cell(text: str) -> str:
    return re.sub(r"\s+", " ", prose(text.replace("\\", "\\\\").replace("|", "\\|"))).strip()


def _with_unit(text: str, unit: str) -> str:
    return text if unit in ("", "1") else f"{text} {unit}"


def _power(exponent: int) -> str:
    return f" × 10{str(exponent).translate(SUPERSCRIPTS)}"
