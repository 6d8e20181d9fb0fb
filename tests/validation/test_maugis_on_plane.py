"""Claim: [adhesion] with a range is the contact of Maugis and Dugdale, at every spacing.

References: Maugis's equations of a paraboloid by t = arcsec(c/a) (`validation/references/maugis.py`), which share no
code with the program; DMT's 2πWR and JKR's 1.5πWR. A paraboloid R = 100 LU, E* = 1 FU/LU², W = 0.005 FU/LU.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from contact1d import Run, SceneError, read_scene
from validation.references.maugis import LAMBDA_OVER_TABOR, Reduced

RunTables = Callable[[dict[str, Any]], Run]

R, E, W = 100.0, 1.0, 0.005
LOAD = math.pi * W * R
LENGTH = (0.75 * math.pi * W * R**2 / E) ** (1.0 / 3.0)
CLOSE = 1e-6
"""Relative, of F_A and a₀; measured 3e-9: the equations are solved, and no lattice errs."""
CURVE = 1e-9
"""Of F(a), over πWR; measured 7e-12."""


def tables(tabor: float, experiment: dict[str, Any], spacing: float = 0.2, **adhesion: Any) -> dict[str, Any]:
    profile = {"kind": "parabola", "radius": R}
    plane = {"particles": "auto", "spacing": spacing, "profile": profile, "reduction": "mdr", "lower": "rigid_plane"}
    own = {"work_of_adhesion": W, "range": (R * W**2 / E**2) ** (1.0 / 3.0) / tabor}
    return {
        "title": "Maugis",
        "bodies": plane | {"bulk_stiffness": E * spacing},
        "adhesion": own | adhesion,
        "experiment": experiment,
    }


PULL = {"kind": "pull_off", "preload": 2.0}


@pytest.mark.parametrize("tabor", [0.01, 1.0, 100.0])
def test_pull_off_is_maugis_s(tabor: float, run_tables: RunTables) -> None:
    run = run_tables(tables(tabor, PULL))
    exact, results = Reduced(LAMBDA_OVER_TABOR * tabor), run.results
    assert results.adhesion_force.value == pytest.approx(-LOAD * exact.critical.load, rel=CLOSE)
    assert results.zero_load_radius.value == pytest.approx(LENGTH * exact.free.a, rel=CLOSE)
    assert results.cohesive_radius.value == pytest.approx(LENGTH * exact.free.c, rel=CLOSE)
    assert results.tabor_parameter.value == pytest.approx(tabor, rel=1e-12)
    for a, c, force in zip(*(run.curve[name] for name in ("contact_radius", "cohesive_radius", "force")), strict=True):
        if a > 0.0:
            state = exact.of_radius(a / LENGTH)
            assert force == pytest.approx(LOAD * state.load, abs=CURVE * LOAD)
            assert c == pytest.approx(LENGTH * state.c, rel=1e-9)


def test_a_particle_on_the_axis_has_the_cells_of_both_sides(run_tables: RunTables) -> None:
    """Of an odd number one stands there; a force is that of an even number, to round-off of sixty cells."""
    path = {"kind": "path", "displacements": [0.05, 0.3, -0.05]}
    forces = []
    for count in (60, 61):
        scene = tables(1.0, path, spacing=1.0)
        scene["bodies"]["particles"] = count
        forces.append(run_tables(scene).curve.force)
    assert forces[1] == pytest.approx(forces[0], rel=CURVE)


def test_a_stiff_contact_has_no_limit_point_but_that_of_the_attraction(run_tables: RunTables) -> None:
    """Snap-in at d = −h₀, and attracted states with a = 0 on the way out; a soft one is lost at once."""
    for tabor, gradual in ((0.1, True), (5.0, False)):
        reach = (R * W**2 / E**2) ** (1.0 / 3.0) / tabor
        path = {"kind": "path", "displacements": {"from": -1.5 * reach - 0.3, "to": 0.2, "steps": 200}}
        curve = run_tables(tables(tabor, path)).curve
        into = curve.branch == "loading"
        first = curve.displacement[into][curve.force[into] != 0.0][0]
        step = float(np.diff(curve.displacement[into])[0])
        assert 0.0 <= first + reach < step
        attracted = (~into) & (curve.contact_radius == 0.0) & (curve.force < 0.0)
        assert attracted.any() == gradual
        last = curve.displacement[~into][curve.force[~into] != 0.0][-1]
        assert (last < -reach + step) == gradual or last < -reach


def test_what_a_range_excludes_is_refused_in_a_sentence() -> None:
    scene = tables(1.0, PULL)
    scene["bodies"] |= {"profile": {"kind": "flat_punch", "radius": 5.0}}
    with pytest.raises(SceneError, match=r"adhesion\.range .* not with a flat punch"):
        read_scene(scene)
    with pytest.raises(SceneError, match=r"adhesion\.range .* only of contacts at rest"):
        read_scene(tables(1.0, {"kind": "load", "force": 1.0}) | {"plate": {}, "damping": {"coefficient": 0.1}})


def test_the_critical_state_of_a_cone_is_at_its_force_maximum(run_tables: RunTables) -> None:
    """A neighbour 4e-4 wider has the same force but for 1e-7 of it, and another pressure at its edge."""
    cone = tables(1.0, {"kind": "pull_off", "preload": 11.544759})
    cone["bodies"] |= {"spacing": 0.8998386585599826, "bulk_stiffness": 0.8998386585599826}
    cone["bodies"]["profile"] = {"kind": "cone", "slope": 6.111643282e-4}
    cone["adhesion"] = {"work_of_adhesion": 7.287191e-7, "range": 4.97792e-3}
    run = run_tables(cone)
    at = list(run.curve["displacement"]).index(run.outcome.marked["critical"].displacement)
    assert run.curve["contact_radius"][at] == pytest.approx(run.results.critical_radius.value, rel=1e-5)
