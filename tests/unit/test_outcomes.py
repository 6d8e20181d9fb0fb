"""What is added to a claim for the lattice, what is told of it, and which states are refused, from a bound on."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.pressure import Profile
from contact1d.workflow.experiments.running import outcome as outcomes
from contact1d.workflow.experiments.running.outcome import (
    Outcome,
    anywhere_between,
    in_words,
    left_open_by_spacing,
    unmet,
)
from contact1d.workflow.experiments.running.trust import (
    ChainEndError,
    DigitsError,
    ThroughError,
    UntrustedError,
    doubts,
    require_trust,
)
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import settings_for
from contact1d.workflow.units import FORCE, LENGTH, Quantity
from tests.given import PROFILE, X, at, given_scene
from tests.scenes import chains

TOLERANCE = 1e-2
SCENE = given_scene(accuracy={"tolerance": TOLERANCE})


def left(parts: dict[str, float], monkeypatch: pytest.MonkeyPatch, scene: Scene = SCENE, **more: Any) -> Outcome:
    """What becomes of results of which the lattice leaves so much open."""
    monkeypatch.setattr(outcomes, "left_by_centring", lambda scene, settings: parts)
    quantities = {
        "adhesion_force": Quantity(-2.0, 0.1, FORCE), "contact_radius": Quantity(4.0, 0.2, LENGTH),
        "critical_radius": Quantity(0.0, 0.3, LENGTH), "mean_pressure": Quantity(-0.5, 0.01, "FU/LU²"),
        "displacement": Quantity(0.0, 0.3, LENGTH),
    }  # fmt: skip
    known = Outcome(quantities, (), {}, {}, (), warnings={"slow": "it is"})
    settings: Any = None
    return anywhere_between(scene, settings, replace(known, **more))


def test_a_part_of_the_lattice_is_in_its_claim_and_in_that_of_the_pressure_twice(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found = left({"contact_radius": 0.6, "adhesion_force": 0.02, "zero_load_radius": 9.0}, monkeypatch)
    claims = {name: q.uncertainty for name, q in found.quantities.items()}
    assert claims == pytest.approx({
        "adhesion_force": 0.12, "contact_radius": 0.8, "critical_radius": 0.3,
        "mean_pressure": 0.01 + 2.0 * 0.6 / 4.0 * 0.5, "displacement": 0.3,
    })  # fmt: skip
    assert set(found.centring) == {"contact_radius", "adhesion_force", "mean_pressure"}
    own = {name: q.uncertainty for name, q in found.on_own_lattice.items()}
    assert own == pytest.approx({"adhesion_force": 0.1, "contact_radius": 0.2, "critical_radius": 0.3,
                                 "mean_pressure": 0.01, "displacement": 0.3})  # fmt: skip


@pytest.mark.parametrize(
    ("parts", "told"),
    [
        ({"adhesion_force": 0.0199}, ""), ({"adhesion_force": 0.0201}, "adhesion_force is known to 1.0e-02 only"),
        ({"adhesion_force": 0.02}, ""), ({"displacement": 0.5}, ""), ({"critical_radius": 0.0}, ""),
        ({"critical_radius": 1e-9}, "critical_radius cannot be told from 0"), ({}, ""),
    ],
)  # fmt: skip
def test_what_the_lattice_leaves_is_told_from_the_tolerance_on(
    parts: dict[str, float], told: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    warnings = left(parts, monkeypatch).warnings
    assert warnings["slow"] == "it is"
    assert warnings.get("lattice", "").startswith(told)
    assert bool(told) == ("lattice" in warnings)


def test_a_part_is_compared_with_what_its_result_is_compared_with(monkeypatch: pytest.MonkeyPatch) -> None:
    for size, told in ((3.01, False), (2.99, True)):
        found = left({"adhesion_force": 0.03}, monkeypatch, compared_with={"adhesion_force": size})
        assert ("lattice" in found.warnings) == told


PLANE = chains(100.0, bodies={"particles": 40, "lower": "rigid_plane"}, interaction=None,
               adhesion={"work_of_adhesion": 0.01}, accuracy={"tolerance": TOLERANCE},
               experiment={"kind": "pull_off", "preload": 0.3})  # fmt: skip


@pytest.mark.parametrize(("part", "finer"), [(0.32, 0.25), (0.05, 0.632), (1e3, 0.0707)])
def test_an_edge_that_moves_through_cells_asks_for_cells_that_leave_half_of_the_tolerance(
    part: float, finer: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Errors go with the square of the spacing: √(0.5 tolerance/share), the share at most 1."""
    found = left({"adhesion_force": part / 2.0}, monkeypatch, scene_from_dict(PLANE))
    expected = math.sqrt(0.5 * TOLERANCE / min(1.0, part / 4.0))
    assert expected == pytest.approx(finer, rel=0.01)
    assert f"take a bodies.spacing of {expected:.2g} LU" in found.warnings["lattice"]


def test_words_tell_a_share_or_that_there_is_none() -> None:
    assert in_words({"a": 0.5, "b": 3e-3}) == "a is known to 5.0e-01, b is known to 3.0e-03"
    assert in_words({"a": 1.0}) == in_words({"a": math.inf}) == "a cannot be told from 0 and is known to 1 or worse"


def test_a_result_is_unmet_beyond_the_tolerance_only() -> None:
    known = Outcome({"a": Quantity(4.0, 0.04, FORCE), "b": Quantity(-4.0, 0.0401, FORCE)}, (), {}, {}, ())
    assert set(unmet(SCENE, known)) == {"b"}


