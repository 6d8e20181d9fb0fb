"""The tables of a scene that are effects: each may be absent, and then adds nothing.

Interaction of two particles at distance r: V(r) = A exp(−r/a) − B exp(−r/b), with A, a the amplitude and range of the
repulsion and B, b those of the attraction.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal

from annotated_types import Le, Lt
from pydantic import AfterValidator, Field
from pydantic_core import PydanticCustomError

from contact1d.workflow.scene.quantities import (
    DIMENSIONLESS,
    POSITIVE,
    Auto,
    DampingCoefficient,
    DampingCoefficientOrZero,
    Duration,
    Energy,
    Length,
    LineEnergy,
    Listed,
    Mass,
    MomentOfInertia,
    OutOfRange,
    Ratio,
    RatioOrZero,
    Seed,
    Stiffness,
    Table,
    Temperature,
    Velocity,
)

REVERSED = (
    "to reverse or hold the drive give experiment.path = [[velocity, distance], …] in place of a distance: velocities "
    "there may be negative or 0"
)
"""Suggested fix for a velocity of the cantilever that is not positive."""


class Exponential(Table):
    """One term of the interaction: amplitude · exp(−r/range)."""

    amplitude: Energy
    """energy at distance zero"""
    range: Length
    """decay length"""


class Effect(Table):
    """A table that may be absent, and then adds nothing to a deck. Each effect declares its needs and exclusions.

    Attributes:
        timed: whether the effect exists in time only, so never in a quasistatic run.
        how: how to write the table, for a scene that lacks it.
        excludes: effects that are not possible together with this one, and why.
        needs_bonds: whether the effect acts on particles separately from their body, so that on a rigid plane each has
            its own spring; without such an effect particles are fixed in their body and the plane has their springs.
        is_modelled: whether the reduced model has the effect, so that a plan on a rigid plane is that of the deck.
        keeps_springs: whether the line load inside a contact remains that of linear springs, q = E* (const − g).
    """

    timed: ClassVar[bool] = False
    needs_bonds: ClassVar[bool] = False
    is_modelled: ClassVar[bool] = False
    keeps_springs: ClassVar[bool] = False
    how: ClassVar[str] = ""
    excludes: ClassVar[Mapping[str, str]] = {}

    @property
    def added_stiffness(self) -> float:
        """Largest stiffness [FU/LU] that the effect adds to a particle, which limits the timestep.

        0 for all effects but [neighbours].
        """
        return 0.0

    def largest_phase(self, tolerance: float) -> float:
        """Return the largest ω·Δt [rad] with which the effect is exact to a relative tolerance.

        Infinite for all effects but [noise], of which it is √(tolerance/0.4).
        """
        return math.inf


class Interaction(Effect):
    """Effect: V(r) = A exp(−r/a) − B exp(−r/b) between particles of opposite bodies."""

    is_modelled = keeps_springs = True

    how = "[interaction] with its repulsion"

    repulsion: Exponential
    """repulsive term, A and a"""
    attraction: Exponential | None = None
    """attractive term, B and b; absent: no adhesion"""
    cutoff: Auto[Length] = "auto"
    """distance beyond which no force acts, or "auto": so long that its truncation error is a small share of the
    tolerance
    """


class Neighbours(Effect):
    """Effect: springs between neighbouring particles of one body, with transverse rigidity."""

    needs_bonds = True

    stiffness: Stiffness
    """stiffness of a spring between neighbours"""

    @property
    def added_stiffness(self) -> float:
        """Stiffness 4 k_n [FU/LU] of the springs to neighbours that move against a particle."""
        return 4.0 * self.stiffness


class Horizontal(Effect):
    """Effect: particles may also move along x. It has no keys."""

    is_modelled = keeps_springs = True

    how = "[horizontal], an empty table: without it particles cannot follow a plate along x"


class Friction(Effect):
    """Effect: Coulomb's friction of every particle on a rigid plane."""

    is_modelled = keeps_springs = True

    how = "[friction] with its coefficient"

    coefficient: RatioOrZero
    """coefficient of friction μ: a particle slips where its tangential force would exceed μ times its normal force, and
    until then has the stiffness bodies.bulk_stiffness_tangential
    """


