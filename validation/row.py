"""A row: what this program finds, what it is held against, what the comparison allows, and the verdict.

The two agree where
    |value − reference| ≤ size · |reference|     "relative"
    |value − reference| ≤ size                   "absolute"
    |value − reference| ≤ uncertainty            "claim": what the run states (at most size · |reference|, if size > 0)
    value ≤ reference                            "at most"
    value ≥ reference                            "at least"
PASS: they agree. FAIL: they don't, there is no number, or a run that the row rests on has a warning that the row does
not answer. A row that is known to differ, a limit of the model, has a bound of its own: DIFFERS where the value is
within a margin of what the difference is known to be; FAIL elsewhere, and FAIL where it agrees after all.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal

Evidence = Literal["closed form", "independent solver", "printed value", "paper's words", "set bound"]
Kind = Literal["relative", "absolute", "claim", "at most", "at least"]
Verdict = Literal["PASS", "FAIL", "DIFFERS"]
Standing = Literal["judged", "repeats", "by construction"]
MEASURED = ("value", "uncertainty")
WIDE = 20.0
"""A row that allows more than so many times what it reaches says why."""


@dataclass(frozen=True)
class Reference:
    """What a value is held against, where it is from, and what kind of evidence that is."""

    value: float
    source: str
    evidence: Evidence = "closed form"


@dataclass(frozen=True)
class Bound:
    """What a comparison allows, and what limits it: print, lattice, statistics, solver, model."""

    kind: Kind
    size: float
    source: str


@dataclass(frozen=True)
class Known:
    """What the value of a row that differs is known to be, how near it must be, and from where that is known."""

    value: float
    margin: float
    source: str


def tables_beside(file: str) -> dict[str, Any]:
    """The tables of the TOML file that lies beside a module and has its name."""
    return tomllib.loads(Path(file).with_suffix(".toml").read_text(encoding="utf-8"))


def relative(size: float, source: str) -> Bound:
    """Within a share of the reference."""
    return Bound("relative", size, source)


def absolute(size: float, source: str) -> Bound:
    """Within so much, in the unit of the row."""
    return Bound("absolute", size, source)


def claim(source: str, most: float = 0.0) -> Bound:
    """Within the uncertainty that the run states, which itself is at most a share of the reference."""
    return Bound("claim", most, source)


def solver(value: float, source: str) -> Reference:
    """A number of a solver in `validation/references`."""
    return Reference(value, source, "independent solver")


def printed(value: float, source: str) -> Reference:
    """A number that the paper prints."""
    return Reference(value, source, "printed value")


@dataclass(frozen=True)
class Row:
    """One comparison.

    Attributes:
        name: what is compared, with the values that it depends on.
        value: what this program finds; NaN where the run gave no number.
        reference, bound: see there.
        uncertainty, unit: of the value; "1" for a pure number.
        runs: names of the runs that it rests on.
        warnings: of those runs, by name, and why the row stands nonetheless; without a reason it fails.
        known: what is known of the difference, where the row is expected to differ.
        standing: "repeats" what another row says, or is true "by construction"; such rows are counted apart.
        wide: why it allows more than WIDE times what it reaches.
    """

    name: str
    value: float
    reference: Reference
    bound: Bound
    uncertainty: float = 0.0
    unit: str = "1"
    runs: tuple[str, ...] = ()
    warnings: Mapping[str, str] = field(default_factory=dict)
    known: Known | None = None
    standing: Standing = "judged"
    wide: str = ""

    def __post_init__(self) -> None:
        """Refuse what no record can hold. Raises ValueError."""
        if not (math.isfinite(self.reference.value) and math.isfinite(self.bound.size)):
            raise ValueError(f"{self.name}: reference and bound must be finite")
        if math.isfinite(self.value) and not math.isfinite(self.uncertainty):
            raise ValueError(f"{self.name}: a value needs an uncertainty, got {self.uncertainty}")

    @property
    def off(self) -> float:
        """What is compared with `allowed`."""
        match self.bound.kind:
            case "at most":
                return self.value
            case "at least":
                return self.reference.value
        return abs(self.value - self.reference.value)

    @property
    def allowed(self) -> float:
        """What the bound allows, in the unit of the row."""
        match self.bound.kind:
            case "relative":
                return self.bound.size * abs(self.reference.value)
            case "absolute":
                return self.bound.size
            case "claim":
                return self.uncertainty
            case "at most":
                return self.reference.value
            case "at least":
                return self.value

    @property
    def margin(self) -> float:
        """`allowed` over `off`; infinite where nothing is off."""
        return self.allowed / self.off if self.off else math.inf

    @property
    def verdict(self) -> Verdict:
        """By the rules above."""
        if not math.isfinite(self.value) or not all(self.warnings.values()):
            return "FAIL"
        agrees = self.off <= self.allowed
        if self.bound.kind == "claim" and self.bound.size:
            agrees = agrees and self.uncertainty <= self.bound.size * abs(self.reference.value)
        if self.known is None:
            return "PASS" if agrees else "FAIL"
        return "DIFFERS" if not agrees and abs(self.value - self.known.value) <= self.known.margin else "FAIL"

    def as_data(self) -> dict[str, Any]:
        """What a record holds; a value that is none is null, since JSON has no NaN."""
        numbers = {key: None if math.isnan(getattr(self, key)) else getattr(self, key) for key in MEASURED}
        return asdict(self) | numbers | {"runs": list(self.runs), "verdict": self.verdict}

    @classmethod
    def of(cls, data: Mapping[str, Any]) -> Row:
        """The row that `as_data` wrote."""
        rest = {key: entry for key, entry in data.items() if key != "verdict"}
        rest |= {key: math.nan for key in MEASURED if rest[key] is None}
        known = rest["known"] and Known(**rest["known"])
        return cls(**rest | {"reference": Reference(**rest["reference"]), "bound": Bound(**rest["bound"]),
                             "runs": tuple(rest["runs"]), "known": known})  # fmt: skip


def at_most(
    name: str, value: float, bound: float, source: str, limited_by: str = "–", evidence: Evidence = "closed form"
) -> Row:
    """A row that passes where `value` ≤ `bound`; where that is an error over what is allowed, the bound is 1."""
    return Row(name, value, Reference(bound, source, evidence), Bound("at most", 0.0, limited_by))


def at_least(name: str, value: float, bound: float, source: str) -> Row:
    """A row that passes where `value` ≥ `bound`."""
    return Row(name, value, Reference(bound, source), Bound("at least", 0.0, "–"))


def so(name: str, wrong: bool, source: str) -> Row:
    """A row about what must not be; its value is 1 where it is so."""
    return at_most(name, float(wrong), 0.0, source, evidence="set bound")


def worst(values: Sequence[float]) -> float:
    """The largest; NaN, which fails, where one is not finite or there is none."""
    return max(values) if values and all(map(math.isfinite, values)) else math.nan


def verdicts(rows: Sequence[Row], verdict: Verdict) -> list[Row]:
    """The rows with that verdict."""
    return [row for row in rows if row.verdict == verdict]


def judged(rows: Sequence[Row]) -> list[Row]:
    """The rows that count: not those that repeat another or are true by construction."""
    return [row for row in rows if row.standing == "judged"]
