"""Claim: a quasi-static pull-off gives the adhesion force and the contact radii of the model's energy minima.

References. `validation.references.pull_off`, an energy minimisation in numpy/scipy that shares no line with the
program: no LAMMPS, no table, no cutoff, its own law, path and search. Where pairs are independent `independent_pairs`:
F(G₀) = (√(2R)/s) ∫ f(G) (G − G₀)^(−1/2) dG with G = r − 2 f(r)/k, and a = √(2R (G_m − G₀)), so that F_A, a_0 and a_cr
grow as √R: one integral, no chain and no minimisation.

What limits the agreement. The adhesion force: the rows of the last pass around the largest tension, whose increments
are chosen so that a parabola through them misses no more than 0.3·tolerance = 3e-4, and the tail beyond the cutoff; the
sum over particles is the trapezoidal rule of a smooth integrand. The radii: the interpolation of the pressure between
particles, a few 1e-3 spacings, and at the critical state also the displacement, since a_cr changes with it while the
force, at its maximum, does not. The minimiser is exact to 1e-9 in the force and takes a polynomial through nine
particles for a radius, good to some 1e-6 where a dip is many spacings wide.
"""

from dataclasses import dataclass, replace
from typing import Any

import pytest

from contact1d import run
from tests.scenes import chains
from validation.references.independent_pairs import IndependentPairs
from validation.references.interaction import PairInteraction
from validation.references.model import ChainModel
from validation.references.pull_off import pull_off
from validation.references.solver import State
from validation.references.tension_radius import tension_radius

NAMES = ("adhesion_force", "zero_load_radius", "critical_radius")
WITHIN = {"adhesion_force": 2e-5, "zero_load_radius": 2e-4, "critical_radius": 2e-4}
"""Relative; measured 1.2e-5, the tail of the attraction beyond the automatic cutoff; 9e-5, 2e-3 spacings in a contact
of twenty; 4e-5, the same and the displacement of the maximum."""
PRELOAD = 1e-6
"""Relative; measured 6e-9: how near the secant of the last pass comes; far below what the force can change by it."""
INDEPENDENT_FORCE, INDEPENDENT_RADIUS = 2e-6, 3e-3
"""Relative; measured 4e-7: table, cutoff and rows, each chosen for far less than the tolerance of 1e-3. [LU]; measured
1.2e-3 at most: interpolation between particles one spacing apart."""
STENCIL = 9
"""Particles behind a radius of the reference."""
COARSE = 0.25
"""Path step of the reference over the shortest range: without snapping its results do not depend on it (to 1e-8)."""
STIFFNESS = 0.83


def radius(model: ChainModel, state: State) -> float:
    """Of the largest tension over the places where the upper particles are, as the program counts them [LU]."""
    return tension_radius(model.places() + state.upper[:, 0], state.pair_force[:, 1] / model.spacing, STENCIL)


@dataclass(frozen=True)
class Case:
    """One scene; energies [FU·LU], ranges and radius [LU], preload [FU], stiffnesses [FU/LU]."""

    law: tuple[float, float, float, float]
    radius: float
    preload: float
    neighbours: float = 0.0
    horizontal: bool = False
    tangential: float | None = None

    @property
    def interaction(self) -> PairInteraction:
        return PairInteraction.of(*self.law)

    @property
    def tables(self) -> dict[str, Any]:
        """Everything that can be left open is."""
        return chains(
            self.radius,
            STIFFNESS,
            self.law,
            bodies={"bulk_stiffness_tangential": self.tangential} if self.tangential else {},
            neighbours={"stiffness": self.neighbours} if self.neighbours else None,
            horizontal={} if self.horizontal else None,
            experiment={"kind": "pull_off", "method": "quasistatic", "preload": self.preload},
        )

    def minimised(self, particles: int) -> dict[str, float]:
        """The reference's numbers by the program's names."""
        model = ChainModel(
            particles, STIFFNESS, self.interaction, radius=self.radius, neighbour_stiffness=self.neighbours,
            horizontal=self.horizontal, tangential_stiffness=self.tangential,
        )  # fmt: skip
        exact = pull_off(model, self.preload, step=COARSE * self.law[1], stencil=STENCIL)
        radii = (radius(model, state) for state in (exact.zero_load, exact.critical))
        return dict(zip(NAMES, (exact.adhesion_force, *radii), strict=True))


SHORT, LONG = Case((0.15, 0.1, 0.075, 0.2), 1000.0, 1.0), Case((1.0, 0.5, 0.5, 1.0), 100.0, 0.5)
"""The longer the range, the smaller the radius, and contacts stay alike."""


@pytest.mark.parametrize(
    "case",
    [
        SHORT,
        replace(LONG, neighbours=0.3, horizontal=True),
        Case((0.4, 0.25, 0.2, 0.5), 200.0, 1.0, horizontal=True, tangential=1.2),
    ],
    ids=["range 0.2", "range 1 neighbours horizontal", "range 0.5 horizontal k_t"],
)
def test_pull_off_agrees_with_the_reference(case: Case) -> None:
    """And the stated uncertainty covers the error, within the tolerance that the scene asks for, 1e-3."""
    finished = run(case.tables)
    found, exact = finished.results, case.minimised(finished.profiles["critical"].x.size)
    for name in NAMES:
        assert found[name].value == pytest.approx(exact[name], rel=WITHIN[name])
    assert found.preload.value == pytest.approx(case.preload, rel=PRELOAD)
    for name in ("adhesion_force", "zero_load_radius"):
        assert abs(found[name].value - exact[name]) <= found[name].uncertainty
        assert 0.0 < found[name].uncertainty < 1e-3 * exact[name]


def test_independent_pairs_follow_the_closed_form() -> None:
    """At a distance of one spacing the force is 1e-13 of its largest value."""
    case = Case((0.0024, 0.015, 0.0012, 0.03), 8000.0, 0.1)
    found, pairs = run(case.tables).results, IndependentPairs(case.interaction, STIFFNESS, case.radius)
    exact = (pairs.adhesion_force(), pairs.zero_load_radius(), pairs.critical_radius())
    assert found.adhesion_force.value == pytest.approx(exact[0], rel=INDEPENDENT_FORCE)
    for name, value in zip(NAMES, exact, strict=True):
        assert abs(found[name].value - value) <= found[name].uncertainty
        assert name == "adhesion_force" or abs(found[name].value - value) < INDEPENDENT_RADIUS
