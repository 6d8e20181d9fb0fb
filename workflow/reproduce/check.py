"""One statement that was checked: what it says, what this program finds, what it is held against, and the verdict.

PASS where  |ours − reference| ≤ tolerance · |reference|     ("relative")
            |ours − reference| ≤ tolerance                   ("absolute")
            ours ≤ reference                                 ("at most")
            |ours − reference| ≤ uncertainty                 ("uncertainty": ours and the reference's together)
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

Comparison = Literal["relative", "absolute", "at most", "uncertainty"]
Verdict = Literal["PASS", "FAIL"]
Evidence = Literal["closed form", "independent solver", "printed value", "set bound"]


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
        tolerance: what the comparison allows; unused by "at most" and "uncertainty".
        limited_by: what keeps the two apart: print, lattice, range of the interaction, statistics, solver, model.
        comparison: how the two are compared.
        paper: the printed value, if the paper prints one.
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
    def verdict(self) -> Verdict:
        """PASS or FAIL by the comparison above; a number that is none fails."""
        if not math.isfinite(self.value):
            return "FAIL"
        difference = abs(self.value - self.reference)
        match self.comparison:
            case "relative":
                passed = difference <= self.tolerance * abs(self.reference)
            case "absolute":
                passed = difference <= self.tolerance
            case "at most":
                passed = self.value <= self.reference
            case "uncertainty":
                passed = difference <= self.uncertainty
        return "PASS" if passed else "FAIL"

    def as_row(self) -> dict[str, Any]:
        """Return what reproduce.json holds; a value that is none is null, since JSON has no NaN."""
        number = self.value if math.isfinite(self.value) else None
        return {
            "study": self.study,
            "name": self.name,
            "paper": self.paper,
            "ours": {"value": number, "uncertainty": None if number is None else self.uncertainty, "unit": self.unit},
            "reference": {"value": self.reference, "source": self.source, "evidence": self.evidence},
            "ratio": self.ratio if number is not None else None,
            "comparison": self.comparison,
            "tolerance": self.tolerance,
            "limited_by": self.limited_by,
            "verdict": self.verdict,
        }

    @classmethod
    def from_row(cls, row: Mapping[str, Any]) -> Check:
        """Return the check that `as_row` wrote."""
        value, uncertainty = row["ours"]["value"], row["ours"]["uncertainty"]
        return cls(
            study=row["study"],
            name=row["name"],
            value=math.nan if value is None else value,
            uncertainty=0.0 if uncertainty is None else uncertainty,
            unit=row["ours"]["unit"],
            reference=row["reference"]["value"],
            source=row["reference"]["source"],
            evidence=row["reference"]["evidence"],
            tolerance=row["tolerance"],
            limited_by=row["limited_by"],
            comparison=row["comparison"],
            paper=row["paper"],
        )
