"""An experiment on the reduced model: how its results change with the lattice, with the inputs, and with the body.

Its script drives the model and its reader evaluates the trace, on any spacing, with the apex anywhere between
particles, and of each scene that this one may mean (`budget`).

A lattice is the spacing of the particles and the position of the apex between them.
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
    """The experiment of a scene on the reduced model: script and reader.

    Attributes:
        scene: whose experiment it is.
        settings: numbers of the run.
        script: moves the contact.
        read: reader of a trace: results by name.
        of: function of another scene and its settings that returns the reduction of that scene.
        passed: a trace, for whose states the reduction has values, (m,) by column, instead of results; None: results.
    """

    scene: Scene
    settings: Settings
    script: Script
    read: Reader
    of: Callable[[Scene, Settings], Reduction]
    passed: Trace | None = None

    def along(self, trace: Trace) -> Reduction:
        """Return a copy whose results are values for each state of a trace, (m,) by column, on the model of this one.

        Columns are "force" [FU] or "displacement" [LU], those that are not prescribed. Model and lattices of this one
        are shared; copies for other scenes have values for the same states.
        """
        reduction = replace(self, passed=trace, of=lambda *case: replace(self.of(*case), passed=trace))
        vars(reduction).update(model=self.model, _lattices=self._lattices)
        return reduction

    def values(self, model: Particles, dense: int = 1, shift: float = 0.0) -> Values:
        """Return the results of a model by name, in their units, or with `passed` states columns (m,) by name.

        The columns are those not prescribed, "force" [FU] or "displacement" [LU], recomputed for these states. `dense`:
        positions for each step that the scene gives; `shift`: added to the displacements that it gives [LU]; both are
        ignored with `passed` states.
        """
        if self.passed:
            return self.passed.recomputed(self.scene, self.settings, model)
        return values_of(self.read(self.trace(model, dense, shift)))

    def trace(self, model: Particles, dense: int = 1, shift: float = 0.0, whole: bool = False) -> Trace:
        """Return the states of a model along the whole experiment, by `script`, as a trace.

        `dense`: positions for each step that the scene gives; `shift`: added to the displacements that it gives [LU];
        `whole`: whether states before the first one of the scene are in it.
        """
        return self.driven(model, dense, shift).trace(whole)

    def driven(self, model: Particles, dense: int = 1, shift: float = 0.0) -> ModelBranch:
        """Return a new branch of states of a model that has gone through the whole experiment, by `script`.

        `dense`: positions for each step that the scene gives; `shift`: added to the displacements that it gives [LU].
        """
        branch = ModelBranch(self.scene, self.settings, model, dense, shift)
        self.script(branch)
        return branch

    @cached_property
    def model(self) -> Particles:
        """The particles of the reduced model, without their neighbours, on the spacing of the chain; cached."""
        return reduced(self.scene, self.settings)

    @cached_property
    def path(self) -> Trace:
        """The states of the model along the whole experiment, with the scene's own steps; cached.

        States before the first one of the scene are left out.
        """
        return self._driven.trace()

    @cached_property
    def _driven(self) -> ModelBranch:
        """The branch of states of the model through the whole experiment, with the scene's own steps; cached."""
        return self.driven(self.model)

    @cached_property
    def readings(self) -> Mapping[str, Reading]:
        """The results of the reduced model, with the errors that their reader determines, by name; cached."""
        return self.read(self.path)

    @cached_property
    def results(self) -> Values:
        """The results of the model by name, each in its own unit; of `passed` states the columns, (m,); cached."""
        return self.values(self.model) if self.passed else values_of(self.readings)

    @cached_property
    def results_and_pressures(self) -> Values:
        """The results by name, and with [neighbours], [viscoelasticity] or [noise] ln p(0) of marked states; cached.

        p(0) is the pressure on the axis [FU/LU²] but for a constant factor. The names of the logarithms are "ln p " and
        that of the state, "ln p " alone for the deepest state; one without pressure on the axis is left out. With
        `passed` states only the columns, (m,).
        """
        if self.passed or self.scene.keeps_springs:
            return self.results
        whole = self._driven.trace(whole=True)
        states = {name: i for i, names in self._driven.marks.items() for name in names}
        states[""] = int(whole.displacement.argmax())
        pressures = {PRESSURE + name: _on_axis(whole.profile(i)) for name, i in states.items()}
        return self.results | {name: math.log(pressure) for name, pressure in pressures.items() if pressure > 0.0}

    def lattice_in_time(self, values: Values, share: float = 0.5) -> Values:
        """Return the discretisation error ≥ 0 of the results `values` of a motion, by name in their units.

        It is that of the reduced model for each name that this has, too; other names are left out. Where the model
        differs from the motion by more than `share` of the value, it is that difference at least.
        """
        names = values.keys() & self.lattice.keys()
        off = {name: np.abs(values[name] - self.results.get(name, 0.0)) for name in names}
        return {
            name: np.maximum(self.lattice[name], difference * (difference > share * np.abs(values[name])))
            for name, difference in off.items()
        }

    @cached_property
    def _lattices(self) -> tuple[list[Particles], list[Particles]]:
        """Models of the same body: (with particles elsewhere or on other spacings, on finer spacings); cached.

        The finer spacings are a half and a quarter, of an adhesive contact on a rigid plane and of a body with
        dashpots; of others there are none. Both lists are empty for these others where the scene gives the particles.
        """
        bodies = self.scene.bodies
        is_chosen = bodies.particles == "auto" and not bodies.profile.is_plane  # else positions are part of the scene
        if not (is_chosen or self.model.shares_edges):
            return [], []
        is_pointed = bodies.profile.curvature_radius is None and not bodies.profile.has_edge
        return self.model.lattices(is_pointed, bodies.profile.has_edge)

    @cached_property
    def lattice(self) -> Values:
        """The discretisation error ≥ 0 of each result, by name in its unit; cached.

        {} where the scene gives the particles, except of an adhesive contact on a rigid plane and of a body with
        dashpots. It is 1.25 times the largest |change| with other positions of the particles, or times the error that a
        half and a quarter of the spacing show where that is larger. A result that another lattice does not have counts
        as 0 there. With `passed` states, by column (m,).
        """
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
        """Two moves, to both ends, of each number with ±, then of each deviation of the profile, a pair of bodies.

        Changes are those of the results on the reduced model, from the mean of both ends; cached. A number with a
        relative ± below 5 % is moved by 5 %, since the reader has errors, and its changes are scaled back to first
        order. From 5 % on, and where the wider move is no contact, changes are from the scene itself. A deviation of
        which one body is no contact is left out. () where nothing is uncertain. With `passed` states, changes are by
        column, (m,).

        Raises:
            SettingsError: an end of a number with ± is no contact.
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
        """Return two moves of an input, to its two ends, with the changes of results over `times`, by name.

        Changes are in the results' units. Only results that the scene itself has are in it, where `apart` those that
        both ends have; one that is missing at an end has not changed there.

        Args:
            key: of the input.
            ends: the scenes at both ends.
            results: at both ends, moved `times` as far.
            times: factor on the uncertainty of the input.
            apart: whether changes are from the mean of both ends, and not from the scene itself.
        """
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
        """Return the results of the model of another scene by name, in their units.

        With [neighbours], [viscoelasticity] or [noise] they include logarithms of pressures on the axis. With `passed`
        states they are columns (m,).

        Raises:
            SettingsError: the scene is no contact.
        """
        return self.of(scene, settings_for(scene, self.settings.tolerance)).results_and_pressures

    @cached_property
    def inputs(self) -> Values:
        """The uncertainty ≥ 0 due to the inputs, by name in the result's unit; cached.

        Numbers with ± and deviations of the profile add in squares; to the root of their sum the |changes| with other
        curves through the points of a profile are added. {} where nothing is uncertain. With `passed` states, by column
        (m,).

        Raises:
            SettingsError: too few curves through the points of a profile are a contact, so that no error is known;
                an end of a number with ± is no contact.
        """
        profile = self.scene.bodies.profile
        if not (self.scene.shares or profile.deviations or profile.alternatives):
            return {}
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
        """Return the particles of the reduced model of a body of another shape; settings stay but for the contact law.

        None where it is no contact, as with a jump of its edge at a corner.
        """
        scene = self.scene.with_profile(shape)
        try:
            return reduced(scene, replace(self.settings, law=settings_for(scene).law))
        except SettingsError:
            return None

    def _largest_changes(self, models: Sequence[Particles]) -> Values:
        """Return the largest |difference| of each result over other models, by name in its unit; 0 without models.

        A result that another model does not have counts as 0 there.
        """
        largest = {name: np.zeros_like(value) for name, value in self.results.items()}
        for values in map(self.values, models):
            for name, value in self.results.items():
                largest[name] = np.maximum(largest[name], np.abs(values.get(name, 0.0) - value))
        return largest


def values_of(readings: Mapping[str, Reading]) -> Values:
    """Return the values of readings by name, without their errors, each in its reading's unit."""
    return {name: reading.value for name, reading in readings.items()}


def _on_axis(profile: Profile) -> float:
    """Return the pressure on the axis but for a constant factor, ∫ −dq/x from the first x > 0 on [FU/LU²].

    q is the line load, compression positive; 0 where fewer than two particles have x > 0.
    """
    x, q = profile.x[profile.x > 0.0], profile.pressure[profile.x > 0.0]
    return -float(np.sum(np.diff(q) / (x[1:] + x[:-1])))
