"""How `bodies.spacing = "auto"` is looked for: tries, what counts, what is advised, and where particles are counted."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import numpy as np
import pytest

from contact1d import SettingsError
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings import spacing
from contact1d.workflow.settings.spacing import _contact_radius, left_by_lattice, with_spacing
from tests.unit.test_spacing import E_STAR, FEWEST, LOAD, MOST, PATH, R, chosen, tables


def counted(monkeypatch: pytest.MonkeyPatch, left: Callable[[int], float]) -> tuple[list[int], int]:
    """The numbers of particles that are tried where so many leave `left` of a tolerance of 1e-3, and the last one."""
    tried: list[int] = []
    scene = chosen()

    def scene_of(count: int) -> Scene:
        tried.append(count)
        return scene

    monkeypatch.setattr(spacing, "left_by_lattice", lambda _: 1e-3 * left(tried[-1]))
    spacing.fine_enough(scene_of)
    return tried, tried[-1]


@pytest.mark.parametrize("needed", [1.0, 29.0, 40.0, 77.7, 1000.3, 4900.0])
def test_particles_are_counted_until_nine_tenths_of_the_tolerance_are_kept(
    monkeypatch: pytest.MonkeyPatch, needed: float
) -> None:
    """What falls with the square of their number is found at once, a particle or two beyond it."""
    tried, count = counted(monkeypatch, lambda n: 0.9 * (needed / n) ** 2)
    assert len(tried) <= 2
    assert max(FEWEST, needed) <= count <= max(FEWEST, needed + 2.0)


def test_a_radius_that_appears_takes_four_times_as_many_particles_until_it_is_there(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tried, count = counted(monkeypatch, lambda n: math.inf if n < 1000 else 0.5)
    assert np.asarray(tried[1:]) / tried[:-1] == pytest.approx(4.0, abs=0.05)
    assert 1000 <= count < 4100
    tried, count = counted(monkeypatch, lambda n: math.inf)
    assert count == MOST
    assert tried.count(MOST) == 1


def test_what_never_gets_better_takes_a_few_tries(monkeypatch: pytest.MonkeyPatch) -> None:
    tried, count = counted(monkeypatch, lambda n: 0.95)
    assert len(tried) < 10
    assert count < 2 * FEWEST


@pytest.mark.parametrize("left", [2e-3, 0.03, 0.0895, 0.0905, 0.15, 0.3])
def test_a_tolerance_is_advised_that_is_allowed_and_large_enough_or_none(
    monkeypatch: pytest.MonkeyPatch, left: float
) -> None:
    """Of a tenth at most, two figures, and a tenth more than what is left."""
    scene = scene_from_dict(tables())
    monkeypatch.setattr(spacing, "left_by_lattice", lambda _: left)
    with pytest.raises(SettingsError, match="not kept by") as caught:
        with_spacing(scene)
    told = re.search(r"Take an accuracy.tolerance of (\S+), or give bodies.spacing", str(caught.value))
    assert (told is None) == (1.1 * left > 0.0991)
    assert told is None or left < float(told[1]) <= 0.1
    assert told is not None or "Give bodies.spacing" in str(caught.value)
    monkeypatch.setattr(spacing, "left_by_lattice", lambda _: math.inf)
    assert with_spacing(scene).bodies.spacing > 0.0  # without bound the run says what appears


def test_the_lattice_leaves_the_largest_share_of_any_result(monkeypatch: pytest.MonkeyPatch) -> None:
    """What changes and what is read off, over the size; of a load F/πa² too, twice the share of a."""
    load, path = chosen(), chosen(experiment=PATH)

    def left(of: Scene, sizes: dict[str, float], changes: dict[str, float], read: dict[str, float]) -> float:
        for name, told in (("expected", sizes), ("left_by_centring", changes), ("read_off", read)):
            monkeypatch.setattr(spacing, name, lambda *_, told=told: told)
        return left_by_lattice(of)

    sizes = {"displacement": -2.0, "contact_radius": 4.0}
    assert left(path, sizes, {"displacement": 0.2, "contact_radius": 0.3}, {}) == pytest.approx(0.1)
    assert left(path, sizes, {"displacement": 0.02, "contact_radius": 0.3}, {"contact_radius": 0.1}) == pytest.approx(
        0.1
    )
    assert left(load, sizes, {"displacement": 0.02, "contact_radius": 0.3}, {"contact_radius": 0.1}) == pytest.approx(
        0.2
    )
    assert left(load, sizes, {"displacement": 0.02}, {"contact_radius": 0.1}) == pytest.approx(0.01)
    assert left(path, sizes, {}, {}) == 0.0
    none = {"stick_radius": 0.0, "tangential_force": 0.0, "normal_force": 1.0}
    assert left(path, none, {"tangential_force": 1.0, "normal_force": 0.01}, {}) == 0.01
    assert left(path, none, {"stick_radius": 1e-9, "normal_force": 0.01}, {}) == math.inf
    assert left(path, none, {"stick_radius": 0.0, "normal_force": 0.01}, {}) == 0.01


@pytest.mark.parametrize("deepest", [2e-8, 1e-6, 4e-5])
def test_a_path_counts_particles_in_its_widest_contact_and_an_adhesive_one_at_zero_force(deepest: float) -> None:
    path = {"kind": "path", "displacements": [0.0, deepest, 0.5 * deepest]}
    assert _contact_radius(chosen(experiment=path)) == pytest.approx(math.sqrt(R * deepest), rel=1e-3)
    held = scene_from_dict(tables(experiment=path, adhesion={"work_of_adhesion": 0.5}))
    zero = (4.5 * math.pi * 0.5 * R**2 / E_STAR) ** (1.0 / 3.0)
    assert _contact_radius(held) == pytest.approx(zero, rel=1e-3)


def test_friction_counts_particles_under_its_largest_load() -> None:
    loads = {"kind": "tangential", "normal_force": [0.5 * LOAD, LOAD], "displacements": [1e-8, 2e-8]}
    scene = scene_from_dict(tables(friction={"coefficient": 0.3}, experiment=loads))
    hertz = (0.75 * LOAD * R / E_STAR) ** (1.0 / 3.0)
    assert _contact_radius(scene) == pytest.approx(hertz, rel=1e-3)
