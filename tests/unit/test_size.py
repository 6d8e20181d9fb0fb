"""Claims of what is refused as too large: the last number that is allowed is, and one more is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from contact1d import Scene, read_scene
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.model.chain import (
    in_words,
    require_digits,
    require_reach,
    require_rows,
    require_steps,
)
from contact1d.workflow.model.dynamics import DriveLeg
from tests.scenes import chains

MOST = 1_000_000
PLANE: dict[str, Any] = {"bodies": {"lower": "rigid_plane", "reduction": "mdr"}, "interaction": None}


def scene(experiment: dict[str, Any], **tables: Any) -> Scene:
    return read_scene(chains(100.0, experiment=experiment, **tables))


def with_rows(count: int) -> Scene:
    along = {"kind": "tangential", "normal_force": 1.0, "displacements": [0.1]}
    of = scene(along, **PLANE, friction={"coefficient": 0.3})
    return of.model_copy(update={"experiment": of.experiment.model_copy(update={"displacements": (0.1,) * count})})


def test_a_way_along_x_may_take_a_million_rows() -> None:
    require_rows(with_rows(MOST), math.inf, ())
    with pytest.raises(SettingsError, match="the tangential path would need 1000001 load steps"):
        require_rows(with_rows(MOST + 1), math.inf, ())


def test_a_drive_may_take_a_million_rows_in_all_its_legs() -> None:
    of = scene({"kind": "load", "force": 0.1})
    first, last, more = (DriveLeg(rows, 5, 0.1, 0.01) for rows in (MOST // 4, 3 * MOST // 4, 1))
    require_rows(of, math.inf, [first, last])
    with pytest.raises(SettingsError, match="the slide would need 1000001 load steps"):
        require_rows(of, math.inf, [first, last, more])


@pytest.mark.parametrize("places", [[3.0], [1.0, -1.0, 1.0], [-2.0, 1.0, 0.0, 0.0]])
def test_a_path_has_a_row_for_each_place_and_each_move_towards_the_other_body(places: list[float]) -> None:
    """All of these come nearer by 3 LU; the first place is 0."""
    of = scene({"kind": "path", "displacements": places})
    moves = MOST - len(places) - 1
    require_rows(of, 3.0 / (moves + 0.5), ())
    with pytest.raises(SettingsError, match="the path would need 1000001 load steps"):
        require_rows(of, 3.0 / (moves + 1.5), ())


@pytest.mark.parametrize("deepest", [0.01, -3.0, 900.0])
@pytest.mark.parametrize("particles", [3, 40, 301])
def test_springs_are_refused_whose_last_digit_is_a_tenth_of_what_may_be_left(particles: int, deepest: float) -> None:
    """A place is the height of the last particle and the displacement; half a unit of its last digit is round-off."""
    spacing, stiffness = 0.7, 1e4
    of = scene({"kind": "load", "force": 0.1}, bodies={"spacing": spacing, "bulk_stiffness": stiffness})
    last = float(of.bodies.height(np.array([0.5 * (particles - 1) * spacing]))[0])
    assert last == pytest.approx((0.5 * (particles - 1) * spacing) ** 2 / 200.0)
    left = stiffness * 0.5 * math.ulp(abs(deepest) + last)
    require_digits(of, particles, deepest, 10.001 * left)
    with pytest.raises(SettingsError, match="too stiff to resolve") as caught:
        require_digits(of, particles, deepest, 9.99 * left)
    told = float(str(caught.value).partition(" FU/LU, which")[0].split()[-1])
    assert told == 0.3 * stiffness


def test_without_another_chain_or_with_time_no_digit_is_too_few() -> None:
    load = {"kind": "load", "force": 0.1}
    for of in (
        scene(load, **PLANE),
        scene(load | {"method": "dynamic"}, damping={"coefficient": 0.3}, plate={}),
    ):
        require_digits(of, 40, 0.1, 1e-300)


def test_a_reach_over_as_many_particles_as_can_be_summed_over_is_possible() -> None:
    of = scene({"kind": "load", "force": 0.1}, bodies={"spacing": 0.8})
    require_reach(of, 2000.0)
    with pytest.raises(SettingsError, match=r"5000.2 opposite ones, at most 5000 are possible.* below 2000 LU"):
        require_reach(of, 2000.1)


def test_as_many_timesteps_as_lammps_counts_are_possible_and_none_at_all() -> None:
    require_steps([])
    require_steps([5, 2**31 - 1, 7])
    with pytest.raises(SettingsError, match="timesteps"):
        require_steps([5, 2**31, 7])


@pytest.mark.parametrize(
    ("cutoff", "felt", "least"), [(0.25, 3, 20_000), (2.0, 10, 20_000), (4.5, 20, 10_000), (9.5, 40, 5_000)]
)
def test_a_run_is_long_from_twenty_thousand_particles_or_as_many_times_ten_pairs_on(
    cutoff: float, felt: int, least: int
) -> None:
    of = scene({"kind": "load", "force": 0.1}, bodies={"spacing": 0.5})
    assert in_words(of, least - 1, cutoff) == ""
    assert f"{least} particles per body, each within reach of {felt} " in in_words(of, least, cutoff)
    plane = scene({"kind": "load", "force": 0.1}, **PLANE)
    assert in_words(plane, 19_999, 0.0) == ""
    assert "each within reach of 0 " in in_words(plane, 20_000, 0.0)