class Rate(Table):
    """How the energy that opens an edge grows with its speed: G = W (1 + (v/v₀)ⁿ) (Maugis and Barquins)."""

    velocity: Velocity
    """speed v₀ of the edge at which G = 2W"""
    exponent: Ratio
    """exponent n, about 0.6 for elastomers"""


class Adhesion(Effect):
    """Effect: adhesion to a rigid plane, JKR's, or with a range that of Maugis and Dugdale. W or γ is given."""

    is_modelled = keeps_springs = True

    one_of = (
        (("work_of_adhesion", "surface_energy"), "give W, or with surface_energy γ of one side, half of it; not both"),
    )
    excludes = {
        "neighbours": "the springs of a JKR contact are independent, and neighbours would couple them",
        "noise": "particles that are fixed to their body have no thermal motion",
    }

    work_of_adhesion: LineEnergy | None = None
    """work of adhesion W of both surfaces: F_A = 1.5 π W R for a sphere"""
    surface_energy: LineEnergy | None = None
    """γ of one side, half the work of adhesion"""
    range: Length | None = None
    """range h₀ = W/σ₀ of the attraction, 0.974 z₀ of a Lennard-Jones surface: the contact is that of Maugis and
    Dugdale, from DMT to JKR; absent: a range of zero, JKR
    """
    rate: Rate | None = None
    """in a pull_off with a velocity, or a history of displacements: finite speed at which the contact edge recedes; it
    advances at once; absent: it recedes at once, too
    """

    @property
    def work(self) -> float:
        """Work of adhesion W [FU/LU] ≥ 0 of both surfaces: as given, else twice the surface energy."""
        if self.work_of_adhesion is not None:
            return self.work_of_adhesion
        assert self.surface_energy is not None
        return 2.0 * self.surface_energy


class Term(Table):
    """One term of a Prony series."""

    share: Annotated[float, POSITIVE, Le(1), DIMENSIONLESS]
    """share of the instantaneous modulus that relaxes with this time; all shares add up to 1 at most"""
    time: Duration
    """relaxation time τ"""


class TermsFile(Table):
    """The file of a Prony series."""

    file: str
    """file with a term in each line, in the columns share and time [s], also share_uncertainty and time_uncertainty"""


class Viscoelasticity(Effect):
    """Effect: a body that relaxes, on a rigid plane: E(t) = E (1 − Σ share (1 − exp(−t/time))), or Kelvin and Voigt's.

    Poisson's ratio is constant, so that each spring has the function of the material.
    """

    is_modelled = True

    one_of = (
        (
            ("terms", "retardation_time", "restitution"),
            "give the terms of a Prony series or one retardation_time, or in an impact the restitution; not several",
        ),
    )
    how = "[viscoelasticity] with terms = [{ share, time }, …]"
    excludes = {
        "adhesion": "what opens the edge of such a contact depends on all that came before, which no rule for the edge "
        "of an elastic contact has",
        "friction": "a slip depends on the order in which pressure and shear relax, which is not exact here",
        "neighbours": "each of its springs follows the material by itself, and neighbours would couple them",
        "noise": "particles that are fixed to their body have no thermal motion",
        "damping": "the springs have the damping of the material",
    }

    given_terms: Listed[Term] | TermsFile | None = Field(default=None, alias="terms")
    """Prony series of the instantaneous modulus, which [material] or bulk_stiffness gives"""
    retardation_time: Duration | None = None
    """in place of terms, for a Kelvin-Voigt body: retardation time T of a dashpot parallel to each spring, whose force
    is proportional to u + T u′, u its compression
    """
    restitution: Annotated[float, POSITIVE, Lt(1), DIMENSIONLESS] | None = None
    """in place of the retardation_time, in an impact of a parabola, a cone or a power: normal coefficient of
    restitution, at the velocity and mass of the scene, from which the retardation time is computed
    """

    @property
    def terms(self) -> tuple[Term, ...]:
        """The terms of the Prony series, in the order of the scene; () of a Kelvin-Voigt body."""
        return self.given_terms if isinstance(self.given_terms, tuple) else ()

    @property
    def lasting(self) -> float:
        """Share of the instantaneous modulus that does not relax, 0 … 1: 1 − Σ share; 1 of a Kelvin-Voigt body."""
        return max(0.0, 1.0 - math.fsum(term.share for term in self.terms))

    @property
    def resists_jumps(self) -> bool:
        """Whether a jump of the displacement takes an unbounded force: with a retardation time (Kelvin-Voigt)."""
        return not self.terms

    @property
    def shortest_time(self) -> float:
        """The retardation time [TU], or without one the shortest relaxation time [TU] of the Prony series."""
        return self.retardation_time or min(term.time for term in self.terms)


