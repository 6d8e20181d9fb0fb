"""Springs with sliders of the settings: against the reference's, which goes through particles one by one."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contact1d.workflow.model.friction import Sliders, sliders_of, stops, without_rests
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.scene import Scene, Tangential, scene_from_dict
from validation.references.spring_sliders import SpringSliders, displacement_under

ROUND_OFF = 1e-12
"""Relative to the largest force: sums over 30 particles."""
MU, NORMAL, TANGENTIAL = 0.3, 0.9, 0.7


def chain() -> Sliders:
    x = np.arange(-14.5, 15.0)
    return Sliders(x, x**2 / 200.0, NORMAL, TANGENTIAL, MU)


@given(force=st.floats(1e-6, 1e4))
def test_a_displacement_carries_its_force(force: float) -> None:
    found = chain().displacement_under(force)
    assert found == pytest.approx(displacement_under(force, chain().heights.tolist(), NORMAL), rel=ROUND_OFF)
    assert float(chain().normal_forces(found).sum()) == pytest.approx(force, rel=1e-9)


def test_no_force_stands_clear_of_the_plane() -> None:
    free = chain().displacement_under(0.0)
    assert not chain().normal_forces(free).any()
    assert 0.0 < chain().heights.min() - free < 1e-8


def test_touches_are_heights_passed_on_the_way_in_its_order() -> None:
    heights = np.unique(chain().heights)
    assert chain().touches(0.0, 0.1) == [h for h in heights.tolist() if h < 0.1]
    assert chain().touches(0.1, 0.0) == chain().touches(0.0, 0.1)[::-1]
    assert chain().touches(0.05, 0.05) == []
    assert chain().touches(float(heights[2]), float(heights[6])) == heights[3:6].tolist()


depths, ways = st.floats(-0.2, 1.0), st.floats(-2.0, 2.0)


@given(way=st.lists(st.tuples(depths, ways), min_size=1, max_size=6))
def test_any_way_ends_as_the_reference_says(way: list[tuple[float, float]]) -> None:
    own, reference = chain(), SpringSliders(chain().heights.tolist(), NORMAL, TANGENTIAL, MU)
    stretch = [(way[0][0], 0.0), *way]
    for stop in stretch:
        reference.move(*stop)
    found = own.at_end(stretch)
    assert found["tangential_force"] == pytest.approx(reference.tangential_force, abs=ROUND_OFF * 10.0)
    assert found["dissipated_energy"] == pytest.approx(reference.dissipated, abs=ROUND_OFF * 100.0)
    assert found["normal_force"] == pytest.approx(reference.normal_force, abs=ROUND_OFF * 10.0)


@given(places=st.lists(st.sampled_from([-0.3, -0.1, 0.0, 0.1, 0.1, 0.2, 0.5]), min_size=1, max_size=12))
def test_stops_on_a_straight_way_change_nothing(places: list[float]) -> None:
    way = [(0.4, 0.0), *((0.4, place) for place in places)]
    fewer = without_rests(way)
    assert (fewer[0], fewer[-1]) == (way[0], way[-1])
    reference = SpringSliders(chain().heights.tolist(), NORMAL, TANGENTIAL, MU)
    for stop in way:
        reference.move(*stop)
    found = chain().at_end(way)
    assert found["tangential_force"] == pytest.approx(reference.tangential_force, abs=ROUND_OFF * 10.0)
    assert found["dissipated_energy"] == pytest.approx(reference.dissipated, abs=ROUND_OFF * 100.0)


def test_a_way_out_and_back_is_its_turns() -> None:
    way = [(0.4, place) for place in (0.0, 0.0, 0.1, 0.2, 0.2, 0.3, 0.1, -0.1, -0.1)]
    assert [place for _, place in without_rests(way)] == [0.0, 0.0, 0.3, -0.1]
    lifted = [(0.4, 0.0), (0.4, 0.1), (0.5, 0.2), (0.5, 0.3), (0.5, 0.4)]
    assert without_rests(lifted) == [(0.4, 0.0), (0.4, 0.1), (0.5, 0.2), (0.5, 0.4)]


def scene_of(**load: object) -> Scene:
    bodies = {"particles": 40, "spacing": 1.0, "profile": {"kind": "parabola", "radius": 100.0}, "bulk_stiffness": 1.0,
              "lower": "rigid_plane", "reduction": "mdr"}  # fmt: skip
    experiment = {"kind": "tangential", "displacements": [0.1, 0.2, 0.0]} | load
    return scene_from_dict({"title": "t", "bodies": bodies, "friction": {"coefficient": MU}, "experiment": experiment})


def test_one_load_or_one_for_each_row_and_first_the_load_comes_on() -> None:
    for load in ({"normal_force": 2.0}, {"normal_force": [2.0, 3.0, 2.0]}, {"normal_displacement": [0.1, 0.2, 0.1]}):
        scene = scene_of(**load)
        assert isinstance(scene.experiment, Tangential)
        own = sliders_of(scene, np.arange(-19.5, 20.0))
        found = stops(scene.experiment, own)
        assert [place for _, place in found] == [0.0, 0.1, 0.2, 0.0]
        assert found[0][0] == found[1][0] == found[3][0]
        if "normal_force" in load:
            assert float(own.normal_forces(found[1][0]).sum()) == pytest.approx(2.0, rel=1e-12)
        else:
            assert found[2][0] == 0.2


def test_particles_are_moved_with_their_body_so_that_the_plane_has_their_whole_stiffness() -> None:
    settings = settings_for(scene_of(normal_force=2.0))
    assert (settings.plane_stiffness, settings.bulk_stiffness) == (1.0, 1.0)


def test_after_a_turn_all_sticks_again_and_on_the_way_out_only_the_middle() -> None:
    depth, out = 0.5, 1.0
    edge = np.sqrt(200.0 * depth)
    all_slips = chain().at_end([(depth, 0.0), (depth, out)])
    assert all_slips["stick_radius"] == 0.0
    assert chain().at_end([(depth, 0.0), (depth, out), (depth, out - 1e-6)])["stick_radius"] > 0.95 * edge
    part = chain().at_end([(depth, 0.0), (depth, -0.05)])["stick_radius"]
    assert part == pytest.approx(np.sqrt(edge**2 - 200.0 * TANGENTIAL * 0.05 / (MU * NORMAL)), rel=0.01)


@pytest.mark.parametrize("parts", [1, 2, 5])
def test_errors_are_held_against_the_force_and_the_work_of_all_that_sticks(parts: int) -> None:
    """N springs that hold: the force N k u and the work N k u²/2, however many stops the way has; back adds as much."""
    held = Sliders(chain().x, chain().heights, NORMAL, TANGENTIAL, 1e6)
    count, way = len(held.x), 0.01
    there = [(5.0, float(u)) for u in np.linspace(0.0, way, parts + 1)]
    sizes = held.sizes(there)
    assert sizes["tangential_force"] == pytest.approx(count * TANGENTIAL * way)
    assert sizes["dissipated_energy"] == pytest.approx(0.5 * count * TANGENTIAL * way**2)
    back = held.sizes([*there, (5.0, 0.0)])
    assert back["tangential_force"] == sizes["tangential_force"]
    assert back["dissipated_energy"] == pytest.approx(2.0 * sizes["dissipated_energy"])


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_clear_of_the_plane_is_by_a_share_of_the_bodys_own_height(scale: float) -> None:
    heights = scale * (3.0 + np.arange(-14.0, 16.0) ** 2 / 200.0)  # the last one alone is the highest
    free = Sliders(scale * chain().x, heights, NORMAL, TANGENTIAL, MU).displacement_under(0.0)
    assert (heights.min() - free) / np.ptp(heights) == pytest.approx(1e-9, rel=0.01)
    flat = Sliders(scale * chain().x, 0.0 * heights, NORMAL, TANGENTIAL, MU).displacement_under(0.0)
    assert -1.5e-9 < flat < 0.0


@given(way=st.lists(st.tuples(depths, ways), min_size=1, max_size=6))
def test_sizes_are_those_of_each_particle_one_after_the_other(way: list[tuple[float, float]]) -> None:
    """Σ|s| at most, and Σ|s||Δu| with the mean of both ends of each stretch; particles stick within μf of its end."""
    stretch = [(way[0][0], 0.0), *way]
    shear, before, work, most = [0.0] * 30, 0.0, 0.0, 0.0
    for (old, start), (new, place) in pairwise(stretch):
        for i, height in enumerate(chain().heights.tolist()):
            first, last = (MU * NORMAL * max(depth - height, 0.0) for depth in (old, new))
            moved = shear[i] + (TANGENTIAL * (place - start) if first > 0.0 else 0.0)
            shear[i] = min(max(moved, -last), last)
        after = sum(abs(one) for one in shear)
        work += 0.5 * (before + after) * abs(place - start)
        before, most = after, max(most, after)
    told = chain().sizes(stretch)
    assert told["tangential_force"] == pytest.approx(most, abs=1e-9)
    assert told["dissipated_energy"] == pytest.approx(work, abs=1e-9)


@pytest.mark.parametrize("count", [150, 201, 999])
def test_sizes_of_many_particles_are_told_by_some_hundred_of_them(count: int) -> None:
    x = np.linspace(-15.0, 15.0, count)
    many = Sliders(x, x**2 / 200.0, NORMAL, TANGENTIAL, MU)
    way = [(0.9, 0.0), (0.9, 0.1), (0.9, -0.05)]
    most = abs(many.at_end(way[:2])["tangential_force"])
    assert many.sizes(way)["tangential_force"] == pytest.approx(most, rel=0.03)
    normal = NORMAL * np.maximum(0.9 - x**2 / 200.0, 0.0).sum()
    assert many.at_end(way)["normal_force"] == pytest.approx(normal, rel=1e-9)
