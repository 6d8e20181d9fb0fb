"""Numbers of random scenes against independent references: how often a claim holds, and whether what it misses is told.

A claim is a standard a person reads: value ± uncertainty. Of many random scenes it is to hold for 95 % of the numbers,
and a number that is further off than the tolerance has a warning that names it.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from validation.doors import Run
from validation.figures import Drawing, Panel, Series, figure
from validation.row import Row, at_most
from validation.study import LONGEST, Refused

INSIDE = 0.95
"""Share of the numbers that is to be within its claim, and of the scenes that is to run."""
NAMING = ("tolerance", "lattice")
"""Warnings whose message names the numbers that it is about, each with its relative uncertainty."""
MISSING = ("no_peak", "no_zero_load", "no_radius")
"""Warnings that say that a number is not there."""
UNKNOWN = "unknown"
"""Warning that names numbers that are less certain than half of themselves, and have no value."""
OF_ALL = ("near_pull_off", "cutoff", "table_core")
"""Warnings that are about every number of a run."""
IMAGE = "image_"
"""Of a length of the image, where the body's own has the plain name."""
LEAST = 1e-6
"""Error over the claim that is drawn at least."""


@dataclass(frozen=True)
class Error:
    """One number.

    Attributes:
        scene: name of its run.
        name: of the number.
        over_tolerance: relative error over the tolerance that was asked for.
        over_claim: error over the stated uncertainty.
        told: whether a warning names it.
    """

    scene: str
    name: str
    over_tolerance: float
    over_claim: float
    told: bool


@dataclass
class Tally:
    """What came of the scenes of a kind."""

    errors: list[Error] = field(default_factory=list)
    refused: dict[str, str] = field(default_factory=dict)
    scenes: Counter[str] = field(default_factory=Counter)

    def add(self, scene: str, group: str, found: Run | Refused, exact: Mapping[str, float], slack: float) -> None:
        """Take in a run; `slack` is the relative error of the reference."""
        self.scenes[group] += 1
        if isinstance(found, Refused):
            self.refused[scene] = found.words
            return
        self.errors += errors_of(scene, found, exact, slack)

    def checks(self, kind: str, source: str) -> list[Row]:
        """The three rows of a kind of scenes."""
        count, numbers = sum(self.scenes.values()), len(self.errors)
        outside = [e for e in self.errors if not e.over_claim <= 1.0]
        silent = [e for e in self.errors if not e.over_tolerance <= 1.0 and not e.told]
        groups = ", ".join(f"{n} {group}" for group, n in sorted(self.scenes.items()))
        refused = next(iter(self.refused.values()), "–")
        return [
            at_most(
                f"share of {numbers} numbers of {count} scenes ({groups}) outside of their claim",
                len(outside) / numbers if numbers else float("nan"),
                1.0 - INSIDE,
                source,
                _worst(outside),
            ),
            at_most(
                f"of {numbers} numbers, those outside of the tolerance without a warning that names them",
                len(silent),
                0.0,
                source,
                _worst(silent),
            ),
            at_most(
                f"share refused of {count} scenes that the reference carries",
                len(self.refused) / count if count else float("nan"),
                1.0 - INSIDE,
                "what is asked: 95 % must run",
                refused[:LONGEST],
                "set bound",
            ),
        ]

    def drawn(self) -> dict[str, Drawing]:
        """Error over claim, rising, over the share of the numbers that is below; a series for each name."""
        drawn = []
        for name in sorted({error.name for error in self.errors}):
            over = np.sort([max(LEAST, min(e.over_claim, 1.0 / LEAST)) for e in self.errors if e.name == name])
            drawn.append(Series(name, (np.arange(over.size) + 1.0) / over.size, over))
        labels = ("share of the numbers", "error over the claim")
        return figure(
            "Errors over claims of random scenes, in order; dashed: the bound",
            Panel(*labels, drawn, log="y", bound=1.0),
        )


def errors_of(scene: str, run: Run, exact: Mapping[str, float], slack: float) -> list[Error]:
    """The errors of a run's numbers, as far as the reference has them.

    A number that is missing is infinitely off, unless the run says that there is none, or that it is not known. A
    length that is 0 has no relative error: it is compared with its claim alone.
    """
    tolerance, found = run.scene.accuracy.tolerance, []
    for name, value in exact.items():
        quantity = run.results.get(IMAGE + name, run.results.get(name))
        if quantity is None or math.isnan(quantity.value):
            if not set(MISSING) & set(run.warnings) and name not in run.warnings.get(UNKNOWN, ""):
                found.append(Error(scene, name, float("inf"), float("inf"), told=False))
            continue
        error = max(0.0, abs(quantity.value - value) - slack * abs(value))
        relative = error / abs(value) / tolerance if value else 0.0
        claimed = quantity.uncertainty
        over = error / claimed if claimed > 0.0 else (0.0 if error == 0.0 else float("inf"))
        told = any(re.search(rf"\b{name} (\d|inf)", run.warnings.get(warning, "")) for warning in NAMING)
        found.append(Error(scene, name, relative, over, told or bool(set(OF_ALL) & set(run.warnings))))
    return found


def _worst(errors: list[Error]) -> str:
    """The number that is furthest off."""
    if not errors:
        return "–"
    worst = max(errors, key=lambda error: error.over_claim)
    off = f"{worst.over_claim:.3g} claims, {worst.over_tolerance:.3g} tolerances"
    return f"worst: {worst.name} of {worst.scene}, {off} off"
