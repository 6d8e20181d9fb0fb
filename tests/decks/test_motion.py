"""Claim: the particles of a deck rest, resist and move in LAMMPS as the scene's springs, drag and heat say.

References: closed forms, no golden text. A particle of mass m on a spring k with the drag γ that starts at rest length
with the velocity v₀ has u(t) = (v₀/ω) exp(−γt/2m) sin ωt, ω² = k/m − (γ/2m)²; so has the mean of many under thermal
forces of mean 0.
"""

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from contact1d import run
from tests.decks.written import ANCHORS, LOWER, Written, written
from tests.scenes import chains

PARTICLES, STIFFNESS, MASS, DRAG = 20, 0.83, 1.0, 0.3
APART = "displace_atoms upper_body move 0 0 25 units box"
"""Far beyond the cutoff [LU]."""
KICK, TIMES = 0.1, 12
"""Velocity of every particle at the start [LU/TU], and places looked at, 1 TU apart: two periods, four decay times."""
INTEGRATION = 0.06
"""Over v₀/ω; 0.033 measured: in velocity Verlet the drag lags by half a time step of 0.2 TU. Half the drag: 0.2 off."""
COLD = 1e-7
"""k_BT [FU·LU]: a particle swings by 3e-4 LU, the mean of all by 4e-5 of the 0.1 LU of the motion."""
SECOND = 2e-5
"""Of a restitution in steps of a thousandth of the way down: of second order; of first order it would be 1e-4."""
ROUND_OFF, LONG_BOND = 2e-13, 5e-12
"""Of a force [FU]: places up to 1e2 LU are read to 1e-14 LU; a long bond, here 1e4 LU, to 2e-12 LU."""


def chain(radius: float = 60.0, tolerance: float = 1e-3, **tables: Any) -> Written:
    bodies = {"particles": PARTICLES, "mass": MASS} | tables.pop("bodies", {})
    experiment = {"experiment": {"kind": "path", "displacements": [0.1]}}
    return written(chains(radius, STIFFNESS, bodies=bodies, accuracy={"tolerance": tolerance}, **experiment | tables))


@pytest.mark.parametrize(("along", "spring"), [(0.0, 0.3), (STIFFNESS, 0.3), (0.5, 0.3), (1.4, 0.0)])
def test_undeformed_bodies_are_at_rest_and_as_stiff_as_the_scene_says(along: float, spring: float) -> None:
    """A particle that moves by (1, 1) LU pulls with its own springs and those of its neighbours, along x and along z.

    LAMMPS reads places bitwise as they are written; ends are not pulled inward, a curved chain is not pulled straight.
    Without [horizontal], `along` 0, nothing pulls along x.
    """
    deck = chain(
        neighbours={"stiffness": spring} if spring else None,
        horizontal={} if along else None,
        bodies={"bulk_stiffness_tangential": along or STIFFNESS},
    )
    move = "group one id {}\ndisplace_atoms one move {s} 0 {s} units box\nrun 0 post no\ngroup one delete"
    chosen = (0, 7)
    steps = [move.format(PARTICLES + 1 + particle, s=s) for particle in chosen for s in (1, -1)]
    rest, *moved = (state[: 2 * PARTICLES] for state in deck.after(f"{APART}\nrun 0 post no", *steps))
    assert np.array_equal(rest[:PARTICLES, 1:4], deck.atoms[LOWER])
    far = along not in (0.0, STIFFNESS)
    assert np.abs(rest[:, 4:]).max() <= (LONG_BOND if far else ROUND_OFF)
    for particle, found in zip(chosen, moved[::2], strict=True):
        wanted = np.zeros((2 * PARTICLES, 3))
        beside = [i for i in (particle - 1, particle + 1) if 0 <= i < PARTICLES]
        pulled = spring if along else 0.0
        wanted[PARTICLES + particle] = -along - len(beside) * pulled, 0.0, -STIFFNESS - len(beside) * spring
        wanted[[PARTICLES + i for i in beside]] = pulled, 0.0, spring
        # Moved across itself by 1 LU and at most 1 LU more for the anchor's shift, a long bond bends by u²/2L.
        allowed = abs(along - STIFFNESS) * 2.0**2 / (2.0 * deck.number("far_length")) if far else ROUND_OFF
        assert np.abs((found - rest)[:, 4:] - wanted).max() <= allowed


