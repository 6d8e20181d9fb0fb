"""Friction on a plane from given rows: a chain of springs and sliders in small steps, in place of LAMMPS.

Reference: every particle for itself, s ← s + k_t Δu back to ± μ f in each of thousands of steps of a straight way.
"""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius
from contact1d.workflow.deck.lattice import places
from contact1d.workflow.deck.steps import Draw, Phase
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.radii import RadiusRule
from contact1d.workflow.experiments.running.trust import UntrustedError
from contact1d.workflow.experiments.tangential.schedule import moved_too_far, passed, schedule
from contact1d.workflow.experiments.tangential.tangential import _require_history, _whole, tangential
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import settings_for
from tests.unit.test_settings_similarity import SCENES

STEPS = 4000
"""Of each row in the reference; its work is off by one over that."""
COEFFICIENT = 0.3


def scene_of(experiment: dict[str, Any], **tables: Any) -> Scene:
    known = SCENES["friction"]
    bodies = known["bodies"] | {"particles": 40, "spacing": 0.5} | tables.pop("bodies", {})
    return scene_from_dict(known | {"bodies": bodies, "experiment": {"kind": "tangential"} | experiment} | tables)


class Chain:
    """Springs with sliders; `off`: an error of each tangential force [FU]."""

    def __init__(self, scene: Scene, off: float = 0.0) -> None:
        """At rest above the plane."""
        self.scene, self.settings, self.off = scene, settings_for(scene), off
        self.x = places(self.settings.particles, scene.bodies.spacing)
        self.heights = np.asarray(scene.bodies.height(self.x))
        self.force, self.work = np.zeros_like(self.x), 0.0
        self.before: Draw | None = None
        self.phases: tuple[Phase, ...] = ()

    def replay(self, phases: tuple[Phase, ...]) -> list[State]:
        """All rows."""
        self.phases = phases
        return [self.row(phase.name, row) for phase in phases for row in phase.rows if isinstance(row, Draw)]

    def row(self, phase: str, row: Draw) -> State:
        """In small steps from the row before; the first one brings the load on."""
        start = self.before or row
        for i in range(STEPS):
            depths = [start.displacement + (row.displacement - start.displacement) * n / STEPS for n in (i, i + 1)]
            limit = COEFFICIENT * self.scene.bulk_stiffness * np.maximum(depths[1] - self.heights, 0.0)
            touched = depths[0] - self.heights > 0.0
            pushed = self.force + touched * self.scene.tangential_stiffness * (row.place - start.place) / STEPS
            self.force = np.clip(pushed, -limit, limit)
            self.work += float(np.abs((pushed - self.force) * self.force).sum()) / self.scene.tangential_stiffness
            if row == start:
                break
        self.before = row
        normal = self.scene.bulk_stiffness * np.maximum(row.displacement - self.heights, 0.0)
        spacing, none = self.scene.bodies.spacing, np.zeros_like(self.x)
        profile = Profile(self.x, none, none, normal / spacing, -(self.force + self.off) / spacing)
        rule = RadiusRule(self.scene, self.settings.tolerance)
        return State(phase, row.displacement, float(normal.sum()), profile, 0.0, 0.0, 0.0, rule, plate_x=row.place)


class Context:
    """Opens one chain."""

    def __init__(self, scene: Scene, off: float = 0.0) -> None:
        """Of the scene."""
        self.chain = Chain(scene, off)
        self.deck = SimpleNamespace(scene=scene, settings=self.chain.settings)

    def contact(self) -> Any:
        """As a `with` asks for it."""
        return self

    def __enter__(self) -> Any:
        return self.chain

    def __exit__(self, *_: object) -> None:
        return None


WAYS: list[dict[str, Any]] = [
    {"normal_force": 2.0, "displacements": [0.01, 0.05, -0.02]},
    {"normal_force": 2.0, "displacements": [0.0, 0.03, 0.03, 0.02, 0.1]},
    {"normal_displacement": 0.05, "displacements": [-0.1, -0.02, -0.02]},
    {"normal_displacement": [0.08, 0.04, 0.06], "displacements": [0.02, 0.02, -0.03]},
    {"normal_displacement": [0.02, 0.09], "displacements": [0.0, -0.05]},
    {"normal_displacement": 0.05, "displacements": [0.0]},
]