def test_what_the_spacing_leaves_is_compared_with_the_tolerance_of_the_result() -> None:
    known = Outcome({"a": Quantity(4.0, 1.0, LENGTH), "b": Quantity(-4.0, 1.0, LENGTH), "c": Quantity(0.0, 1.0, FORCE)},
                    (), {}, {}, (), spacing_uncertainty={"a": 0.04, "b": 0.041})  # fmt: skip
    assert left_open_by_spacing(SCENE, known, ["a", "b", "c"]) == {"b"}


def ending(pressure: dict[int, float]) -> Profile:
    """Pressed in the middle with tension beside it, and single particles as given."""
    found = np.where(np.abs(X) < 6.0, 1.0, np.where(np.abs(X) < 8.0, -0.3, 0.0))
    for i, value in pressure.items():
        found[i] = value
    return replace(PROFILE, pressure=found)


@pytest.mark.parametrize(
    ("pressure", "ends"),
    [
        ({}, False), ({0: -0.4}, True), ({39: -0.4}, True), ({1: -0.4}, False), ({38: -0.4}, False),
        ({0: -0.2, 39: -0.2}, False), ({0: 0.6}, True), ({39: 0.6}, True), ({0: 0.5}, False),
    ],
)  # fmt: skip
def test_a_contact_reaches_the_end_of_its_chain_where_its_largest_tension_is_there(
    pressure: dict[int, float], ends: bool
) -> None:
    settings = settings_for(SCENE)
    state = at(0.0, 1.0, profile=ending(pressure))
    if ends:
        with pytest.raises(ChainEndError, match=r"take more bodies\.particles than 40"):
            require_trust(SCENE, settings, state)
    else:
        require_trust(SCENE, settings, state)


@pytest.mark.parametrize("table", ["adhesion", "none"])
@pytest.mark.parametrize(("pressure", "ends"), [({0: 0.5}, True), ({39: -0.5}, True), ({1: 0.5, 38: -0.5}, False)])
def test_on_a_plane_it_does_so_where_its_last_particle_carries(
    table: str, pressure: dict[int, float], ends: bool
) -> None:
    tables = PLANE if table == "adhesion" else PLANE | {
        "adhesion": None, "experiment": {"kind": "load", "force": 0.3}
    }  # fmt: skip
    scene = scene_from_dict({name: one for name, one in tables.items() if one is not None})
    state = at(0.0, 1.0, profile=ending(pressure))
    if ends:
        with pytest.raises(ChainEndError):
            require_trust(scene, settings_for(scene), state)
    else:
        require_trust(scene, settings_for(scene), state)


def test_the_chain_that_is_to_grow_is_the_upper_one_where_it_has_its_own() -> None:
    scene = given_scene(bodies={"particles": 60, "upper_particles": 40}, horizontal={}, cantilever=None)
    with pytest.raises(ChainEndError, match=r"more bodies\.upper_particles than 40, or leave it out"):
        require_trust(scene, settings_for(scene), at(0.0, 1.0, profile=ending({0: -0.4})))


def test_bodies_that_went_through_are_told_what_helps_them() -> None:
    """What lets particles step aside, and heat, where there is any."""
    heat: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}, "noise": {"temperature": 1e-5, "seed": 1}}
    plain, aside = SCENE, given_scene(horizontal={})
    hot = given_scene(**heat, experiment={"kind": "load", "force": 0.3, "method": "dynamic"})
    told = []
    for scene in (plain, aside, hot):
        with pytest.raises(ThroughError) as caught:
            require_trust(scene, settings_for(scene), at(0.0, 1.0, depth=1e-6))
        told.append(str(caught.value))
    assert ["[horizontal]" in one for one in told] == [False, True, False]
    assert ["under this heat" in one for one in told] == ["lower noise.temperature" in one for one in told]
    assert ["under this heat" in one for one in told] == [False, False, True]


@pytest.mark.parametrize(("kind", "word"), [("stepped", "too small to compute"), ("rest", "a smaller load or smaller")])
def test_forces_that_are_left_are_told_by_what_makes_them(kind: str, word: str) -> None:
    scene = scene_from_dict(PLANE) if kind == "stepped" else SCENE
    settings = settings_for(scene)
    limit = 0.1 * settings.tolerance * settings.force_scale
    with pytest.raises(DigitsError if kind == "stepped" else UntrustedError, match=word):
        require_trust(scene, settings, at(0.0, 1.0, residual=1.01 * limit))
    require_trust(scene, settings, at(0.0, 1.0, residual=0.99 * limit))


def test_a_path_in_time_that_is_not_at_rest_wants_more_damping() -> None:
    way = {"kind": "path", "displacements": [0.0, 0.1], "method": "dynamic"}
    scene = given_scene(damping={"coefficient": "auto"}, experiment=way)
    with pytest.raises(UntrustedError, match=r"more \[damping\]"):
        require_trust(scene, settings_for(scene), at(0.0, 1.0, residual=1.0))


@pytest.mark.parametrize(("punch", "told"), [(False, True), (True, False)])
def test_a_chain_of_neighbours_that_ends_near_its_contact_is_doubted_and_a_punch_is_meant_to(
    punch: bool, told: bool
) -> None:
    body: dict[str, Any] = {"particles": "auto", "profile": {"kind": "flat_punch", "radius": 8.0}}
    body = body if punch else {"particles": 16}
    scene = given_scene(bodies=body, neighbours={"stiffness": 50.0})
    found = doubts(scene, settings_for(scene), (at(0.0, 1.0),))
    assert ("chain_end" in found) == told
    if told:
        assert "neighbour springs" in found["chain_end"]
