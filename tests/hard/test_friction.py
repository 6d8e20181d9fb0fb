"""Hard cases of friction on the rigid plane: no friction and endless friction, no way, no load, edges, and what is
refused in words before anything runs.
"""

import math
from typing import Any

import numpy as np
import pytest

from contact1d import Run, SceneError, read_scene, run
from tests.validation.test_tangential import EXACT, MU, RADIUS, exact, tables
from validation.row import tables_beside

LOAD = 40.0


def value(run: Run, name: str) -> float:
    return run.results[name].value


def test_without_friction_nothing_resists_and_endless_friction_gives_all_back() -> None:
    places = [0.1, -0.3, 0.2]
    none, endless = (run(tables(places, coefficient=mu)) for mu in (0.0, 1e6))
    assert none.friction["tangential_force"].tolist() == [0.0] * 3
    touching = int((endless.profiles["final"].pressure > 0.0).sum())
    assert endless.friction["tangential_force"] == pytest.approx(0.8 * touching * np.array(places), rel=EXACT)
    assert value(none, "dissipated_energy") == value(endless, "dissipated_energy") == value(none, "stick_radius") == 0.0
    assert value(endless, "stick_radius") == pytest.approx(value(endless, "contact_radius"), rel=1e-3)


def test_a_load_that_is_taken_away_while_stuck_takes_all_force_with_it() -> None:
    """All that the springs held is dissipated, little by little from the edge inwards; then the contact begins anew."""
    done = run(tables([0.1, 0.1, 0.15, 0.15], normal_force=[LOAD, 0.0, 0.0, LOAD]))
    forces, columns = done.friction["tangential_force"], done.friction
    assert forces[0] > 0.0
    assert forces[1:] == pytest.approx([0.0] * 3, abs=EXACT * MU * LOAD)
    assert done.curve.contact_radius[1:3].tolist() == pytest.approx([math.nan] * 2, nan_ok=True)
    assert columns["stick_radius"][1:3].tolist() == [0.0, 0.0]
    # By 0.1 from the start nothing more can have been put in than F_x times the way.
    assert 0.5 * forces[0] * 0.1 < columns["dissipated_energy"][1] < forces[0] * 0.1
    assert columns["dissipated_energy"][3] == columns["dissipated_energy"][1]


def test_a_contact_that_grows_while_it_is_drawn_sticks_within_the_cone_of_friction() -> None:
    """On one straight way from the first touch F_x/F_N = k_t u/k_n d: below μ nothing slips, beyond it all does."""
    within, beyond = (run(tables([0.0, way], normal_displacement=[0.0, 0.9])) for way in (0.27, 0.5))
    assert value(within, "tangential_force") == pytest.approx(0.8 * 0.3 * value(within, "normal_force"), rel=1e-9)
    assert value(within, "dissipated_energy") == pytest.approx(0.0, abs=1e-12)
    assert value(within, "stick_radius") == pytest.approx(value(within, "contact_radius"), rel=1e-3)
    assert value(beyond, "tangential_force") == pytest.approx(MU * value(beyond, "normal_force"), rel=1e-12)
    assert value(beyond, "stick_radius") == 0.0


WAYS = tables_beside(__file__) | {"fifty cycles": [(0.9, place) for place in (0.15, -0.15) * 50]}


@pytest.mark.parametrize("name", WAYS)
def test_on_a_hard_way_every_row_is_the_sum_over_springs_with_sliders(name: str) -> None:
    depths, places = map(list, zip(*WAYS[name], strict=True))
    done = run(tables(places, normal_displacement=depths))
    forces, lost = exact(done)
    unit = EXACT * max(MU * max(done.friction["normal_force"]), 1e-9)
    assert done.friction["tangential_force"] == pytest.approx(forces, abs=unit)
    assert done.friction["dissipated_energy"] == pytest.approx(lost, abs=unit)


@pytest.mark.parametrize("nudge", [-1e-12, 1e-12])
def test_a_particle_on_the_edge_of_the_contact_or_of_its_stick_zone(nudge: float) -> None:
    """d = h(10.5), where a particle just touches, and then k_t u = μ k_n (d − h(5.5)), where one just slips."""
    depth = 10.5**2 / RADIUS + nudge
    place = MU / 0.8 * (10.5**2 - 5.5**2) / RADIUS + nudge
    done = run(tables([place, 0.5 * place, place], normal_displacement=depth))
    forces, _ = exact(done)
    assert done.friction["tangential_force"] == pytest.approx(forces, abs=EXACT * forces[0])
    assert value(done, "contact_radius") == pytest.approx(10.5, abs=1e-3)
    assert done.friction["stick_radius"][0] == pytest.approx(5.5, abs=1e-3)


def test_a_flat_punch_sticks_and_then_slips_as_a_whole() -> None:
    body = {"profile": {"kind": "flat_punch", "radius": 10.0}}
    punch = tables([0.1, 0.74, 0.76, 0.5], normal_force=LOAD, bodies=body)
    done = run(punch)
    # 20 particles: each carries 2 FU and gives 0.8 u up to 0.6 FU.
    expected = [1.6, 11.84, 12.0, 12.0 - 20.0 * 0.8 * 0.26]
    assert done.friction["tangential_force"] == pytest.approx(expected, rel=EXACT)
    assert done.friction["stick_radius"].tolist() == [10.0, 10.0, 0.0, 10.0]
    assert value(done, "dissipated_energy") == pytest.approx(12.0 * 0.01, rel=1e-9)


def test_so_small_a_load_that_two_particles_carry_it() -> None:
    """Each carries its share and gives as its spring and slider say."""
    load = 1e-6
    done = run(tables([0.1 * load, 2.0 * load, 1.5 * load], normal_force=load))
    assert int((done.profiles["final"].pressure > 0.0).sum()) == 2
    assert done.friction["tangential_force"] == pytest.approx(exact(done)[0], abs=1e-6 * load)


@pytest.mark.parametrize(
    ("load", "words"),
    [
        ({"normal_displacement": None}, "experiment.normal_force: missing"),
        ({"normal_force": 1.0, "normal_displacement": 1.0}, "not together with normal_force"),
        ({"normal_force": [1.0]}, "as many as there are displacements, 2"),
        ({"normal_displacement": -1.0}, "never touch"),
    ],
)
def test_a_load_that_is_none_or_two_or_too_many_is_refused(load: dict[str, Any], words: str) -> None:
    with pytest.raises(SceneError, match=words) as caught:
        read_scene(tables([0.1, 0.2], **load))
    assert len(caught.value.problems) == 1