@pytest.mark.parametrize("way", WAYS)
def test_forces_and_energies_are_those_of_springs_and_sliders_in_small_steps(way: dict[str, Any]) -> None:
    scene = scene_of(way)
    context: Any = Context(scene)
    found = tangential(context)
    chain, known = context.chain, found.quantities
    force = float(chain.force.sum())
    rows = [row for phase in schedule(scene, chain.settings) for row in phase.rows if isinstance(row, Draw)]
    asked = [one for _, one in passed(scene, chain.settings)]
    # each state once more, for sums of |s_i|
    again = Chain(scene)
    states = again.replay(schedule(scene, chain.settings))
    carried = [0.5 * float(np.abs(s.profile.shear).sum()) for s in states]
    error = 1e-13 * len(rows) * max(carried) + moved_too_far(scene, chain.settings)
    assert known["tangential_force"].value == pytest.approx(force, abs=1e-12)
    assert known["tangential_force"].uncertainty == pytest.approx(error)
    assert known["dissipated_energy"].value == pytest.approx(chain.work, rel=3.0 / STEPS, abs=1e-12)
    farthest = max(abs(place) for place in way["displacements"])
    assert known["dissipated_energy"].uncertainty == pytest.approx(error * farthest)
    normal = states[-1].force
    assert (known["normal_force"].value, known["normal_force"].uncertainty) == pytest.approx((normal, 1e-13 * normal))
    assert len(found.states) == sum(asked) == len(way["displacements"])
    assert found.friction["tangential_displacement"] == tuple(way["displacements"])
    forces = [-0.5 * float(s.profile.shear.sum()) for s, one in zip(states, asked, strict=True) if one]
    assert found.friction["tangential_force"] == pytest.approx(forces)
    assert found.friction["dissipated_energy"][-1] == known["dissipated_energy"].value
    assert found.compared_with["tangential_force"] == pytest.approx(max(carried))
    work = sum(0.5 * (a + b) * abs(q.place - p.place) for (a, p), (b, q) in pairwise(zip(carried, rows, strict=True)))
    assert found.compared_with["dissipated_energy"] == pytest.approx(work)
    given = {"normal_force"} if "normal_force" in way else set()
    assert given == found.prescribed - {"stick_radius", "contact_radius"}
    stick = known["stick_radius"]
    assert ("stick_radius" in found.prescribed) == (stick.value == stick.uncertainty == 0.0)
    ends = [abs(place) for place in way["displacements"]]
    assert found.profiles["farthest"] is found.states[int(np.argmax(ends))].profile
    assert found.profiles["final"] is found.states[-1].profile
    assert found.spacing_uncertainty["contact_radius"] == known["contact_radius"].uncertainty
    radius = found.states[-1].radius
    assert radius is not None
    assert found.radii["final"] == known["contact_radius"].value == radius.value


def test_what_neither_touches_nor_sticks_has_no_radius_and_no_error() -> None:
    scene = scene_of({"normal_displacement": [0.05, -0.01], "displacements": [0.01, 0.02]})
    context: Any = Context(scene)
    found = tangential(context)
    assert {"contact_radius", "stick_radius"} <= found.prescribed | {"contact_radius"}
    assert found.quantities["contact_radius"].value == 0.0
    assert math.isnan(found.radii["final"])


def test_a_history_that_is_off_by_more_than_its_round_off_is_refused() -> None:
    state: Any = SimpleNamespace(displacement=0.1, plate_x=0.2, phase="forward")
    for sign in (-1.0, 1.0):
        _require_history(state, np.asarray([0.0, sign * 0.99e-8 * 3.0]), 3.0)
        with pytest.raises(UntrustedError, match="lost its history"):
            _require_history(state, np.asarray([0.0, sign * 1.01e-8 * 3.0]), 3.0)
    context: Any = Context(scene_of(WAYS[0]), off=1e-4)
    with pytest.raises(UntrustedError, match="lost its history"):
        tangential(context)


def test_a_punch_sticks_or_slips_as_a_whole() -> None:
    x = np.arange(4.0)
    edge = ContactRadius(8.0, 0.0, -8.0, 8.0, reaches_end=False)
    state: Any = SimpleNamespace(radius=edge, profile=Profile(x, 0.0 * x, 0.0 * x, 0.0 * x + 1.0, 0.0 * x - 0.2))
    assert _whole(state, 0.3, 1) is edge
    assert _whole(state, 0.3, -1) is edge
    assert _whole(state, 0.2, -1) is edge
    slips = _whole(state, 0.2, 1)
    assert (slips.value, slips.uncertainty, slips.left, slips.right) == (0.0, 0.0, 0.0, 0.0)
    away: Any = SimpleNamespace(radius=None, profile=state.profile)
    assert _whole(away, 0.3, 1).value == 0.0


