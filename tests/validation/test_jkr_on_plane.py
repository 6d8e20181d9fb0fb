"""Claim: [adhesion] on a rigid plane is JKR's contact, and goes to it as spacing²; also a cone's and that of r⁴.

References: JKR's closed form; h(a) = κ c aⁿ − √(2πWa/E*), F = 2n/(n + 1) κ c E* aⁿ⁺¹ − √(8πE*Wa³) for z = c rⁿ, by
scipy's minimiser and root finder. What limits the tolerances: the lattice. The particles' sum takes the force at the
middle of each cell, which misses E* s² a/6R of F, and the edge within a cell by a parabola.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d import Run
from contact1d.analysis.theory.indenters import PowerLaw
from validation.references.rigid_plane import rigid_plane_sum

RunTables = Callable[[dict[str, Any]], Run]
Array = NDArray[np.float64]

R, E, W = 100.0, 1.0, 0.005
JKR = PowerLaw.sphere(R, E, W)
F_A, A_0 = JKR.pull_off_force(), JKR.zero_load_radius()
SPACING = 0.2
RMS, PULL_OFF = 1e-2, 2e-3
"""Asked of F over F_A, and of F_A."""
RADIUS = 1e-3
"""Of a over a₀: measured 3e-6; the parabola of an edge."""
RATE = 1.8
ROUND_OFF = 1e-9
PATH = {"kind": "path", "displacements": {"from": -0.25, "to": 0.6, "steps": 170}}


def tables(experiment: dict[str, Any], spacing: float = SPACING, work: float = W, **bodies: Any) -> dict[str, Any]:
    profile = {"kind": "parabola", "radius": R}
    plane = {"particles": "auto", "spacing": spacing, "profile": profile, "reduction": "mdr", "lower": "rigid_plane"}
    return {
        "title": "JKR",
        "bodies": plane | {"bulk_stiffness": E * spacing} | bodies,
        "adhesion": {"work_of_adhesion": work},
        "experiment": experiment,
    }


def jkr_displacement(a: Array) -> Array:
    """d(a) of JKR."""
    return a**2 / R - np.sqrt(2.0 * math.pi * W * a / E)


def jkr_force(a: Array) -> Array:
    """F(a) of JKR."""
    return 4.0 * E * a**3 / (3.0 * R) - np.sqrt(8.0 * math.pi * E * W * a**3)


def jkr_at(displacements: Array) -> tuple[Array, Array]:
    """F and a of JKR's stable branch; 0 where fixed grips have let go."""
    a = np.linspace(JKR.fixed_grips_radius(), 2.0 * A_0, 400_000)
    d = jkr_displacement(a)
    held = displacements > d[0]
    radius = np.where(held, np.interp(displacements, d, a), 0.0)
    return np.where(held, jkr_force(radius), 0.0), radius


def test_curve_is_jkrs_from_three_times_the_pull_off_force_to_fixed_grips(run_tables: RunTables) -> None:
    curve = run_tables(tables(PATH)).curve
    force, radius = jkr_at(curve.displacement)
    back = (curve.branch == "unloading") & (force < 3.0 * F_A)
    held = back & (radius > 0.0)
    assert curve.force[held].max() > 1.8 * F_A
    assert np.sqrt(np.mean((curve.force - force)[held] ** 2)) < RMS * F_A
    assert np.sqrt(np.mean((curve.contact_radius - radius)[held] ** 2)) < RADIUS * A_0
    assert (curve.force[back & ~held] == 0.0).all()
    assert np.isnan(curve.contact_radius[back & ~held]).all()
    assert held.sum() > 100
    off = curve.contact_radius[held] - radius[held]
    assert (np.abs(off) < 3.0 * curve.contact_radius_uncertainty[held] + ROUND_OFF).mean() > 0.95


def test_bodies_jump_in_at_touch_and_then_there_is_one_curve(run_tables: RunTables) -> None:
    """Loading and unloading are the same where the bodies are held both times."""
    done = run_tables(tables(PATH))
    curve = done.curve
    down, back = (curve.branch == name for name in ("loading", "unloading"))
    apart = down & (curve.displacement < -ROUND_OFF)
    assert (curve.force[apart] == 0.0).all()
    touch = down & (np.abs(curve.displacement) < ROUND_OFF)
    assert curve.force[touch] == pytest.approx(-8.0 / 9.0 * F_A, rel=PULL_OFF)
    again = down & (curve.displacement > ROUND_OFF) & (curve.displacement < curve.displacement.max())
    there = np.interp(curve.displacement[again], curve.displacement[back][::-1], curve.force[back][::-1])
    assert curve.force[again] == pytest.approx(there, abs=1e-6 * F_A)


