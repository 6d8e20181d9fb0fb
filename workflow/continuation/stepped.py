"""A branch whose load steps are steps of one run, on a rigid plane, at negligible cost.

The reduced model of such a contact is identical to the deck, so that its limit points and forces are known beforehand.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import zoned
from contact1d.workflow.continuation.branch import Branch
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trust import DigitsError, TensionError
from contact1d.workflow.deck.steps import Cohere, Displace, Phase, Spend
from contact1d.workflow.model.reduced import History, Path, RatedCells, Reduced, RelaxingSprings, path_of
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

LOADING_STEPS = 24
"""Load steps up to a force that is known beforehand."""
CURVE_STEPS, CURVE_NUMBERS = 100, 200_000
"""Increments of a load where rows are steps of one run, for the sake of its curve: they cost some tens of microseconds
each. Of long chains there are so many that positions times load steps stay below the second."""
PULLING_STEPS = 48
"""Load steps from F = 0 to the limit point, where it is known."""
NEARLY = 1.0 + 1e-6
"""Load steps that are even but for round-off are so."""
EXACT = 1e-9
"""How near to a wanted force a load step comes, over its scale."""
LAST = 1e-9
"""How much of that is left before it."""
BEYOND_LIMIT = 1.05
"""End of the way over the limit point."""


class SteppedBranch(Branch):
    """States on a rigid plane."""

    def by_model(self) -> NDArray[np.float64] | None:
        """See `by_model`."""
        return by_model(self.scene, self.model, self.states, self.history)

    def _nearest(self, near: float, scale: float) -> float:
        """Up to the round-off of the particles: the next load step costs next to nothing."""
        round_off = self.settings.chains.upper * max((state.residual for state in self.states[-1:]), default=0.0)
        return min(near, max(EXACT * scale, round_off))

    def _first_rows(self, force: float, direction: int) -> None:
        """Load steps up to where the model has the force [FU].

        Raises:
            TensionError: no contact holds the force.
        """
        start = self._last.displacement if self.states else 0.0
        end = self.model.displacement_at(force)
        held = float(self.model.held(np.asarray([end]))[0])
        if force < 0.0 and held > (1.0 - self.settings.tolerance) * force:
            raise TensionError(force, self.scale)
        if direction * (end - start) <= 0.0:
            super()._first_rows(force, direction)
            return
        steps = LOADING_STEPS if self.model.limits else curve_steps(self.settings)
        rows = np.linspace(start, end, steps + 1)
        self._visit(rows[1:] if self.states else rows)

    def maximum(self) -> None:
        """Load steps from F = 0 to just before the limit point, then about the force maximum.

        Raises:
            DigitsError: it is below the round-off error of positions.
        """
        zero, last = self._last.displacement, self.model.apart
        end = zero + (1.0 - LAST) * (last - zero)
        rows = self.model.unloading(zero, end, PULLING_STEPS)
        self._visit(rows)
        before = self.peak
        every = np.append(zero, rows)
        near = int(np.argmin(np.abs(every - before.position)))
        beside = -np.diff(every[max(near - 1, 0) : near + 2])
        step = min((zero - last) / PULLING_STEPS, NEARLY * float(beside.min()))
        self._visit(np.clip(before.position + step * np.asarray((0.5, -0.5, 0.25, -0.25)), end, zero))
        self._visit([min(max(self.peak.position, end), zero)])
        self._found(abs(self.peak.smooth - before.smooth))
        digits = self._last.residual * self.settings.chains.upper
        if self.peak.smooth <= digits:
            raise DigitsError(
                f"the force maximum, about {self.scale:.2g} FU, is too small compared with {digits:.2g} FU, the "
                "round-off error of the contact force",
                "use a larger adhesion.work_of_adhesion, or a smaller preload",
            )

    def follow(self, history: History) -> None:
        """Load steps that take their time; those of forces are where the model carries them.

        Where a body that relaxes ends its contact, particles that touch nothing know, and these have no force to show.
        """
        self._turned, times, self.history = True, iter(history.time.tolist()), history.path(self.model)
        self.given = "force" if history.by_force else self.given
        edges: Iterator[tuple[float, ...]] | None = None
        if isinstance(self.model, RelaxingSprings):
            zone = self.model.follow(self.history).zone
            assert zone
            edges = zip(*(one.tolist() for one in zone), strict=True)
        for phase in followed(self.model, history):
            self.begin(phase.name)
            self._enter()
            states = [replace(state, time=next(times)) for state in self.contact.rows(phase.rows)]
            if edges is not None:
                states = [replace(one, profile=zoned(one.profile, *next(edges))) for one in states]
            self._keep(states)
            if phase.name in history.marks:
                self.mark(history.marks[phase.name])

    def open(self) -> None:
        """Load steps over the limit point."""
        self._visit(np.linspace(self._last.displacement, BEYOND_LIMIT * self.model.apart, LOADING_STEPS + 1)[1:])


def by_model(
    scene: Scene, model: Reduced, states: Sequence[State], history: Path | None = None
) -> NDArray[np.float64] | None:
    """Forces [FU] of the model in all states of a path, (m,); None where it is no copy of the deck."""
    if not (scene.is_stepped and scene.is_modelled):
        return None
    path = history or path_of(np.asarray([state.displacement for state in states]))
    return model.planned(path, lambda i: states[i].profile)


def followed(model: Reduced, history: History) -> tuple[Phase, ...]:
    """The load steps of a history, a phase for each of its own."""
    rows, phases = iter(_timed(model, history.path(model))), []
    for name, moments in groupby(history.phases):
        phases.append(Phase(name, tuple(next(rows) for _ in moments), state=name in history.marks))
    return tuple(phases)


def _timed(model: Reduced, path: Path) -> list[Displace]:
    """Load steps along a path in time: those of bodies that relax have a duration, of an edge that does its place."""
    if isinstance(model, RatedCells):
        zone = model.zone(path)
        area = model.estimate.law.area(zone.edge)
        height = np.divide(area, zone.edge, out=np.zeros_like(area), where=zone.edge > 0.0)
        columns = (column.tolist() for column in (path.displacement, zone.edge, zone.edge, height))
        return [Cohere(*numbers) for numbers in zip(*columns, strict=True)]
    if not isinstance(model, RelaxingSprings):
        return [Displace(place) for place in path.displacement.tolist()]
    numbers = (path.displacement, model.spent(path.time), model.velocities(path))
    return [Spend(*row) for row in zip(*(one.tolist() for one in numbers), strict=True)]


def curve_steps(settings: Settings) -> int:
    """Increments of a load's curve where load steps are steps of one run."""
    return max(LOADING_STEPS, min(CURVE_STEPS, CURVE_NUMBERS // settings.chains.upper))