@pytest.mark.parametrize("tables", [{}, {"noise": {"temperature": COLD, "seed": 5}}], ids=["damping", "noise"])
def test_a_kicked_particle_swings_and_comes_to_rest_as_its_drag_says(tables: dict[str, Any]) -> None:
    """With the thermostat as without: its friction is the scene's [damping]. Anchors of the lower body stand still."""
    load = {"kind": "load", "method": "dynamic", "force": 0.0}
    deck = chain(
        1000.0, 1e-2, bodies={"particles": 60}, damping={"coefficient": DRAG}, plate={"damping": 0.0}, experiment=load,
        **tables,
    )  # fmt: skip
    stride = round(1.0 / deck.number("time_step"))
    start, _, *moving = deck.after(APART, f"velocity particles set 0.0 0.0 {KICK}", *[f"run {stride} post no"] * TIMES)
    found = np.array([(state - start)[:60, 3].mean() for state in moving])
    time = deck.number("time_step") * stride * np.arange(1, TIMES + 1)
    decay = 0.5 * DRAG / MASS
    omega = math.sqrt(STIFFNESS / MASS - decay**2)
    exact = KICK / omega * np.exp(-decay * time) * np.sin(omega * time)
    assert np.abs(found - exact).max() < INTEGRATION * KICK / omega


def test_a_punch_on_springs_that_relax_rebounds_as_the_linear_equation_says() -> None:
    """M z″ = −F, F = N k ((1 − share) z + share s), s′ = z′ − s/τ, until F = 0."""
    count, stiffness, mass, velocity, share, decay = 4, 2.5, 10.0, 0.1, 0.4, 2.0
    body = {"profile": {"kind": "flat_punch", "radius": 0.5 * count}, "reduction": "mdr", "lower": "rigid_plane"}
    impact = {"plate": {"mass": mass}, "experiment": {"kind": "impact", "velocity": velocity}}
    arm = {"terms": [{"share": share, "time": decay}]}
    tables = chains(1.0, stiffness, interaction=None, viscoelasticity=arm, bodies=body, **impact)
    results = run(tables).results

    def force(y: Any) -> Any:
        return count * stiffness * ((1.0 - share) * y[0] + share * y[2])

    def rates(_: float, y: Any) -> Any:
        return [y[1], -force(y) / mass, y[1] - y[2] / decay]

    exact = solve_ivp(rates, (0.0, 4.0), (0.0, velocity, 0.0), rtol=1e-10, atol=1e-12, dense_output=True)
    end = brentq(lambda t: force(exact.sol(t)), 2.0, 4.0)
    for name, value in (("restitution", -exact.sol(end)[1] / velocity), ("contact_time", end)):
        assert abs(results[name].value - value) <= results[name].uncertainty
    assert results["restitution"].uncertainty < SECOND


def test_a_title_is_only_a_title() -> None:
    """Whatever it says, data file and deck are read alike."""
    title = 'a # in it, R = 1000 µm, ${undefined} $x, three """ quotes, 日本, ends with &'
    deck = chain(title=title)
    (state,) = deck.after("run 0")
    assert len(state) == 4 * PARTICLES
    assert deck.files["system.data"].splitlines()[0] == f"# {title}"


@pytest.mark.parametrize("particles", [4, 401])
def test_anchors_of_a_plate_are_hardly_no_line_and_all_atoms_have_room(particles: int) -> None:
    """LAMMPS refuses a rigid body whose least moment of inertia is below 1e-7 of the largest; a line's is 0."""
    slide = {"kind": "slide", "normal_force": 0.1, "distance": 500.0}
    deck = chain(
        1e9, bodies={"particles": 2000, "upper_particles": particles}, horizontal={}, damping={"coefficient": "auto"},
        plate={"free": ["x", "z"]}, cantilever={"stiffness": 0.5, "velocity": 0.01}, experiment=slide,
    )  # fmt: skip
    apart = deck.atoms[ANCHORS] - deck.atoms[ANCHORS].mean(axis=0)
    moments = np.linalg.eigvalsh(np.eye(3) * (apart**2).sum() - apart.T @ apart)
    assert 1e-6 < moments[0] / moments[-1] < 1e-5
    places = np.concatenate([*deck.atoms.values()])
    assert (places - deck.box[0] >= [500.0, 0.999, 30.0]).all()
    assert (deck.box[1] - places >= [500.0, 0.999, 30.0]).all()
