"""An experiment on the reduced model: how its results go with the lattice, with the inputs, and with another body.

Its script drives the model and its reader reads what that has passed, on any spacing, with the apex anywhere between
particles, and of each scene that this one may mean (`budget`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from contact1d.analysis.convergence import extrapolated
from contact1d.analysis.pressure import Profile
from contact1d.workflow.continuation.model_branch import ModelBranch, Script
from contact1d.workflow.continuation.outcome import Move, Reading, in_squares
from contact1d.workflow.continuation.trace import Trace
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.model.reduced import reduced
from contact1d.workflow.model.settings import Settings, settings_for
from contact1d.workflow.scene import Scene, Shape

MARGIN = 1.25
"""Error over the change of the model with the lattice: it has no neighbour springs. Measured on both parities: 1.01."""
FOLLOWED = 0.5
"""Difference of the model from a motion, over the result, beyond which its lattice says nothing of that."""
LEAST_MOVE = 0.05
"""Least relative change of an input that shows what a smaller one does, to first order: readers have errors."""
FEWEST_BODIES = 2
"""Bodies at least that show what the points of a profile leave open."""
WAYS = (-1.0, 1.0)
"""Both ways."""


PRESSURE = "ln p "
"""Before a state's name, among the changes of a move: of the logarithm of p(0), so that it is relative; of the deepest
state without a name."""
Reader = Callable[[Trace], Mapping[str, Reading]]
Values = dict[str, Any]
"""Numbers by name of a result; by name of a column of curve.csv one for each of its rows, (m,)."""


@dataclass(frozen=True)
class Reduction:
    """How results go with the lattice of the model: script and reader of a scene's experiment; `of` another scene.

    Or, of states that were `passed`, how each of them does.
    """

    scene: Scene
    settings: Settings
    script: Script
    read: Reader
    of: Callable[[Scene, Settings], Reduction]
    passed: Trace | None = None

    def along(self, trace: Trace) -> Reduction:
        """The same for each state of a trace; the models are shared."""
        found = replace(self, passed=trace, of=lambda *other: replace(self.of(*other), passed=trace))
        vars(found).update(model=self.model, _lattices=self._lattices)
        return found

    def values(self, model: Particles, dense: int = 1, shift: float = 0.0) -> Values:
        """The results of the model; `shift` of the displacements that the scene gives [LU]."""
        if self.passed:
            return self.passed.again(self.scene, self.settings, model)
        return values_of(self.read(self.trace(model, dense, shift)))

    def trace(self, model: Particles, dense: int = 1, shift: float = 0.0, whole: bool = False) -> Trace:
        """What the script makes of the reduced model."""
        return self.driven(model, dense, shift).trace(whole)

    def driven(self, model: Particles, dense: int = 1, shift: float = 0.0) -> ModelBranch:
        """The reduced model when the script has ended."""
        branch = ModelBranch(self.scene, self.settings, model, dense, shift)
        self.script(branch)
        return branch

    @property
    def is_open(self) -> bool:
        """Whether the scene leaves anything open."""
        profile = self.scene.bodies.profile
        return bool(self.scene.shares or profile.deviations or profile.alternatives)

    @cached_property
    def model(self) -> Particles:
        """The model of the chain that runs."""
        return reduced(self.scene, self.settings)

    @cached_property
    def path(self) -> Trace:
        """What the script makes of it."""
        return self._driven.trace()

    @cached_property
    def _driven(self) -> ModelBranch:
        return self.driven(self.model)

    @cached_property
    def readings(self) -> Mapping[str, Reading]:
        """What is read of that."""
        return self.read(self.path)

    @cached_property
    def own(self) -> Values:
        """Its results."""
        return self.values(self.model) if self.passed else values_of(self.readings)

    @cached_property
    def seen(self) -> Values:
        """`own`, and where springs are not linear what the pressures of its states go with."""
        if self.passed or self.scene.keeps_springs:
            return self.own
        whole = self._driven.trace(whole=True)
        states = {name: i for i, names in self._driven.marks.items() for name in names}
        states[""] = int(whole.displacement.argmax())
        found = {PRESSURE + name: _on_axis(whole.profile(i)) for name, i in states.items()}
        return self.own | {name: math.log(one) for name, one in found.items() if one > 0.0}

    def followed(self, values: Values) -> Values:
        """`lattice` of results in time; where the model does not follow the motion, by how much they differ."""
        off = {name: np.abs(values[name] - self.own.get(name, 0.0)) for name in values.keys() & self.lattice.keys()}
        return {
            name: np.maximum(self.lattice[name], one * (one > FOLLOWED * np.abs(values[name])))
            for name, one in off.items()
        }

    @cached_property
    def _lattices(self) -> tuple[list[Particles], list[Particles]]:
        """The model with its particles elsewhere, and on finer spacings."""
        bodies = self.scene.bodies
        is_chosen = bodies.particles == "auto" and bodies.own_count is None  # else positions are part of the scene
        if not (is_chosen or self.model.shares_edges):
            return [], []
        is_pointed = bodies.profile.curvature_radius is None and not bodies.profile.has_edge
        return self.model.lattices(is_pointed)

    @cached_property
    def lattice(self) -> Values:
        """By name of a result, its discretisation error; a result that another lattice does not have may be 0."""
        beside, finer = self._lattices
        if not (beside or finer):
            return {}
        found = self._apart(beside)
        if finer:
            others = [self.values(model) for model in finer]
            for name, value in self.own.items():
                found[name] = np.maximum(found[name], extrapolated(value, *(one.get(name, 0.0) for one in others)))
        return {name: MARGIN * error for name, error in found.items()}

    @cached_property
    def moves(self) -> tuple[Move, ...]:
        """Of the scene, each number with ± moved both ways; of each pair of bodies half of their difference.

        So of a number, too, that moves so little that its results are read off no better: it is moved further.
        """
        scene, moves = self.scene, list[Move]()
        for key, share in scene.shares.items():
            ends, times = [scene.moved(key, 1.0 + way * share) for way in WAYS], max(1.0, LEAST_MOVE / share)
            try:
                both = [self._of(scene.moved(key, 1.0 + way * times * share)) for way in WAYS]
            except SettingsError:
                times, both = 1.0, [self._of(end) for end in ends]
            moves += self._changes(key, ends, both, times, apart=times > 1.0)
        for number, pair in enumerate(scene.bodies.profile.deviations, 1):
            ends = [scene.with_profile(shape) for shape in pair]
            try:
                both = [self._of(end) for end in ends]
            except SettingsError:  # one of them is no contact
                continue
            moves += self._changes(f"bodies.profile: deviation {number}", ends, both, 1.0, apart=True)
        return tuple(moves)

    def _changes(
        self, key: str, ends: Sequence[Scene], both: Sequence[Values], times: float, apart: bool
    ) -> list[Move]:
        """What an input does at its ends, from results so many times as far; `apart`: half of their difference."""
        found = []
        for end, one, other in zip(ends, both, both[::-1], strict=True):
            middle = {n: 0.5 * (one[n] + other[n]) for n in one.keys() & other.keys()} if apart else self.seen
            shared = self.seen.keys() & middle.keys()
            changes = {name: (one.get(name, middle[name]) - middle[name]) / times for name in shared}
            found.append(Move(key, end, changes))
        return found

    def _of(self, scene: Scene) -> Values:
        """The results of the model of another scene."""
        return self.of(scene, settings_for(scene, self.settings.tolerance)).seen

    @cached_property
    def inputs(self) -> Values:
        """By name of a result, what the scene leaves open: independent changes in squares, and other bodies in sum.

        Raises:
            SettingsError: most curves through the points of a profile are no contact, so that nothing tells the error.
        """
        profile = self.scene.bodies.profile
        others = [model for shape in profile.alternatives if (model := self._of_shape(shape))]
        if len(others) < len(profile.alternatives):
            others += [model for shape in profile.coarser if (model := self._of_shape(shape))]
        if len(others) < min(FEWEST_BODIES, len(profile.alternatives)):
            raise SettingsError(
                "the points of bodies.profile allow a corner at which the contact edge would jump, and too few other "
                "curves through them are a contact to tell the uncertainty: give more points where the slope changes"
            )
        each = [self._apart([other]) for other in others]
        return {name: sum(one[name] for one in each) + in_squares(self.moves, name) for name in self.own}

    def _of_shape(self, shape: Shape) -> Particles | None:
        """The model of another body; None of one that is no contact, as where its edge would jump at a corner."""
        scene = self.scene.with_profile(shape)
        try:
            return reduced(scene, replace(self.settings, law=settings_for(scene).law))
        except SettingsError:
            return None

    def _apart(self, models: Sequence[Particles]) -> Values:
        """How far results of other models are off, at most."""
        found = {name: np.zeros_like(value) for name, value in self.own.items()}
        for one in map(self.values, models):
            for name, value in self.own.items():
                found[name] = np.maximum(found[name], np.abs(one.get(name, 0.0) - value))
        return found


def values_of(readings: Mapping[str, Reading]) -> Values:
    """Numbers of a reading."""
    return {name: one.value for name, one in readings.items()}


def _on_axis(profile: Profile) -> float:
    """p(0) but for a factor, ∫ −dq/x from the first particle on."""
    x, q = profile.x[profile.x > 0.0], profile.pressure[profile.x > 0.0]
    return -float(np.sum(np.diff(q) / (x[1:] + x[:-1])))
