"""Claim: a thermal mean has forgotten its start, its standard error is that of its own fluctuations, and it balances.

Reference: a series x' = c x + √(1 − c²) n of unit variance, whose mean over n samples has the exact variance
[n (1 + c)/(1 − c) − 2c (1 − cⁿ)/(1 − c)²]/n². In place of LAMMPS stands a plate that follows it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest

from contact1d.analysis.radius import tensile_radius
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Row, UnderLoad
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.engine.session import Session
from contact1d.workflow.experiments.load.dynamic import load_dynamic
from contact1d.workflow.experiments.running.contact import Contact, State
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.sampling import standard_error
from contact1d.workflow.experiments.running.trust import UntrustedError
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import settings_for
from tests.exact import ExactContact, Nobody

MakeScene = Callable[..., Scene]
SERIES, LENGTH = 400, 400
CLAIM = 0.15
"""Of the mean square of the claimed error, over the exact one: √(2/19/400) = 0.016 of statistics, and the correlation
between blocks of twenty samples, up to 0.1 at c = 0.6."""
SIGMAS = 4.0
LOAD, PLACE = 0.3, 0.1
"""Load [FU], and the place about which the plate swings [LU]."""
BODY_RADIUS, SCATTER = 100.0, 1.6
"""Of the scene [LU]; an error from twenty blocks is off by a sixth, the radius by interpolation from √ by as much."""
SWING, START, MEMORY = 1e-3, 0.1, 3.0
"""Standard deviation, distance at the start [LU], and the time in which it is forgotten over the settling time."""


@pytest.mark.parametrize("c", [0.0, 0.3, 0.6])
def test_the_standard_error_is_that_of_the_mean_of_a_correlated_series(c: float) -> None:
    rng = np.random.default_rng(3)
    x = np.empty((SERIES, LENGTH))
    x[:, 0] = rng.normal(size=SERIES)
    for i in range(1, LENGTH):
        x[:, i] = c * x[:, i - 1] + math.sqrt(1.0 - c**2) * rng.normal(size=SERIES)
    n = LENGTH
    exact = (n * (1.0 + c) / (1.0 - c) - 2.0 * c * (1.0 - c**n) / (1.0 - c) ** 2) / n**2
    claimed = float(np.mean([standard_error(series.tolist()) ** 2 for series in x]))
    assert claimed == pytest.approx(exact, rel=CLAIM)
    assert float(np.mean(x.mean(axis=1) ** 2)) == pytest.approx(exact, rel=SIGMAS * math.sqrt(2.0 / SERIES))


class Swinging(ExactContact):
    """A plate that comes from START off its place and swings about it; `missed`: force that no load balances [FU]."""

    def __init__(self, deck: Deck, missed: float) -> None:
        Contact.__init__(self, deck, cast(Session, Nobody()))
        self._seen = ExactContact(deck)
        self._seen.begin("seen")
        self._rng, self._missed, self._time = np.random.default_rng(8), missed, 0.0

    def row(self, row: Row) -> State:
        assert isinstance(row, UnderLoad)
        self._time += row.steps * self.settings.time_step
        decayed = START * math.exp(-self._time / (MEMORY * self.settings.settle_time))
        force = row.load + self._missed + SWING * self._rng.normal()
        swings = PLACE + SWING * self._rng.normal()
        return replace(self._seen.state(swings), displacement=swings + decayed, force=force)


class Swings(RunContext):
    """Opens one."""

    missed = 0.0

    @contextmanager
    def contact(self, purpose: str = "") -> Iterator[Contact]:
        yield Swinging(self.deck, self.missed)


def sampled(make_scene: MakeScene, missed: float) -> Outcome:
    timed: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}, "noise": {"temperature": 1e-6, "seed": 1}}
    scene = make_scene(
        bodies={"particles": 60}, **timed, experiment={"kind": "load", "method": "dynamic", "force": LOAD}
    )
    context = Swings(Deck(scene, settings_for(scene)), cast(Any, None), Silent(), 1.0)
    context.missed = missed
    return load_dynamic(context)


def test_a_thermal_mean_has_forgotten_where_it_began(make_scene: MakeScene) -> None:
    """Three settling times of memory: after ten of them 4 % of the start are left."""
    displacement = sampled(make_scene, 0.0).quantities["displacement"]
    left = START * math.exp(-10.0 / MEMORY) * MEMORY / 50.0
    assert abs(displacement.value - PLACE) <= SIGMAS * displacement.uncertainty
    assert abs(displacement.value - PLACE) <= left + SIGMAS * SWING / math.sqrt(200.0)


def test_the_radius_of_the_mean_pressure_is_known_as_well_as_its_swing_allows(make_scene: MakeScene) -> None:
    """a goes with √(2R(d − d₀)), so a sample is off by (R/a) SWING; the rest of the claim is the lattice's."""
    outcome = sampled(make_scene, 0.0)
    claimed = outcome.quantities["contact_radius"]
    lattice = tensile_radius(outcome.profiles["final"]).uncertainty
    expected = BODY_RADIUS / claimed.value * SWING / math.sqrt(200.0)
    assert 1.0 / SCATTER < (claimed.uncertainty - lattice) / expected < SCATTER


def test_a_mean_force_that_misses_its_load_is_no_result(make_scene: MakeScene) -> None:
    error = SWING / math.sqrt(200.0)
    assert sampled(make_scene, error).quantities["force"].value == pytest.approx(LOAD, abs=SIGMAS * error + error)
    with pytest.raises(UntrustedError, match="not in equilibrium"):
        sampled(make_scene, 20.0 * error)