class Damping(Effect):
    """Effect: viscous damping of the particles."""

    is_modelled = keeps_springs = True

    timed = True
    how = '[damping] with coefficient = "auto"'

    coefficient: Auto[DampingCoefficient]
    """drag force over velocity of a particle, or "auto": near critical"""


class Noise(Effect):
    """Effect: thermal forces on the particles; with the damping it makes one Langevin thermostat."""

    timed = True
    needs_bonds = True
    how = "[noise] with temperature and seed"

    temperature: Temperature
    """temperature as energy k_BT"""
    seed: Seed
    """seed of the random forces"""

    def largest_phase(self, tolerance: float) -> float:
        """Return the largest ω·Δt [rad] with which mean squares of displacements are exact to a relative tolerance.

        It is √(tolerance/0.4), by a measured error of fix langevin with fix nve.
        """
        bias = 0.4  # relative error of ⟨u²⟩ over (ω Δt)² with fix langevin and fix nve, measured at ω Δt = 0.1: 0.4 %
        return math.sqrt(tolerance / bias)


def _free_directions(free: tuple[str, ...]) -> tuple[str, ...]:
    """Return the directions sorted, ("x", "z") or ("z",).

    Raises:
        PydanticCustomError: one is given twice, or "z" is missing.
    """
    if len(set(free)) < len(free):
        raise PydanticCustomError("scene", "must name each direction once")
    if "z" not in free:
        raise PydanticCustomError("scene", 'must contain "z"')
    return tuple(sorted(free))


Free = Annotated[Listed[Literal["x", "z"]], AfterValidator(_free_directions)]


class Plate(Effect):
    """Effect: the upper plate is a rigid body with inertia, loaded by a force. Absent: its position is prescribed."""

    is_modelled = keeps_springs = True

    timed = True
    how = '[plate] with mass = "auto"'

    mass: Auto[Mass] = "auto"
    """mass of the plate, or "auto": that of all particles of the upper body"""
    free: Free = ("z",)
    """directions in which the plate may move: ["z"] or ["x", "z"]"""
    damping: Auto[DampingCoefficientOrZero] = "auto"
    """drag force over velocity of the plate, or "auto": together with that of the particles near critical, 0 with
    [noise] and in an impact
    """
    lever_arm: Auto[Length] = "auto"
    """of an oblique impact: distance l of the contact point from the centre of mass, or "auto": the ball's own radius,
    of a parabola or a circle
    """
    moment_of_inertia: Auto[MomentOfInertia] = "auto"
    """of an oblique impact: moment of inertia about the axis of the spin, or "auto": ⅖ m l² of a solid ball"""


class Cantilever(Effect):
    """Effect: the plate is pulled along x through a spring whose far end is driven."""

    is_modelled = keeps_springs = True

    timed = True
    how = "[cantilever] with stiffness and velocity"

    stiffness: Stiffness
    """stiffness of the spring"""
    velocity: Annotated[Velocity, OutOfRange(REVERSED)]
    """velocity of the driven end; with experiment.path each leg has its own"""
