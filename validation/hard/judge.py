"""The judge: each number of a finished run beside its reference, and rows that say what came of all of them.

A claim is a standard a person reads: value ± uncertainty. It is to hold, a number that is off by more than the
tolerance is to have a warning that names it, and one that is missing is to be missed with a word.
"""

import math
import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from validation.doors import Run, read_run
from validation.hard.units import MODEL, Scene, Units
from validation.references.numerics import Floats, Function
from validation.row import Row, at_most, worst
from validation.study import LONGEST, Bench, Refused, over_uncertainty

QUADRATURE = 1e-8
"""Relative error of a quadrature."""
NAMING, GONE = (
    ("lattice", "tolerance", "kink", "input"),
    ("unknown", "no_peak", "no_zero_load", "no_radius", "no_energy"),
)
"""Warnings that give the relative uncertainty of each number they name; those that say that there is none."""
OF_ALL = ("near_pull_off", "cutoff", "table_core")
"""Warnings that are about every number of a run of particles that interact."""
POINTS = (0.0, 0.3, 0.7, 1.0)
"""Of the radii of a pressure, which are compared."""
FOLLOWS = {
    "critical_radius": ("adhesion_force",),
    "work_of_separation": ("adhesion_force", "zero_load_radius"),
    "adhesion_energy": ("zero_load_radius",),
    "fixed_grips_displacement": ("adhesion_force",),
}
"""Numbers that go where another one is not reported."""
OPTIONAL = ("peak_pressure", "central_pressure")
"""Numbers that narrow contacts do not have, as documented."""
IMAGE = "image_"
"""Of a length of the image, where the body's own has the plain name."""
OUTSIDE, FARTHEST = 0.02, 3.0
"""Share of the numbers of random scenes that may be outside of their uncertainty, and of the scenes that may be
refused; the largest error."""
REFUSED = 0.05
"""The same shares of scenes of particles that interact."""


@dataclass(frozen=True)
class Curve:
    """A column of curve.csv as a function of another one, all values at once; errors are over `scale`."""

    of: str
    values: Callable[[Floats], Floats]
    scale: float
    narrowest: float = 0.0
    """Contact radius from which on it is compared."""


@dataclass(frozen=True)
class Expected:
    """What a scene has by the references, in units of its model.

    Attributes:
        numbers: by name; inf where there must be none.
        error: relative error of the references.
        pressures: p(r) by the name of the state.
        pressure_error: of these and of the numbers that are pressures.
        curves: by the name of the column.
        needed: numbers that must be there or be missing with a word; without, all.
        largest: what a number was at most on the way, which its tolerance is a share of; of a last force or
            displacement its peak.
    """

    numbers: Mapping[str, float] = field(default_factory=dict)
    error: float = QUADRATURE
    pressures: Mapping[str, Function] = field(default_factory=dict)
    pressure_error: float = QUADRATURE
    curves: Mapping[str, Curve] = field(default_factory=dict)
    needed: tuple[str, ...] | None = None
    largest: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Case:
    """A scene in units of its model, its group and what is special of it, and what it has; `units`: how it is run."""

    name: str
    group: str
    words: str
    scene: Scene
    expected: Expected
    units: Units = MODEL

    def run(self, bench: Bench) -> Run | Refused:
        """A run; one that ends in an error that is not for the user is refused, too."""
        try:
            return bench.run(self.name, self.units.written(self.scene))
        except Exception as error:
            return Refused(f"ended by {type(error).__name__}: {error}", before=False)


@dataclass(frozen=True)
class Number:
    """One number of one scene.

    Attributes:
        over: |value − reference| over the uncertainty; inf where a number stands for one that is infinite.
        far: |value − reference| over |reference| and the tolerance.
        wide: uncertainty over |value| and the tolerance.
        named: whether a warning names it.
    """

    scene: str
    group: str
    words: str
    name: str
    value: float
    uncertainty: float
    reference: float
    over: float
    far: float
    wide: float
    named: bool

    @property
    def label(self) -> str:
        """Which one it is."""
        return f"{self.name} of {self.scene}"


def relative(n: Number) -> float:
    """The relative error."""
    return abs(n.value / n.reference - 1.0)


def absolute(n: Number) -> float:
    """The error itself."""
    return abs(n.value - n.reference)


