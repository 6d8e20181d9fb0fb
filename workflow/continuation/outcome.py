"""The outcome of an experiment: results with their error budgets, the curve, profiles, the schedule, and warnings.

Units are those of the model: LU, FU, MU, TU.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import reduce
from math import inf, nan
from typing import Any

import numpy as np

from contact1d.analysis.pressure import Array, Profile
from contact1d.digits import digits_apart
from contact1d.workflow.continuation.state import State
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import Quantity

SOURCES = ("solver", "sampling", "discretisation", "time", "instability", "statistics", "input", "model")
"""Sources of errors. "input": uncertain numbers of the scene, and results that a quantity is computed from; "model":
two evaluations of one quantity."""
LATTICE = "discretisation"
LOSSES = ("dissipated_energy", "instability_energy")
"""First words of the names of energies that may be 0, whose scale is the energy itself."""
MODEL = "model"
Made = dict[str, tuple[Quantity, float]]
"""Results that are computed from others, by name, and the uncertainty that uncertain numbers of the scene add."""


@dataclass(frozen=True)
class Reading:
    """A value with the errors that its reader determines, by source.

    Attributes:
        value: in `unit`.
        unit: of the model, as "FU" or "FU·LU"; "1" for a number.
        errors: by source, in `unit`.
        scale: in `unit`, what the uncertainty is compared with, where the value may be 0; None: the value itself.
        prescribed: whether the scene prescribes it.
    """

    value: float
    unit: str
    errors: Mapping[str, float] = field(default_factory=dict)
    scale: float | None = None
    prescribed: bool = False

    @property
    def size(self) -> float:
        """What the uncertainty is compared with, in `unit`: `scale` where that is given, else |value|; may be 0."""
        return abs(self.value) if self.scale is None else self.scale


@dataclass(frozen=True)
class Result(Reading):
    """A number with all its errors by source; the uncertainty is their sum, at a coverage of 95 % at least.

    Errors have the names of SOURCES. What the scene prescribes, and what closes a balance, has no required tolerance.

    Attributes:
        read: part of the discretisation error by interpolation between particles, whatever the settings, in `unit`.
        given: part of "input" by numbers with ± and a noisy profile, in `unit`: of the scene, and no error of the
            program.
    """

    read: float = 0.0
    given: float = 0.0

    def __post_init__(self) -> None:
        """Raise ValueError for a result without errors, or with an error from a source that is not in SOURCES."""
        if not self.errors or set(self.errors) - set(SOURCES):
            raise ValueError(f"a result needs errors by source ({', '.join(SOURCES)}), got {dict(self.errors)}")

    @property
    def uncertainty(self) -> float:
        """The sum of the errors of all sources, in `unit`."""
        return float(sum(self.errors.values()))

    @property
    def share(self) -> float:
        """The relative uncertainty: the sum of errors over `scale`, or |value| without one; infinite where that is 0.

        It is infinite also where the errors are 0.
        """
        return self.uncertainty / self.size if self.size else inf


@dataclass(frozen=True)
class Agreement:
    """The comparison of two numbers of a run that must agree.

    Attributes:
        difference: of them, relative.
        allowed: how large it may be, relative.
        words: both numbers in a sentence, in units of the model.
    """

    difference: float
    allowed: float
    words: str

    @property
    def holds(self) -> bool:
        """Whether the difference is at most what is allowed; False where either is NaN."""
        return self.difference <= self.allowed


@dataclass(frozen=True)
class Move:
    """An input of a scene at an end of its uncertainty.

    Attributes:
        key: the dotted key of a number, or the name of another input.
        scene: with the input at that end.
        changes: of the results, by name, on the reduced model, in the results' units; of points of a curve (m,).
    """

    key: str
    scene: Scene
    changes: Mapping[str, Any]


def in_squares(moves: Iterable[Move], name: str) -> Any:
    """Return √(Σ change²) ≥ 0 of a result, or of points (m,), in its unit: the uncertainty due to independent inputs.

    Of the moves of one input the largest |change| counts. 0.0 without moves, or where none changes a result of this
    `name`.
    """
    changes = dict[str, Any]()
    for move in moves:
        changes[move.key] = np.maximum(changes.get(move.key, 0.0), np.abs(move.changes.get(name, 0.0)))
    return reduce(np.hypot, changes.values(), 0.0)


@dataclass(frozen=True)
class Refinement:
    """The refinement of a run: the last (relative) tolerance of its settings, how often it fell, why it ended."""

    tolerance: float
    count: int
    ended: str


@dataclass(frozen=True)
class Outcome:
    """The outcome of one experiment, in units of the model.

    Attributes:
        results: by name, each with its unit.
        states: every state that is reported, in order.
        marked: the states that are reported with their profiles, by name.
        phases: the schedule.
        warnings: about what limits the accuracy, by name.
        columns: further columns of curve.csv, by name.
        rows: errors of the points of curve.csv by source, (m,), by the name of a column.
        tables: columns of further files, by the names of the files.
        refinement: None where the settings were given, or are not refined.
        moves: of the uncertain inputs of the scene.
        consistency: agreement of two numbers of the run, by the name of the check, as far as it applies.
    """

    results: Mapping[str, Result]
    states: tuple[State, ...]
    marked: Mapping[str, State]
    phases: tuple[Phase, ...]
    warnings: Mapping[str, str] = field(default_factory=dict)
    columns: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    rows: Mapping[str, Mapping[str, Array]] = field(default_factory=dict)
    tables: Mapping[str, Mapping[str, tuple[float, ...]]] = field(default_factory=dict)
    refinement: Refinement | None = None
    moves: tuple[Move, ...] = ()
    consistency: Mapping[str, Agreement] = field(default_factory=dict)

    @property
    def quantities(self) -> dict[str, Quantity]:
        """The results by name, each with its value and uncertainty in its unit of the model."""
        return {name: Quantity(result.value, result.uncertainty, result.unit) for name, result in self.results.items()}

    @property
    def exact(self) -> dict[str, Quantity]:
        """The results by name, with the uncertainties that they would have if the scene were known exactly.

        These are without the part of "input" by numbers with ± and a noisy profile. Units are those of the model.
        """
        return {
            name: Quantity(result.value, result.uncertainty - result.given, result.unit)
            for name, result in self.results.items()
        }

    def made(self, scene: Scene, make: Callable[[Scene, Mapping[str, Quantity]], dict[str, Quantity]]) -> Made:
        """Return quantities that `make` computes from a scene and its results, by name, and their input uncertainties.

        {name: (quantity, second number)}: the quantity has the uncertainty of an exactly known scene; the second
        number, ≥ 0 in its unit, is due to the uncertain inputs, 0 without any: `make` is called again at each end of
        each of them. A quantity that `make` does not return there has no change.
        """
        exact = self.exact
        made, moves = make(scene, exact), []
        for move in self.moves:
            results = {n: replace(result, value=result.value + move.changes.get(n, 0.0)) for n, result in exact.items()}
            moved = make(move.scene, results)
            changes = {name: moved[name].value - result.value for name, result in made.items() if name in moved}
            moves.append(replace(move, changes=changes))
        return {name: (result, in_squares(moves, name)) for name, result in made.items()}

    def adding(self, **parts: Mapping[str, Any]) -> Outcome:
        """Return a copy with further entries in the `warnings`, `columns`, `tables` or checks of `consistency`."""
        changes: dict[str, Any] = {name: {**getattr(self, name), **entries} for name, entries in parts.items()}
        return replace(self, **changes)

    @property
    def profiles(self) -> dict[str, Profile]:
        """The pressure profiles [FU/LU] over x [LU] of the states that are reported with their profiles, by name."""
        return {name: state.profile for name, state in self.marked.items()}

    @property
    def radii(self) -> dict[str, float]:
        """The contact radius [LU] of each state that is reported with its profile; NaN where bodies do not touch.

        Raises:
            ValueError: a radius cannot be read off a profile.
        """
        return {name: nan if state.radius is None else state.radius.value for name, state in self.marked.items()}


def in_words(shares: Mapping[str, float], tolerance: float) -> str:
    """Return a text of relative uncertainties: "critical_radius 3.1e-04, …", all of `shares` in order; "" for none.

    Each has as many digits, two at least, as show that it differs from the `tolerance`.
    """
    return ", ".join(f"{name} {share:.{digits_apart(share, tolerance, 2) - 1}e}" for name, share in shares.items())


def unmet(results: Mapping[str, Result], tolerance: float, without: Iterable[str] = ()) -> dict[str, float]:
    """Return the relative uncertainties that exceed the tolerance, by name, without the part that the scene gives.

    Left out are prescribed results and those whose scale (|value| without a `scale`) is 0. Of the latter, names that
    end in "radius" stay, with infinity, where they have an error. {} where all are met; in the order of `results`.

    Args:
        results: by name.
        tolerance: relative.
        without: sources of errors that are left out of the uncertainty; of "discretisation" the part by
            interpolation between particles remains.
    """
    shares = {}
    for name, result in results.items():
        kept = sum(error for source, error in result.errors.items() if source not in without) - result.given
        if LATTICE in without:
            kept += result.read
        if not result.prescribed and (result.size or name.endswith("radius")) and kept > tolerance * result.size:
            shares[name] = kept / result.size if result.size else inf
    return shares
