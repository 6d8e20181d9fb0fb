"""An experiment on the reduced model: how its results change with the lattice, with the inputs, and with the body.

Its script drives the model and its reader evaluates the trace, on any spacing, with the apex anywhere between
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
SIGNS = (-1.0, 1.0)
"""The two directions of a perturbation."""


PRESSURE = "ln p "
"""Prefix of the name of a state: its value is the logarithm of p(0), whose change is relative. Alone it is that of the
deepest state."""
Reader = Callable[[Trace], Mapping[str, Reading]]
Values = dict[str, Any]
"""Numbers by name of a result; by name of a column of curve.csv those of its points, (m,)."""


@dataclass(frozen=True)
class Reduction:
    """The experiment of a scene on the reduced model: script and reader; `of` makes that of another scene.

    With the `passed` states of a trace, it has a value for each state instead of results.
    """

    scene: Scene
    settings: Settings
    script: Script
    read: Reader
    of: Callable[[Scene, Settings], Reduction]
    passed: Trace | None = None

    def along(self, trace: Trace) -> Reduction:
        """Return the reduction for each state of a trace, with the models of this one."""
        reduction = replace(self, passed=trace, of=lambda *case: replace(self.of(*case), passed=trace))
        vars(reduction).update(model=self.model, _lattices=self._lattices)
        return reduction

    def values(self, model: Particles, dense: int = 1, shift: float = 0.0) -> Values:
        """Return the results of a model; `shift` is added to the displacements that the scene gives [LU]."""
        if self.passed:
            return self.passed.recomputed(self.scene, self.settings, model)
        return values_of(self.read(self.trace(model, dense, shift)))

    def trace(self, model: Particles, dense: int = 1, shift: float = 0.0, whole: bool = False) -> Trace:
        """Return the trace of a model that the script has driven."""
        return self.driven(model, dense, shift).trace(whole)

    def driven(self, model: Particles, dense: int = 1, shift: float = 0.0) -> ModelBranch:
        """Return the branch of a model that the script has driven, at the end of the script."""
        branch = ModelBranch(self.scene, self.settings, model, dense, shift)
        self.script(branch)
        return branch

    @property
    def has_uncertain_inputs(self) -> bool:
        """Whether the scene has uncertain inputs."""
        profile = self.scene.bodies.profile
        return bool(self.scene.shares or profile.deviations or profile.alternatives)

    @cached_property
    def model(self) -> Particles:
        """The particles of the model, those of the chain that runs in LAMMPS."""
        return reduced(self.scene, self.settings)

    @cached_property
    def path(self) -> Trace:
        """The trace of the model that the script has driven."""
        return self._driven.trace()

    @cached_property
    def _driven(self) -> ModelBranch:
        return self.driven(self.model)

    @cached_property
    def readings(self) -> Mapping[str, Reading]:
        """The readings of the trace of the model."""
        return self.read(self.path)

    @cached_property
    def results(self) -> Values:
        """The results of the model, by name."""
        return self.values(self.model) if self.passed else values_of(self.readings)

    @cached_property
    def results_and_pressures(self) -> Values:
        """The results, and where springs are not linear the logarithms of the pressures of reported states."""
        if self.passed or self.scene.keeps_springs:
            return self.results
        whole = self._driven.trace(whole=True)
        states = {name: i for i, names in self._driven.marks.items() for name in names}
        states[""] = int(whole.displacement.argmax())
        pressures = {PRESSURE + name: _on_axis(whole.profile(i)) for name, i in states.items()}
        return self.results | {name: math.log(pressure) for name, pressure in pressures.items() if pressure > 0.0}

    def lattice_in_time(self, values: Values, share: float = 0.5) -> Values:
        """Return the discretisation error of results in time, by name.

        Where the model differs from the motion by more than a share of the value, it is that difference at least.
        """
        names = values.keys() & self.lattice.keys()
        off = {name: np.abs(values[name] - self.results.get(name, 0.0)) for name in names}
        return {
            name: np.maximum(self.lattice[name], difference * (difference > share * np.abs(values[name])))
            for name, difference in off.items()
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
        """The discretisation error of each result, by name; a result that another lattice does not have may be 0."""
        shifted, finer = self._lattices
        if not (shifted or finer):
            return {}
        errors = self._largest_changes(shifted)
        if finer:
            results = [self.values(model) for model in finer]
            for name, value in self.results.items():
                change = extrapolated(value, *(values.get(name, 0.0) for values in results))
                errors[name] = np.maximum(errors[name], change)
        return {name: MARGIN * error for name, error in errors.items()}

    @cached_property
    def moves(self) -> tuple[Move, ...]:
        """The moves of each number with ± to both ends, and of each pair of bodies half of their difference.

        A number with ± below 5 % is moved by 5 %, since the reader has errors; of its changes, scaled to first order,
        half of the difference counts as well.
        """
        scene, moves = self.scene, list[Move]()
        for key, share in scene.shares.items():
            ends, times = [scene.moved(key, 1.0 + sign * share) for sign in SIGNS], max(1.0, 0.05 / share)
            try:
                results = [self._results_of(scene.moved(key, 1.0 + sign * times * share)) for sign in SIGNS]
            except SettingsError:
                times, results = 1.0, [self._results_of(end) for end in ends]
            moves += self._changes(key, ends, results, times, apart=times > 1.0)
        for number, pair in enumerate(scene.bodies.profile.deviations, 1):
            ends = [scene.with_profile(shape) for shape in pair]
            try:
                results = [self._results_of(end) for end in ends]
            except SettingsError:  # a body that is no contact
                continue
            moves += self._changes(f"bodies.profile: deviation {number}", ends, results, 1.0, apart=True)
        return tuple(moves)

    def _changes(
        self, key: str, ends: Sequence[Scene], results: Sequence[Values], times: float, apart: bool
    ) -> list[Move]:
        """Return the moves of an input to its ends, from results `times` as far; `apart`: half of their difference."""
        moves = []
        for end, values, opposite in zip(ends, results, results[::-1], strict=True):
            middle = self.results_and_pressures
            if apart:
                middle = {name: 0.5 * (values[name] + opposite[name]) for name in values.keys() & opposite.keys()}
            shared = self.results_and_pressures.keys() & middle.keys()
            changes = {name: (values.get(name, middle[name]) - middle[name]) / times for name in shared}
            moves.append(Move(key, end, changes))
        return moves

    def _results_of(self, scene: Scene) -> Values:
        """Return the results of the model of another scene."""
        return self.of(scene, settings_for(scene, self.settings.tolerance)).results_and_pressures

    @cached_property
    def inputs(self) -> Values:
        """The uncertainty due to the inputs, by name: independent changes in squares, plus those of other bodies.

        Raises:
            SettingsError: most curves through the points of a profile are no contact, so that no error is known.
        """
        profile = self.scene.bodies.profile
        models = [model for shape in profile.alternatives if (model := self._model_of(shape))]
        if len(models) < len(profile.alternatives):
            models += [model for shape in profile.coarser if (model := self._model_of(shape))]
        if len(models) < min(2, len(profile.alternatives)):
            raise SettingsError(
                "the points of bodies.profile allow a corner at which the contact edge would jump, and too few other "
                "curves through them are a contact to tell the uncertainty: give more points where the slope changes"
            )
        changes = [self._largest_changes([model]) for model in models]
        return {name: sum(change[name] for change in changes) + in_squares(self.moves, name) for name in self.results}

    def _model_of(self, shape: Shape) -> Particles | None:
        """Return the model of another body; None where it is no contact, as with a jump of its edge at a corner."""
        scene = self.scene.with_profile(shape)
        try:
            return reduced(scene, replace(self.settings, law=settings_for(scene).law))
        except SettingsError:
            return None

    def _largest_changes(self, models: Sequence[Particles]) -> Values:
        """Return the largest difference of each result of other models from that of the model, by name."""
        largest = {name: np.zeros_like(value) for name, value in self.results.items()}
        for values in map(self.values, models):
            for name, value in self.results.items():
                largest[name] = np.maximum(largest[name], np.abs(values.get(name, 0.0) - value))
        return largest


def values_of(readings: Mapping[str, Reading]) -> Values:
    """Return the values of readings, by name."""
    return {name: reading.value for name, reading in readings.items()}


def _on_axis(profile: Profile) -> float:
    """Return p(0) without a constant factor, ∫ −dq/x from the first particle on."""
    x, q = profile.x[profile.x > 0.0], profile.pressure[profile.x > 0.0]
    return -float(np.sum(np.diff(q) / (x[1:] + x[:-1])))
