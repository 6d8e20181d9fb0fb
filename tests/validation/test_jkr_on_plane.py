"""Claim: [adhesion] on a rigid plane is JKR's contact, and goes to it as spacing²; with a range Maugis and Dugdale's.

References: JKR's closed form; Kendall's punch; Maugis's equations of a paraboloid by t = arcsec(c/a)
(`validation/references/maugis.py`), which share no code with the program. What limits the tolerances of JKR: the
lattice. The particles' sum takes the force at the middle of each cell, which misses E* s² a/6R of F, and the edge
within a cell by a parabola. With a range the equations are solved, and no lattice errs.
"""

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d import run
from contact1d.analysis.theory.indenters import PowerLaw
from validation.references.maugis import LAMBDA_OVER_TABOR, Reduced
from validation.references.rigid_plane import rigid_plane_sum

Array = NDArray[np.float64]

R, E, W = 100.0, 1.0, 0.005
JKR = PowerLaw.sphere(R, E, W)
F_A, A_0 = JKR.pull_off_force(), JKR.zero_load_radius()
SPACING = 0.2
RMS, PULL_OFF = 1e-2, 2e-3
"""Asked of F over F_A, and of F_A."""
RADIUS = 1e-3
"""Of a over a₀: measured 3e-6; the parabola of an edge."""
CLOSE = 1e-6
"""Relative, of F_A and a₀ with a range; measured 3e-9."""
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
    """F and a of JKR's stable branch; 0 where fixed grips have lost the contact."""
    a = np.linspace(JKR.fixed_grips_radius(), 2.0 * A_0, 400_000)
    d = jkr_displacement(a)
    held = displacements > d[0]
    radius = np.where(held, np.interp(displacements, d, a), 0.0)
    return np.where(held, jkr_force(radius), 0.0), radius


def test_curve_is_jkrs_from_three_times_the_pull_off_force_to_fixed_grips() -> None:
    """Down, bodies jump in at touch; where they are held both times loading and unloading are the same."""
    done = run(tables(PATH))
    curve = done.curve
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
    found, last = done.results["fixed_grips_displacement"], JKR.displacement(JKR.fixed_grips_radius())
    assert abs(found.value - last) <= found.uncertainty == pytest.approx(0.5 * 0.85 / 170)
    down = curve.branch == "loading"
    apart = down & (curve.displacement < -ROUND_OFF)
    assert (curve.force[apart] == 0.0).all()
    touch = down & (np.abs(curve.displacement) < ROUND_OFF)
    assert curve.force[touch] == pytest.approx(-8.0 / 9.0 * F_A, rel=PULL_OFF)
    back = curve.branch == "unloading"
    again = down & (curve.displacement > ROUND_OFF) & (curve.displacement < curve.displacement.max())
    there = np.interp(curve.displacement[again], curve.displacement[back][::-1], curve.force[back][::-1])
    assert curve.force[again] == pytest.approx(there, abs=1e-6 * F_A)


def test_a_contact_that_is_not_let_go_of_comes_back_the_same_way() -> None:
    """Before fixed grips lose the contact, loading again is the unloading path; after, not before the next touch."""
    places = [0.2, -0.1, -0.2, -0.1, 0.2, -0.25, -0.1, 0.0, 0.2]
    force = run(tables({"kind": "path", "displacements": places})).curve.force
    assert force[3] == force[1]
    assert force[4] == force[0]
    assert force[5] == force[6] == 0.0
    assert force[7] == pytest.approx(-8.0 / 9.0 * F_A, rel=PULL_OFF)
    assert force[8] == force[0]


def test_convergence_towards_jkr() -> None:
    """rms of F over 3 F_A to fixed grips, edges everywhere between two particles; exponent of the spacing."""
    spacings = A_0 / np.asarray([10.0, 20.0, 40.0, 80.0])
    a = np.linspace(0.32, 1.18, 97) * A_0
    wanted = jkr_force(a)
    off = []
    for spacing in spacings:
        path = {"kind": "path", "displacements": [1.1 * JKR.displacement(a[-1]), *jkr_displacement(a[::-1])]}
        force = run(tables(path, float(spacing))).curve.force[1:]
        off.append(float(np.sqrt(np.mean((force[::-1] - wanted) ** 2))) / F_A)
    assert float(np.polyfit(np.log(spacings), np.log(off), 1)[0]) >= RATE
    assert off[0] < RMS  # with 10 particles in a₀


