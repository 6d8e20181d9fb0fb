"""One statement that was checked: what it says, what this program finds, what it is held against, and the verdict.

The two agree where
    |ours − reference| ≤ tolerance · |reference|     ("relative")
    |ours − reference| ≤ tolerance                   ("absolute")
    ours ≤ reference                                 ("at most")
    |ours − reference| ≤ uncertainty                 ("uncertainty": ours and the reference's together; with a tolerance
                                                      this claim itself is at most tolerance · |reference|)
PASS: they agree. FAIL: they don't, there is no number, or a run that it rests on has a warning that the row does not
answer. A row that is expected to differ, a known limit of the model, has DIFFERS for PASS, and FAIL where they agree:
then the text about the limit is no longer true.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

Comparison = Literal["relative", "absolute", "at most", "uncertainty"]
Verdict = Literal["PASS", "FAIL", "DIFFERS"]
Evidence = Literal["closed form", "independent solver", "printed value", "paper's words", "set bound"]
Standing = Literal["judged", "repeats", "by construction"]
WIDE = 20.0
"""A row that allows more than so many times what it reaches says why."""


@dataclass(frozen=True)
class Check:
    """A row of reproduce.json.

    Attributes:
        study: name of the study that it belongs to, such as "table1".
        name: what is compared, with the values that it depends on: "adhesion force, R = 1600 LU".
        value: what this program finds; NaN where the run gave no number.
        uncertainty: of `value`, estimated by the run, same unit; 0 where there is none to speak of.
        unit: of both, "1" for a pure number.
        reference: what `value` is held against.
        source: where the reference is from, in words.
        evidence: what kind of thing that is.
        tolerance: what the comparison allows; unused by "at most".
        limited_by: what keeps the two apart: print, lattice, range of the interaction, statistics, solver, model.
        comparison: how the two are compared.
        paper: the printed value, if the paper prints one.
        runs: names of the runs that it rests on.
        warnings: of those runs, by name, and why the row stands nonetheless; without a reason it fails.
        differs: whether it is expected to differ.
        standing: "repeats" what another row says, or is true "by construction"; such rows are counted apart.
        wide: why it allows more than WIDE times what it reaches.
    """

    study: str
    name: str
    value: float
    uncertainty: float
    unit: str
    reference: float
    source: str
    evidence: Evidence
    tolerance: float
    limited_by: str
    comparison: Comparison = "relative"
    paper: float | None = None
    runs: tuple[str, ...] = ()
    warnings: Mapping[str, str] = field(default_factory=dict)
    differs: bool = False
    standing: Standing = "judged"
    wide: str = ""

    def __post_init__(self) -> None:
        """Refuse what no record can hold. Raises ValueError."""
        for name in ("reference", "tolerance", "paper"):
            number = getattr(self, name)
            if number is not None and not math.isfinite(number):
                raise ValueError(f"{self.study}, {self.name}: {name} must be finite, got {number}")
        if math.isfinite(self.value) and not math.isfinite(self.uncertainty):
            raise ValueError(f"{self.study}, {self.name}: a value needs an uncertainty, got {self.uncertainty}")

    @property
    def ratio(self) -> float | None:
        """`value` over `reference`; None where that says nothing, the reference being 0."""
        return self.value / self.reference if self.reference else None

    @property
    def off(self) -> float:
        """What is compared with `allowed`: how far ours is from the reference, or ours itself for "at most"."""
        return self.value if self.comparison == "at most" else abs(self.value - self.reference)

    @property
    def allowed(self) -> float:
        """What the comparison allows, in the unit of the row."""
        match self.comparison:
            case "relative":
                return self.tolerance * abs(self.reference)
            case "absolute":
                return self.tolerance
            case "at most":
                return self.reference
            case "uncertainty":
                return self.uncertainty

    @property
    def margin(self) -> float:
        """`allowed` over `off`; infinite where nothing is off."""
        return self.allowed / self.off if self.off else math.inf

    @property
    def is_wide(self) -> bool:
        """Whether it allows more than WIDE times what it reaches; not one that is met exactly."""
        return WIDE < self.margin < math.inf

    @property
    def unanswered(self) -> tuple[str, ...]:
        """Warnings of its runs that the row gives no answer to."""
        return tuple(name for name, answer in self.warnings.items() if not answer)

    @property
    def verdict(self) -> Verdict:
        """By the comparison above."""
        if not math.isfinite(self.value) or self.unanswered:
            return "FAIL"
        agree = self.off <= self.allowed
        if self.comparison == "uncertainty" and self.tolerance:
            agree = agree and self.uncertainty <= self.tolerance * abs(self.reference)
        if self.differs:
            return "FAIL" if agree else "DIFFERS"
        return "PASS" if agree else "FAIL"

    def as_row(self) -> dict[str, Any]:
        """Return what reproduce.json holds; a value that is none is null, since JSON has no NaN."""
        there = math.isfinite(self.value)
        row = asdict(self)
        for name in ("value", "uncertainty", "unit", "reference", "source", "evidence"):
            del row[name]
        return row | {
            "runs": list(self.runs),
            "ours": {
                "value": self.value if there else None,
                "uncertainty": self.uncertainty if there else None,
                "unit": self.unit,
            },
            "reference": {"value": self.reference, "source": self.source, "evidence": self.evidence},
            "ratio": self.ratio if there else None,
            "margin": self.margin if there and math.isfinite(self.margin) else None,
            "verdict": self.verdict,
        }

    @classmethod
    def from_row(cls, row: Mapping[str, Any]) -> Check:
        """Return the check that `as_row` wrote."""
        rest = {name: entry for name, entry in row.items() if name not in ("ours", "reference", *DERIVED)}
        ours = {name: math.nan if entry is None else entry for name, entry in row["ours"].items()}
        against = {"reference": row["reference"]["value"]} | {n: row["reference"][n] for n in ("source", "evidence")}
        return cls(**rest | ours | against | {"runs": tuple(row["runs"])})


DERIVED = ("ratio", "margin", "verdict")
"""What `as_row` adds for readers."""
