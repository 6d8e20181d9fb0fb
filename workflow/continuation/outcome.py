"""The outcome of an experiment: results with their error budgets, the curve, profiles, the schedule, and warnings."""

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
"""What an error may come from. "input": what the scene leaves open, and results that a number is made of; "model": two
readings of one quantity."""
LATTICE = "discretisation"
LOSSES = ("dissipated_energy", "instability_energy")
"""Results that begin so are energies that may be 0, and are compared with themselves alone."""
MODEL = "model"
Made = dict[str, tuple[Quantity, float]]
"""Results that are made of others, by name: as uncertain as these, and what uncertain numbers of the scene add."""


@dataclass(frozen=True)
class Reading:
    """A value with the errors that its reader determines, by source.

    Attributes:
        value: in `unit`.
        unit: of the model.
        errors: by source.
        scale: what the uncertainty is compared with, where the value may be 0.
        prescribed: whether the scene prescribes it.
    """

    value: float
    unit: str
    errors: Mapping[str, float] = field(default_factory=dict)
    scale: float | None = None
    prescribed: bool = False


@dataclass(frozen=True)
class Result:
    """A number with its errors by source; the uncertainty is their sum, at a coverage of 95 % at least.

    Attributes:
        value: in `unit`.
        unit: of the model.
        errors: by the names of SOURCES, in `unit`.
        scale: what the uncertainty is compared with, where the value may be 0.
        prescribed: whether the scene prescribes it, or it closes a balance: no tolerance is asked of it.
        read: part of the discretisation error that is left by reading between particles, whatever the settings.
        given: part of "input" by numbers with ± and a noisy profile: what the scene says, and no error of the program.
    """

    value: float
    unit: str
    errors: Mapping[str, float]
    scale: float | None = None
    prescribed: bool = False
    read: float = 0.0
    given: float = 0.0

    def __post_init__(self) -> None:
        """Refuse a number without a budget."""
        if not self.errors or set(self.errors) - set(SOURCES):
            raise ValueError(f"a result needs errors by source ({', '.join(SOURCES)}), got {dict(self.errors)}")

    @property
    def uncertainty(self) -> float:
        """Sum of the errors."""
        return float(sum(self.errors.values()))

    @property
    def size(self) -> float:
        """What the uncertainty is compared with."""
        return abs(self.value) if self.scale is None else self.scale

    @property
    def share(self) -> float:
        """Uncertainty over the size; infinite for a length that may be 0."""
        return self.uncertainty / self.size if self.size else inf


@dataclass(frozen=True)
class Agreement:
    """Two numbers of a run that must be one.

    Attributes:
        difference: of them, relative.
        allowed: how large it may be.
        words: both numbers, in units of the model.
    """

    difference: float
    allowed: float
    words: str

    @property
    def holds(self) -> bool:
        """Whether they are; a number that is none never agrees."""
        return self.difference <= self.allowed


@dataclass(frozen=True)
class Move:
    """An input of a scene at an end of what it may be.

    Attributes:
        key: the dotted key of a number, or what else is moved.
        scene: with it there.
        changes: of the results, by name, on the reduced model, in their units; of rows (m,).
    """

    key: str
    scene: Scene
    changes: Mapping[str, Any]


def in_squares(moves: Iterable[Move], name: str) -> Any:
    """√(Σ change²) of a result, or of rows, over independent inputs, of each the larger change of the two ways."""
    found = dict[str, Any]()
    for move in moves:
        found[move.key] = np.maximum(found.get(move.key, 0.0), np.abs(move.changes.get(name, 0.0)))
    return reduce(np.hypot, found.values(), 0.0)


@dataclass(frozen=True)
class Refinement:
    """How a run was refined: the tolerance of its settings in the end, how often that was lowered, why not further."""

    tolerance: float
    count: int
    ended: str


@dataclass(frozen=True)
class Outcome:
    """The outcome of one experiment.

    Attributes:
        results: by the names of the contract.
        states: every state that is reported, in order.
        marked: the states that are reported with their profiles, by name.
        phases: the schedule.
        warnings: by name, what limits the trust in the numbers.
        columns: further columns of curve.csv.
        rows: of columns of curve.csv, by name, the errors of each row by source, (m,).
        tables: columns of further files, by the names of these.
        refinement: None where the settings were given, or are not refined.
        moves: what the scene leaves open.
        consistency: whether the run contradicts itself, by the name of the check; without one that says nothing here.
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
        """Results, each with its uncertainty and unit."""
        return {name: Quantity(one.value, one.uncertainty, one.unit) for name, one in self.results.items()}

    @property
    def exact(self) -> dict[str, Quantity]:
        """The same, as if the scene were known exactly."""
        own = self.results
        return {n: replace(one, uncertainty=one.uncertainty - own[n].given) for n, one in self.quantities.items()}

    def made(self, scene: Scene, make: Callable[[Scene, Mapping[str, Quantity]], dict[str, Quantity]]) -> Made:
        """What is made of a scene and its results, by name, and how inputs change it: made anew at their ends."""
        made, moves = make(scene, self.exact), []
        for move in self.moves:
            at = {n: replace(one, value=one.value + move.changes.get(n, 0.0)) for n, one in self.exact.items()}
            there = make(move.scene, at)
            changes = {name: there[name].value - one.value for name, one in made.items() if name in there}
            moves.append(replace(move, changes=changes))
        return {name: (one, in_squares(moves, name)) for name, one in made.items()}

    @property
    def profiles(self) -> dict[str, Profile]:
        """Profiles of the marked states."""
        return {name: state.profile for name, state in self.marked.items()}

    @property
    def radii(self) -> dict[str, float]:
        """Contact radius of each marked state [LU]; NaN where there is none."""
        return {name: nan if state.radius is None else state.radius.value for name, state in self.marked.items()}


def in_words(shares: Mapping[str, float], tolerance: float) -> str:
    """Relative uncertainties above the tolerance by name: "critical_radius 3.1e-04"."""
    return ", ".join(f"{name} {share:.{digits_apart(share, tolerance, 2) - 1}e}" for name, share in shares.items())


def unmet(results: Mapping[str, Result], tolerance: float, without: Iterable[str] = ()) -> dict[str, float]:
    """Relative uncertainties of the results that exceed the tolerance, by name; what the scene leaves open is none.

    Args:
        results: without those that the scene prescribes.
        tolerance: relative.
        without: sources that are left out.
    """
    found = {}
    for name, one in results.items():
        kept = sum(error for source, error in one.errors.items() if source not in without) - one.given
        if LATTICE in without:
            kept += one.read
        if not one.prescribed and (one.size or name.endswith("radius")) and kept > tolerance * one.size:
            found[name] = kept / one.size if one.size else inf
    return found