def test_a_flat_punch_has_the_radius_of_its_edge_and_slips_under_the_whole_load() -> None:
    body = {"profile": {"kind": "flat_punch", "radius": 4.0}, "particles": "auto"}
    for farthest, stick in ((0.02, 4.0), (1.0, 0.0)):
        scene = scene_of({"normal_force": 2.0, "displacements": [0.01, farthest]}, bodies=body)
        context: Any = Context(scene)
        found = tangential(context).quantities
        assert found["contact_radius"].value == 4.0
        assert found["stick_radius"].value == stick
        if not stick:
            assert found["tangential_force"].value == pytest.approx(COEFFICIENT * 2.0)


def way_of(**experiment: Any) -> list[tuple[str, list[tuple[float, float]]]]:
    scene = scene_of(experiment)
    phases = schedule(scene, settings_for(scene))
    assert [phase.state for phase in phases] == [False, *[True] * (len(phases) - 1)]
    return [
        (phase.name, [(row.displacement, row.place) for row in phase.rows if isinstance(row, Draw)]) for phase in phases
    ]


def test_a_phase_goes_one_way_and_the_third_of_a_kind_says_so() -> None:
    found = way_of(normal_displacement=0.05, displacements=[-0.1, 0.1, 0.0, 0.1, 0.0, 0.1])
    assert [name for name, _ in found] == [
        "pressing", "backward", "forward", "backward_2", "forward_2", "backward_3", "forward_3",
    ]  # fmt: skip
    assert found[0][1] == [(0.05, 0.0)]
    assert [rows for _, rows in found[1:]] == [[(0.05, p)] for p in (-0.1, 0.1, 0.0, 0.1, 0.0, 0.1)]
    assert [name for name, _ in way_of(normal_displacement=0.05, displacements=[0.0, 0.0])] == ["pressing", "forward"]


@pytest.mark.parametrize("way", [0.3, -0.3])
def test_rows_on_a_slanting_way_are_where_particles_begin_or_end_to_touch(way: float) -> None:
    """Heights x²/200 of particles at 0.25, 0.75, …; none where only depth or place changes."""
    depths = [(0.25 + 0.5 * i) ** 2 / 100.0 for i in range(20)]
    low, high = 0.02, 0.1
    between = [depth for depth in depths if low < depth < high]
    expected = [(depth, way * (depth - low) / (high - low)) for depth in between]
    down = [(depth, way - way * (high - depth) / (high - low)) for depth in between]
    scene = scene_of({"normal_displacement": [low, high, low, low, high], "displacements": [0.0, way, 0.0, way, way]})
    rows = passed(scene, settings_for(scene))
    stops = [(low, 0.0), (high, way), (low, 0.0), (low, way), (high, way)]
    back = [(depth, way * (depth - low) / (high - low)) for depth in reversed(between)]
    assert len(down) == len(back)
    walked = [(low, 0.0), stops[0], *expected, stops[1], *back, stops[2], stops[3], stops[4]]
    assert [place for stop, _ in rows for place in stop] == pytest.approx([place for stop in walked for place in stop])
    assert [stop for stop, asked in rows if asked] == stops
    assert moved_too_far(scene, settings_for(scene)) == 0.0


def test_of_too_many_rows_those_are_kept_that_lie_evenly_and_what_the_others_miss_is_claimed() -> None:
    """At a tolerance of 0.1 there are ten on a way; other particles are moved by a tenth too much or less."""
    scene = scene_of(
        {"normal_displacement": [0.0, 0.9, 0.9], "displacements": [0.0, 0.3, 0.4]},
        accuracy={"tolerance": 0.1},
        bodies={"bulk_stiffness": 0.7},
    )
    settings = settings_for(scene)
    rows = passed(scene, settings)
    assert len(rows) == 2 + 10 + 2
    depths = np.asarray([(0.25 + 0.5 * i) ** 2 / 100.0 for i in range(20)])
    between = depths[(depths > 0.0) & (depths < 0.9)]
    chosen = [stop[0] for stop, asked in rows if not asked][1:]
    assert chosen == pytest.approx([between[round(i)] for i in np.linspace(0, len(between) - 1, 10)])
    missed = 2.0 * len(between) * scene.tangential_stiffness * 0.3 / 10.0
    assert moved_too_far(scene, settings) == pytest.approx(missed)
    fine = replace(settings, tolerance=1.0 / len(between))
    assert moved_too_far(scene, fine) == 0.0
    assert len(passed(scene, replace(settings, tolerance=2.0))) == 2 + 1 + 2
