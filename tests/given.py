"""A contact whose curve is a formula: searches are driven over it, and what they find is known in closed form.

Nothing runs: a row is answered by F(d), the contact radius a(d) and the smallest distance r(d) that a test gives. All
rows that were asked for are kept, so that a test can say which ones a search needs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius
from contact1d.workflow.deck.steps import Hold, Phase
from contact1d.workflow.continuation.load_control import Search
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.holding import Held
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import Settings, settings_for
from tests.scenes import chains

Curve = Callable[[float], float]
X = np.arange(40) - 19.5
PRESSED = np.where(np.abs(X) < 8.0, 1.0, np.where(np.abs(X) < 10.0, -0.5, 0.0))
"""A pressure that is largest in the middle and no more than nothing at the ends."""
PROFILE = Profile(X, 0.0 * X, 0.0 * X + 0.1, PRESSED, 0.0 * X)
PULL: dict[str, Any] = {"kind": "pull_off", "preload": 0.3}


class Radius:
    """A contact radius that is given; None for none."""

    def __init__(self, value: float | None, uncertainty: float = 0.0) -> None:
        self._found = None if value is None else ContactRadius(value, uncertainty, -value, value, reaches_end=False)

    def of(self, _: Profile) -> ContactRadius | None:
        """The same for any profile."""
        return self._found

    def or_spot(self, _: Profile) -> ContactRadius:
        """A spot of unknown size."""
        return ContactRadius(0.0, 1.5, 0.0, 0.0, reaches_end=False)


def at(displacement: float, force: float, radius: float | None = 1.0, uncertainty: float = 0.0, **more: Any) -> State:
    """A state with these numbers [LU, FU]."""
    rule: Any = Radius(radius, uncertainty)
    known = State("unloading", displacement, force, PROFILE, 0.1, 0.0, 0.0, rule)
    return replace(known, **more)


def held(tension: float, place: float = 1.0, **more: Any) -> Held:
    """A pull that holds that tension [FU] at a place [LU]."""
    return Held(-tension, (at(place, -tension, **more),), True, 0.0)


def search(*tensions: float, past: float = 0.0, guess: float = 1.0, **bounds: float) -> Search:
    """A search to 1e-2 that has tried these tensions [FU], the first of them 0."""
    found = Search(1e-2, guess, lambda tension: past, [held(0.0), *(held(t) for t in tensions)])
    for name, value in bounds.items():
        setattr(found, name, value)
    return found


@dataclass
class Estimate:
    """What an estimate says, each a number or a curve."""

    snaps: bool = False
    rest: float = 0.0
    spacing: float = 1.0
    gap: Any = field(default_factory=lambda: np.linspace(0.0, 1.0, 11))
    force: Any = field(default_factory=lambda: np.linspace(1.0, -0.2, 11))
    largest: float = 1.0
    teeth: float = math.inf
    profile: Any = field(default_factory=lambda: SimpleNamespace(height=lambda x: x**2 / 200.0))
    place: Curve = lambda force: 0.5 * force
    apart: Curve = lambda share: -1.0
    stiffness: Curve = lambda load: 2.0

    def pull_off_force(self) -> float:
        """[FU]."""
        return self.largest

    def tooth(self, particles: int) -> float:
        """Distance of teeth [LU]."""
        return self.teeth

    def displacement_at(self, force: float) -> float:
        """Where the force is expected [LU]."""
        return self.place(force)

    def parted(self, share: float) -> float:
        """Where so much of the largest tension is left [LU]."""
        return self.apart(share)

    def stiffness_under(self, load: float) -> float:
        """[FU/LU]."""
        return self.stiffness(load)

    def half_width(self, displacement: float, gap: float) -> float:
        """Of what is nearer than the gap [LU]."""
        return 2.0

    def let_go_early(self, move: float, force: float) -> float:
        """How early a pair lets go [LU]."""
        return 0.25 * move


def given_scene(**tables: Any) -> Scene:
    """Two chains of forty particles."""
    law = (0.018, 0.03, 0.009, 0.06)
    return scene_from_dict(chains(100.0, law=law, **{"bodies": {"particles": 40}, "experiment": PULL} | tables))


class GivenContact:
    """Answers rows by its curves; `settings` that are named replace those of the scene."""

    def __init__(
        self, force: Curve, *, scene: Scene | None = None, closest: Curve = lambda d: 0.1,
        radius: Callable[[float], float | None] = lambda d: 1.0, spread: float = 0.0, stepped: bool = False,
        profile: Callable[[float], Profile] = lambda d: PROFILE, place: Callable[[float], float | None] | None = None,
        **settings: Any,
    ) -> None:  # fmt: skip
        """`spread`: uncertainty of the radius [LU]; `stepped`: whether rows are steps of one run.

        `place`: where a load is held [LU]; None where it parts the bodies.
        """
        self.scene = scene or given_scene()
        self.settings: Settings = replace(settings_for(self.scene), **{"estimate": Estimate()} | settings)
        self.deck = SimpleNamespace(stepped=stepped, scene=self.scene, settings=self.settings)
        self._curves, self._place = (force, closest, radius, profile), place
        self.holds: list[Hold] = []
        self._spread = spread
        self._phases: list[Phase] = []
        self.states: list[State] = []
        self.ended: list[str] = []
        self.batches: list[int] = []
        self.expected: list[int | None] = []
        self.waits: Any = None

    @property
    def phases(self) -> tuple[Phase, ...]:
        """So far."""
        return tuple(self._phases)

    @property
    def places(self) -> list[float]:
        """Displacements of all rows in order [LU]."""
        return [state.displacement for state in self.states]

    def begin(self, name: str, fragments: tuple[str, ...] = (), expected_steps: int | None = None) -> None:
        """A phase."""
        self.expected.append(expected_steps)
        self._phases.append(Phase(name, (), begin=fragments))

    def row(self, row: Any) -> State:
        """The state at its displacement, or where its load is held; a plate that has parted moves off."""
        force, closest, radius, profile = self._curves
        if isinstance(row, Hold):
            self.holds.append(row)
            found = None if self._place is None else self._place(row.load)
            if found is None:
                self.states.append(
                    at(row.parted - 1e-6, 0.0, plate_velocity=-1.0, smallest_distance=1.1 * self.settings.cutoff)
                )
                return self.states[-1]
            d = found
        else:
            d = row.displacement
        phase = self._phases[-1].name if self._phases else ""
        more = {"phase": phase, "smallest_distance": closest(d), "profile": profile(d), "number": len(self.states)}
        self.states.append(at(d, force(d), radius(d), self._spread, **more))
        if self._phases:
            self._phases[-1] = replace(self._phases[-1], rows=(*self._phases[-1].rows, row))
        return self.states[-1]

    def rows(self, rows: Sequence[Any]) -> list[State]:
        """One after the other."""
        self.batches.append(len(rows))
        return [self.row(row) for row in rows]

    def replay(self, phases: Sequence[Phase], at_rest: Callable[[State], bool] | None = None) -> list[State]:
        """A whole schedule; whether it waits for rest is noted."""
        self.waits = at_rest
        found = []
        for phase in phases:
            self.begin(phase.name, phase.begin)
            found += self.rows(phase.rows)
            if phase.state:
                self.write_state()
        self.finish()
        return found

    def write_state(self) -> None:
        """Ends the phase."""
        self._phases[-1] = replace(self._phases[-1], state=True)

    def finish(self) -> None:
        """The run is over."""
        self.ended.append(self._phases[-1].name)


class GivenContext:
    """Opens one contact of those that a test has made after the other."""

    def __init__(self, *contacts: GivenContact) -> None:
        """In order."""
        self._left = list(contacts)
        self.deck: Any = contacts[0].deck
        self.retries = True
        self.notes: list[str] = []
        self.progress = SimpleNamespace(note=self.notes.append)
        self.left: Any = None

    @contextmanager
    def contact(self, purpose: str = "", meanwhile: Callable[[Settings], object] | None = None) -> Iterator[Any]:
        """The next."""
        yield self._left.pop(0)


def given_context(*contacts: GivenContact) -> Any:
    """A context with these contacts, as any that an experiment asks for."""
    return GivenContext(*contacts)