def test_fixed_grips_let_go_between_two_rows(run_tables: RunTables) -> None:
    found = run_tables(tables(PATH)).results["fixed_grips_displacement"]
    last = JKR.displacement(JKR.fixed_grips_radius())
    assert abs(found.value - last) <= found.uncertainty == pytest.approx(0.5 * 0.85 / 170)


def test_a_contact_that_is_not_let_go_of_comes_back_the_same_way(run_tables: RunTables) -> None:
    """Before fixed grips let go, down again is the way up; after, not before the next touch."""
    places = [0.2, -0.1, -0.2, -0.1, 0.2, -0.25, -0.1, 0.0, 0.2]
    states = run_tables(tables({"kind": "path", "displacements": places})).outcome.states
    force = [state.force for state in states]
    assert force[3] == force[1]
    assert force[4] == force[0]
    assert force[5] == force[6] == 0.0
    assert force[7] == pytest.approx(-8.0 / 9.0 * F_A, rel=PULL_OFF)
    assert force[8] == force[0]


def test_convergence_towards_jkr(run_tables: RunTables) -> None:
    """rms of F over 3 F_A to fixed grips, edges everywhere between two particles; exponent of the spacing."""
    spacings = A_0 / np.asarray([10.0, 20.0, 40.0, 80.0])
    a = np.linspace(0.32, 1.18, 97) * A_0
    wanted = jkr_force(a)
    off = []
    for spacing in spacings:
        path = {"kind": "path", "displacements": [1.1 * JKR.displacement(a[-1]), *jkr_displacement(a[::-1])]}
        states = run_tables(tables(path, float(spacing))).outcome.states[1:]
        off.append(float(np.sqrt(np.mean(([state.force for state in states][::-1] - wanted) ** 2))) / F_A)
    assert float(np.polyfit(np.log(spacings), np.log(off), 1)[0]) >= RATE
    assert off[0] < RMS  # with 10 particles in a₀


@pytest.mark.parametrize("force", [7.0, 1.0, 0.0, -1.5, -2.3, -2.35])
def test_load(run_tables: RunTables, force: float) -> None:
    """JKR's stable state under a force, within what the run claims; a tension beyond F_A is told."""
    known = run_tables(tables({"kind": "load", "force": force})).results
    a = JKR.contact_radius(force)
    assert abs(known["contact_radius"].value - a) <= known["contact_radius"].uncertainty
    assert abs(known["displacement"].value - JKR.displacement(a)) <= known["displacement"].uncertainty


PUNCH = 10.0
KENDALL = math.sqrt(8.0 * math.pi * E * W * PUNCH**3)
"""F_A = √(8πE*Wa³) of a flat punch; before that F = 2E*ad."""


def punch(experiment: dict[str, Any], spacing: float) -> dict[str, Any]:
    profile = {"kind": "flat_punch", "radius": PUNCH}
    return tables(experiment, spacing, profile=profile, bulk_stiffness=E * spacing)


def test_rows_of_a_punch_bracket_where_it_lets_go(run_tables: RunTables) -> None:
    """Between two rows all of the tension goes: F_A and its place are known to half a row; F = 0 is a contact, too."""
    path = {"kind": "path", "displacements": {"from": 0.5, "to": -1.0, "steps": 60, "return": False}}
    known = run_tables(punch(path, 1.0)).results
    assert known["zero_load_radius"].value == known["critical_radius"].value == PUNCH
    for name, value in (("adhesion_force", KENDALL), ("fixed_grips_displacement", -KENDALL / (2.0 * E * PUNCH))):
        assert abs(known[name].value - value) <= known[name].uncertainty <= 0.05 * abs(value), name


def test_no_energy_is_hertz_to_round_off(run_tables: RunTables) -> None:
    path = {"kind": "path", "displacements": [-0.1, 0.0, 0.1, 0.37, 0.2, -0.1]}
    scene = tables(path, work=0.0)
    without = {name: table for name, table in scene.items() if name != "adhesion"}
    adhesive, elastic = run_tables(scene), run_tables(without)
    for one, other in zip(adhesive.outcome.states, elastic.outcome.states, strict=True):
        x = one.profile.x
        exact = rigid_plane_sum(one.displacement, x, 0.5 * R, E * SPACING) if one.displacement > 0.0 else 0.0
        assert one.force == pytest.approx(exact, rel=ROUND_OFF)
        assert other.force == pytest.approx(one.force, rel=ROUND_OFF)
    assert adhesive.results.keys() == elastic.results.keys()
