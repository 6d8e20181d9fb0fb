"""Claims of sums over particles wherever the apex stands: each mark beside a root or a scan of the sum written out."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq

from contact1d.analysis.radius import compressive_radius
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.centring import _chain, _marks, _Row, expected, left_by_centring, read_off
from contact1d.workflow.settings.estimate import ContactEstimate
from contact1d.workflow.settings.settings import settings_for
from contact1d.workflow.settings.shape import places_within
from tests.scenes import chains

Array = NDArray[np.float64]
EXACT = 1e-9
PHASES = [0.5, 0.375, 0.25, 0.0]
R, SPACING, SPRING = 40.0, 0.8, 0.7
STRONG, WEAK, NONE = (0.36, 0.03, 0.18, 0.06), (0.18, 0.13, 0.09, 0.26), (0.18, 0.13, 0.0, 0.26)


def pulled(law: tuple[float, ...], preload: float = 0.5) -> Scene:
    experiment = {"kind": "pull_off", "preload": preload}
    return scene_from_dict(chains(R, SPRING, law=law, bodies={"spacing": SPACING}, experiment=experiment))


def plane(experiment: dict[str, Any], **tables: Any) -> Scene:
    bodies = {"spacing": SPACING, "lower": "rigid_plane"}
    return scene_from_dict(chains(R, SPRING, bodies=bodies, interaction=None, experiment=experiment, **tables))


def summed(estimate: ContactEstimate, phase: float, d: float) -> float:
    """F(d) over 600 particles, one after the other."""
    heights = estimate.profile.height(SPACING * (np.arange(-300.0, 300.0) + phase))
    return sum(float(np.interp(estimate.rest + h - d, estimate.gap, estimate.force, right=0.0)) for h in heights)


@pytest.mark.parametrize("phase", PHASES)
@pytest.mark.parametrize("reach", [0.0, 0.3, 0.8, 2.0, 2.0000001, 7.77])
def test_places_within_a_reach_are_all_there_are(reach: float, phase: float) -> None:
    every = [SPACING * (i + phase) for i in range(-20, 21)]
    assert places_within(reach, SPACING, phase).tolist() == [x for x in every if abs(x) <= reach]


@pytest.mark.parametrize("phase", PHASES)
@pytest.mark.parametrize("law", [STRONG, WEAK])
def test_a_row_has_the_forces_of_its_particles_and_two_more_on_each_side(law: tuple[float, ...], phase: float) -> None:
    settings = settings_for(pulled(law))
    row = _Row(settings.estimate, phase, settings.largest_displacement)
    for d in (row.lowest, 0.0, 0.5 * settings.largest_displacement, settings.largest_displacement):
        assert row.force(d) == pytest.approx(summed(settings.estimate, phase, d), rel=EXACT, abs=1e-12)
        profile = row.profile(d)
        heights = settings.estimate.profile.height(profile.x)
        forces = np.interp(
            settings.estimate.rest + heights - d, settings.estimate.gap, settings.estimate.force, right=0.0
        )
        assert profile.pressure == pytest.approx(forces, abs=1e-12)
        assert np.diff(profile.x) == pytest.approx(SPACING, rel=EXACT)
        assert not profile.pressure[[0, 1, -2, -1]].any()
    assert profile.pressure[[2, -3]].all()
    assert abs(row.force(row.lowest)) <= 2.0 * abs(settings.estimate.force[-1])  # of what is just within the cutoff
    assert row.force(row.lowest - 1e-9) == 0.0


@pytest.mark.parametrize("phase", [0.5, 0.0])
@pytest.mark.parametrize("law", [STRONG, WEAK])
def test_marks_of_a_row_are_those_of_a_scan(law: tuple[float, ...], phase: float) -> None:
    settings = settings_for(pulled(law))
    estimate, deepest = settings.estimate, settings.largest_displacement
    row = _Row(estimate, phase, deepest)
    places = np.linspace(row.lowest, row.highest, 6001)
    forces = np.concatenate([row.forces(some) for some in np.array_split(places, 30)])
    top, step = int(np.argmin(forces)), float(places[1] - places[0])
    place, tension = row.largest_tension()
    assert tension == pytest.approx(-forces[top], rel=1e-4)
    assert tension >= -forces[top] * (1.0 - EXACT)
    assert place == pytest.approx(places[top], abs=step if estimate.snaps else 0.02 * WEAK[3])
    if not estimate.snaps:  # flat as it is: by a polynomial through a piece of it
        t = np.linspace(-1.0, 1.0, 2001)
        fit = np.polynomial.Polynomial.fit(t, row.forces(place + 0.03 * t), 6).deriv()
        vertex = min((root.real for root in fit.roots() if abs(root) < 0.5), key=abs)
        assert abs(0.03 * vertex) < 1e-5
    for force in (-0.5 * tension, 0.0, 0.3, 0.5):
        last = int(np.flatnonzero(forces < force)[-1])
        if last < len(places) - 1:
            root = brentq(lambda d, f=force: row.force(d) - f, places[last], places[last + 1], xtol=1e-15)
            assert row.crossing(force) == pytest.approx(root, abs=1e-6 * step)
    assert row.crossing(-2.0 * tension) == place  # which none reaches
    assert row.crossing(1e9) == pytest.approx(row.highest, abs=0.01 * (row.highest - row.lowest))


class Counted(_Row):
    """A row that counts the displacements that it is looked at."""

    looked_at = 0

    def forces(self, displacements: Array) -> Array:
        self.looked_at += displacements.size
        return super().forces(displacements)


def test_a_mark_takes_a_few_hundred_displacements_and_no_more_than_a_tenth_beyond_the_deepest() -> None:
    settings = settings_for(pulled(WEAK))
    deepest = settings.largest_displacement
    for mark in (_Row.largest_tension, lambda row: row.crossing(0.0)):
        row = Counted(settings.estimate, 0.5, deepest)
        mark(row)
        assert row.looked_at < 500
    assert 1.01 * deepest < row.highest < 1.2 * deepest + 0.2 * SPACING


def test_what_only_repels_has_its_largest_tension_of_nothing_where_it_begins() -> None:
    load = {"kind": "load", "force": 0.5}
    repels = {"repulsion": {"amplitude": 0.18, "range": 0.13}}
    settings = settings_for(scene_from_dict(chains(R, SPRING, interaction=repels, experiment=load)))
    row = _Row(settings.estimate, 0.5, settings.largest_displacement)
    assert row.largest_tension()[1] == 0.0
    assert row.largest_tension()[0] < row.crossing(1e-9)


@pytest.mark.parametrize("ends", [[0.1, 0.3], [0.3, 0.1], [0.2, -0.05]])
def test_the_radius_of_friction_is_that_at_the_end_and_none_where_nothing_touches(ends: list[float]) -> None:
    way = {"kind": "tangential", "normal_displacement": ends, "displacements": [0.01, 0.03]}
    scene = plane(way, friction={"coefficient": 0.3})
    told = expected(scene, settings_for(scene))
    assert told["contact_radius"] == pytest.approx(math.sqrt(R * max(ends[-1], 0.0)), rel=1e-6)
    heights = (SPACING * (np.arange(-50, 50) + 0.5)) ** 2 / R
    normal = SPRING * np.maximum(ends[-1] - heights, 0.0).sum()
    assert told["normal_force"] == pytest.approx(normal, rel=EXACT)


@pytest.mark.parametrize("force", [1e-4, 0.05, 2.0, 100.0])
@pytest.mark.parametrize("phase", PHASES)
def test_friction_counts_the_particles_that_carry_and_some_beside_them(force: float, phase: float) -> None:
    scene = plane({"kind": "tangential", "normal_force": force, "displacements": [0.01]}, friction={"coefficient": 0.3})
    settings = settings_for(scene)
    chain = _chain(scene, settings, phase)
    deep = chain.displacement_under(force)
    widest = math.sqrt(R * deep)
    assert chain.x.max() > widest
    assert chain.x.min() < -widest
    assert np.abs(chain.x).max() < max(2.0 * widest, 5.0 * SPACING)
    assert float(chain.normal_forces(deep).sum()) == pytest.approx(force, rel=EXACT)


def test_results_that_are_a_motion_and_bodies_with_an_edge_leave_nothing_open() -> None:
    slide = scene_from_dict(
        chains(
            30.0, 2.0, law=(1.0, 0.5, 0.5, 1.0), horizontal={}, damping={"coefficient": "auto"},
            plate={"free": ["x", "z"]}, cantilever={"stiffness": 0.5, "velocity": 0.1},
            experiment={"kind": "slide", "normal_force": 1.0, "distance": 7.0},
        )
    )  # fmt: skip
    assert left_by_centring(slide, settings_for(slide)) == expected(slide, settings_for(slide)) == {}
    for work in (0.0, 0.005):
        for kind in ({"kind": "load", "force": 0.4}, {"kind": "path", "displacements": [0.1]}):
            bodies = {"lower": "rigid_plane", "profile": {"kind": "flat_punch", "radius": 4.0}, "reduction": "mdr"}
            tables = chains(R, SPRING, bodies=bodies, interaction=None, experiment=kind)
            scene = scene_from_dict(tables | {"adhesion": {"work_of_adhesion": work}})
            assert read_off(scene, settings_for(scene)) == {}
            if not work:
                assert left_by_centring(scene, settings_for(scene)) == {}


def test_a_load_without_adhesion_is_hertz_with_a_work_of_nothing_too() -> None:
    """[adhesion] with work_of_adhesion = 0 leaves open what a chain without it does."""
    bodies = {"spacing": SPACING, "lower": "rigid_plane", "reduction": "mdr"}
    tables = chains(R, SPRING, bodies=bodies, interaction=None, experiment={"kind": "load", "force": 2.0})
    plain, none = scene_from_dict(tables), scene_from_dict(tables | {"adhesion": {"work_of_adhesion": 0.0}})
    for told in (left_by_centring, expected, read_off):
        own, other = told(plain, settings_for(plain)), told(none, settings_for(none))
        assert set(own) == set(other)
        assert all(other[name] == pytest.approx(value, rel=0.05, abs=1e-6) for name, value in own.items())


@pytest.mark.parametrize("force", [0.3, 2.0])
def test_a_radius_is_read_off_the_particles_under_the_load(force: float) -> None:
    body = {"profile": {"kind": "power", "exponent": 3.0, "radius": 6.0, "height": 1.0}, "lower": "rigid_plane"}
    tables = chains(R, SPRING, bodies=body, interaction=None, experiment={"kind": "load", "force": force})
    scene = scene_from_dict(tables)
    heights = scene.bodies.height(np.arange(-60, 60) + 0.5)
    d = brentq(lambda d: SPRING * float(np.maximum(d - heights, 0.0).sum()) - force, 1e-6, 30.0)
    settings = settings_for(scene)
    row = _Row(settings.estimate, 0.5, settings.largest_displacement).profile(d)
    assert float(row.pressure.sum()) == pytest.approx(force, rel=1e-8)
    told = read_off(scene, settings)
    assert told["contact_radius"] == pytest.approx(compressive_radius(row).uncertainty, rel=1e-4)
    assert 1e-4 < told["contact_radius"] < 1.0
    assert set(_marks(scene, settings, 0.25)) == {"displacement", "contact_radius"}