@dataclass
class Judge:
    """What came of some scenes; `of_all`: warnings that are about every number."""

    of_all: tuple[str, ...] = ()
    numbers: list[Number] = field(default_factory=list)
    along: dict[str, dict[str, float]] = field(default_factory=lambda: defaultdict(dict))
    absent: dict[str, list[str]] = field(default_factory=dict)
    silent: dict[str, list[str]] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    unjudged: Counter[str] = field(default_factory=Counter)
    scenes: Counter[str] = field(default_factory=Counter)

    def add(self, case: Case, run: Run | Refused) -> None:
        """Take in what a run has of the scene's numbers."""
        exact, scene = case.expected, f"{case.name} ({case.words})"
        self.scenes[case.group] += 1
        if isinstance(run, Refused):
            self.refused[case.name] = f"{case.words}: {run.words}"
            for column in exact.curves:
                self.along[column][scene] = math.nan
            return
        said = read_run(run.folder) if case.units.texts else run
        self.unjudged.update(set(run.results) - set(exact.numbers))
        self._pressures(case, said)
        for name, reference in exact.numbers.items():
            quantity = said.results.get(IMAGE + name, said.results.get(name))
            if quantity is None or math.isnan(quantity.value):
                if math.isfinite(reference) and (exact.needed is None or name in exact.needed):
                    kept = self.silent if unsaid(run, name) else self.absent
                    kept.setdefault(name, []).append(scene)
                continue
            scale = case.units.size(quantity.unit)
            named = any(re.search(rf"\b{name}\b", run.warnings.get(w, "")) for w in NAMING)
            self._number(case, name, quantity.value / scale, quantity.uncertainty / scale, reference,
                         named or any(w in run.warnings for w in self.of_all))  # fmt: skip
        for column, curve in exact.curves.items():
            places, values, radii = (np.asarray(run.curve[one]) for one in (curve.of, column, "contact_radius"))
            right = curve.values(places)
            off = np.abs(values - right)[(radii >= curve.narrowest) & ~np.isnan(right)] / curve.scale
            self.along[column][scene] = off.max() if off.size else math.nan

    def _number(
        self, case: Case, name: str, value: float, uncertainty: float, reference: float, named: bool = True
    ) -> None:
        """A number beside its reference; a last value is far from it by the largest."""
        exact, tolerance = case.expected, case.scene.get("accuracy", {}).get("tolerance", 1e-3)
        slack = exact.pressure_error if name.startswith("p(r)") or name.endswith("pressure") else exact.error
        most = exact.largest.get(name, exact.numbers.get(f"peak_{name}", 0.0))
        if math.isinf(reference):
            over = far = math.inf
        else:
            whole = abs(reference)
            if name == "dissipated_energy":  # the difference of two works
                whole = max(whole, exact.numbers.get("peak_force", 0.0) * exact.numbers.get("peak_displacement", 0.0))
            error = max(0.0, abs(value - reference) - slack * whole)
            over = over_uncertainty(error, uncertainty)
            far = error / max(abs(reference), most) / tolerance if reference else 0.0
        wide = uncertainty / (max(abs(value), most) * tolerance) if value and reference else 0.0
        self.numbers.append(
            Number(case.name, case.group, case.words, name, value, uncertainty, reference, over, far, wide, named)
        )

    def _pressures(self, case: Case, said: Run) -> None:
        """Some points of p(r) of each state that has one; it must have a ± of its own."""
        columns, exact = said.body_pressures, case.expected
        length, stress = map(case.units.size, ("m", "Pa"))
        for state, pressure in exact.pressures.items():
            name = f"p(r) {state}"
            if state not in columns:
                self.absent.setdefault(name, []).append(case.name)
                continue
            radii, values, errors = (columns[state][key] for key in ("r", "pressure", "pressure_uncertainty"))
            scale = abs(pressure(0.5 * radii[-1] / length))
            for i in sorted({round(part * (radii.size - 1)) for part in POINTS}):
                reference = pressure(radii[i] / length)
                if math.isfinite(reference):
                    # Where a pressure crosses 0, its reference is as exact as it is in the middle.
                    slack = max(0.0, scale - abs(reference)) * exact.pressure_error
                    self._number(case, name, values[i] / stress, errors[i] / stress + slack, reference)

    @property
    def outside(self) -> list[Number]:
        """Numbers that are off by more than their uncertainty."""
        return sorted((n for n in self.numbers if not n.over <= 1.0), key=lambda n: -n.over)

    @property
    def unnamed(self) -> list[Number]:
        """Numbers that are, or may be, beyond the tolerance, and that no warning names."""
        return [n for n in self.numbers if (n.wide > 1.0 + 1e-6 or n.far > 1.0) and not n.named]

    def rows(self, words: str, source: str, outside: float = 0.0) -> list[Row]:
        """Rows of chosen scenes; of random ones, of which a share may be outside and refused, and none by far.

        The worst claim; numbers beyond the tolerance that no warning names; those that are missing without a word or
        stand for what is infinite; refusals.
        """
        real = [n for n in self.numbers if math.isfinite(n.reference)]
        unnamed = [n.label for n in self.unnamed if math.isfinite(n.reference)]
        wrong = [n.label for n in self.numbers if math.isinf(n.reference)]
        wrong += [f"{name}: {scene}" for name, scenes in self.silent.items() for scene in scenes]
        first = max(real, key=lambda n: n.over, default=None)
        label = f"{first.label}, {first.words}" if first else ""

        def row(what: str, value: float, most: float, said: str) -> Row:
            return at_most(f"{words}: {what}", value, most, source, said[:LONGEST] or "–")

        found = [
            row(f"worst of {len(real)} errors over the uncertainty", worst([n.over for n in real]),
                FARTHEST if outside else 1.0, label),
            row("numbers beyond the tolerance that no warning names", len(unnamed), 0.0, ", ".join(unnamed)),
            row("numbers without a bound that are reported, or missing without a word", len(wrong), 0.0,
                ", ".join(wrong)),
        ]  # fmt: skip
        if outside:
            groups = ", ".join(f"{n} {group}" for group, n in sorted(self.scenes.items()))
            name = f"share of the numbers of {groups} outside of their uncertainty"
            found.append(row(name, len(self.outside) / max(1, len(self.numbers)), outside, label))
        share = len(self.refused) / sum(self.scenes.values())
        return [
            *found[not real :],
            row("share of scenes refused", share, outside, next(iter(self.refused.values()), "")),
        ]

    def near(
        self, words: str, name: str, bound: float, source: str, error: Callable[[Number], float] = relative
    ) -> Row:
        """A row of the largest error of a number, relative if not otherwise; one that is missing fails."""
        off = {n.words: error(n) for n in self.numbers if n.name == name}
        off |= dict.fromkeys([*self.silent.get(name, []), *self.refused.values()], math.nan)
        return _farthest(f"{words}: {name}", off, bound, source)

    def curve(self, words: str, column: str, bound: float, source: str, over: str = "its largest") -> Row:
        """A row of the largest error of a column."""
        off = self.along[column]
        return _farthest(f"{words}: {column} along {len(off)} curves over {over}", off, bound, source)


def unsaid(run: Run, name: str) -> bool:
    """Whether a number is missing whose absence neither the documentation nor a warning states."""
    names = name, *FOLLOWS.get(name, ())
    words = [one.replace("_", "[_ ]") for one in names]
    told = any(re.search(rf"\b{one}\b", run.warnings.get(gone, "")) for gone in GONE for one in words)
    return name not in run.results and name not in OPTIONAL and not told


def _farthest(name: str, off: Mapping[str, float], bound: float, source: str) -> Row:
    """A row of the largest of some errors, one of which is NaN where there is no number."""
    largest = max(off, key=lambda one: off[one] if math.isfinite(off[one]) else math.inf, default="–")
    return at_most(name, worst([*off.values()]), bound, source, largest[:LONGEST])


def judged(bench: Bench, cases: Iterable[Case]) -> dict[str, Judge]:
    """Run and judge, group by group in their order."""
    found: dict[str, Judge] = {}
    for case in cases:
        found.setdefault(case.group, Judge()).add(case, case.run(bench))
    return found


def rows_of(judges: Mapping[str, Judge], source: str) -> list[Row]:
    """Rows of each group."""
    return [row for words, judge in judges.items() for row in judge.rows(words, source)]