def test_rows_of_a_punch_bracket_where_it_lets_go() -> None:
    """Between two rows all of F_A = √(8πE*Wa³) goes: it and its place are known to half a row; F = 0 is a contact."""
    radius = 10.0
    path = {"kind": "path", "displacements": {"from": 0.5, "to": -1.0, "steps": 60, "return": False}}
    profile = {"kind": "flat_punch", "radius": radius}
    known = run(tables(path, 1.0, profile=profile, bulk_stiffness=E)).results
    assert known.zero_load_radius.value == known.critical_radius.value == radius
    kendall = math.sqrt(8.0 * math.pi * E * W * radius**3)
    for name, value in (("adhesion_force", kendall), ("fixed_grips_displacement", -kendall / (2.0 * E * radius))):
        assert abs(known[name].value - value) <= known[name].uncertainty <= 0.05 * abs(value), name


def test_no_energy_is_hertz_to_round_off() -> None:
    scene = tables({"kind": "path", "displacements": [-0.1, 0.0, 0.1, 0.37, 0.2, -0.1]}, work=0.0)
    elastic = {name: table for name, table in scene.items() if name != "adhesion"}
    ours, other = run(scene), run(elastic)
    x = ours.profiles["final"].x
    exact = [rigid_plane_sum(d, x, 0.5 * R, E * SPACING) if d > 0.0 else 0.0 for d in ours.curve.displacement]
    assert ours.curve.force == pytest.approx(exact, rel=ROUND_OFF)
    assert other.curve.force == pytest.approx(ours.curve.force, rel=ROUND_OFF)
    assert ours.results.keys() == other.results.keys()


@pytest.mark.parametrize("steps", [10, 60])
def test_coarse_steps_of_a_path_are_in_the_uncertainty(steps: int) -> None:
    """They miss much of the largest tension; each uncertainty ÷ 3 would leave some of these errors out."""
    path = {"kind": "path", "displacements": {"from": 0.3, "to": -0.2, "steps": steps, "return": False}}
    results = run(tables(path, 0.1)).results
    for name, value in (("adhesion_force", F_A), ("zero_load_radius", A_0)):
        if name in results:  # ten steps pass F = 0 between a contact and none
            assert abs(results[name].value - value) <= results[name].uncertainty, name


def maugis(tabor: float, experiment: dict[str, Any]) -> tuple[dict[str, Any], float]:
    """A scene of this Tabor parameter, and its range."""
    reach = (R * W**2 / E**2) ** (1.0 / 3.0) / tabor
    return tables(experiment) | {"adhesion": {"work_of_adhesion": W, "range": reach}}, reach


@pytest.mark.parametrize("tabor", [0.01, 1.0])
def test_pull_off_with_a_range_is_maugis_s(tabor: float) -> None:
    done = run(maugis(tabor, {"kind": "pull_off", "preload": 2.0})[0])
    exact, results = Reduced(LAMBDA_OVER_TABOR * tabor), done.results
    load, length = math.pi * W * R, (0.75 * math.pi * W * R**2 / E) ** (1.0 / 3.0)
    assert results.adhesion_force.value == pytest.approx(-load * exact.critical.load, rel=CLOSE)
    assert results.zero_load_radius.value == pytest.approx(length * exact.free.a, rel=CLOSE)
    assert results.cohesive_radius.value == pytest.approx(length * exact.free.c, rel=CLOSE)
    assert results.tabor_parameter.value == pytest.approx(tabor, rel=1e-12)
    for a, c, force in zip(*(done.curve[name] for name in ("contact_radius", "cohesive_radius", "force")), strict=True):
        if a > 0.0:
            state = exact.of_radius(a / length)
            assert force == pytest.approx(load * state.load, abs=ROUND_OFF * load)
            assert c == pytest.approx(length * state.c, rel=ROUND_OFF)


def test_a_stiff_contact_has_no_limit_point_but_that_of_the_attraction() -> None:
    """Snap-in at d = −h₀, and attracted states with a = 0 in retraction; a soft one is lost at once."""
    for tabor, gradual in ((0.1, True), (5.0, False)):
        scene, reach = maugis(tabor, {"kind": "path"})
        scene["experiment"] |= {"displacements": {"from": -1.5 * reach - 0.3, "to": 0.2, "steps": 80}}
        curve = run(scene).curve
        into = curve.branch == "loading"
        first = curve.displacement[into][curve.force[into] != 0.0][0]
        step = float(np.diff(curve.displacement[into])[0])
        assert 0.0 <= first + reach < step
        attracted = (~into) & (curve.contact_radius == 0.0) & (curve.force < 0.0)
        assert attracted.any() == gradual
        last = curve.displacement[~into][curve.force[~into] != 0.0][-1]
        assert (last < -reach + step) == gradual or last < -reach
