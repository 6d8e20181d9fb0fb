"""Claims of averages under heat, of rows that are planned in time, and of warnings: each told from its bound on.

Reference: means and standard errors by numpy, time constants of an oscillator, factors on both sides of each bound.
"""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.pressure import Profile
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.lattice import bodies
from contact1d.workflow.deck.steps import DisplaceInTime, UnderLoad
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.experiments import planned
from contact1d.workflow.experiments.load.dynamic import _thermal_outcome
from contact1d.workflow.experiments.path.path import _means
from contact1d.workflow.experiments.path.schedule import places, schedule
from contact1d.workflow.experiments.path.thermal import SAMPLES, averaged
from contact1d.workflow.experiments.pull_off.pulls import BARRIER, GONE, _has_parted, ramp_of
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.holding import Start, hold_row
from contact1d.workflow.experiments.running.law_error import law_error, law_share
from contact1d.workflow.experiments.running.outcome import Outcome, left_open_by_spacing
from contact1d.workflow.experiments.running.radii import RadiusRule
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.sampling import SETTLING_LOOKS, chunk_steps, standard_error
from contact1d.workflow.experiments.running.slowness import slowness
from contact1d.workflow.experiments.running.trust import doubts
from contact1d.workflow.judging.slide_model import slide_model
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import Settings, settings_for
from contact1d.workflow.units import LENGTH, Quantity
from tests.scenes import chains
from tests.unit.test_settings_similarity import SCENES

SMOOTH, SNAPPING = (0.018, 0.03, 0.009, 0.06), (0.18, 0.03, 0.09, 0.06)
TIMED: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}}
HEAT: dict[str, Any] = TIMED | {"noise": {"temperature": 1e-3, "seed": 1}}
PULL = {"kind": "pull_off", "preload": 0.3}


def scene_of(law: tuple[float, ...] = SMOOTH, **tables: Any) -> tuple[Scene, Settings]:
    scene = scene_from_dict(chains(100.0, law=law, bodies={"particles": 40}, **tables))
    return scene, settings_for(scene)


def sample(scene: Scene, settings: Settings, number: int, swing: float) -> State:
    """Tension at the edge of a compressed middle, all of which swings."""
    x = np.arange(40) - 19.5
    pressure = np.where(np.abs(x) < 6.0, 1.0, -0.6 * np.exp(-((np.abs(x) - 7.0) ** 2))) * (1.0 + 0.1 * swing)
    profile = Profile(x, 0.0 * x, 0.0 * x + 0.2, pressure, 0.0 * x)
    rule = RadiusRule(scene, settings.tolerance)
    return State("sampling", 0.1 + swing, 2.0 + 3.0 * swing, profile, 0.2, 0.0, 0.0, rule, step=10.0 * number)


def test_a_thermal_load_reports_means_and_the_errors_of_its_blocks() -> None:
    scene, settings = scene_of(**HEAT, experiment={"kind": "load", "force": 2.0, "method": "dynamic"})
    swings = 0.01 * np.random.default_rng(2).standard_normal(400)
    states = [sample(scene, settings, i, swing) for i, swing in enumerate(swings)]
    context: Any = SimpleNamespace(deck=SimpleNamespace(scene=scene, settings=settings))
    contact: Any = SimpleNamespace(phases=())
    error = standard_error([s.displacement for s in states])
    for goal, told in ((1.01 * error, False), (0.99 * error, True)):
        found = _thermal_outcome(context, contact, tuple(states), states, (2.01, 0.04), goal)
        assert ("statistics" in found.warnings) == told
    known = found.quantities
    assert known["displacement"].value == pytest.approx(0.1 + swings.mean())
    assert known["displacement"].uncertainty == pytest.approx(error)
    assert (known["force"].value, known["force"].uncertainty) == (2.01, 0.04)
    radius = known["contact_radius"]
    share = 2.0 * radius.uncertainty / radius.value + 0.04 / 2.01
    assert known["mean_pressure"].uncertainty == pytest.approx(share * abs(known["mean_pressure"].value))
    own = RadiusRule(scene, settings.tolerance).of(found.profiles["final"])
    assert own is not None
    assert radius.value == own.value
    assert own.uncertainty <= radius.uncertainty < 1.5 * own.uncertainty + 0.1
    assert found.profiles["final"].pressure == pytest.approx(states[0].profile.pressure * (
        (1.0 + 0.1 * swings.mean()) / (1.0 + 0.1 * swings[0])
    ))  # fmt: skip


def test_places_under_heat_are_means_of_what_comes_after_it_forgot() -> None:
    scene, settings = scene_of(**HEAT | {"plate": None}, experiment={
        "kind": "path", "displacements": [0.0, 0.1], "method": "dynamic",
    })  # fmt: skip
    wanted = [(0.0, True), (0.05, False), (0.1, True)]
    (loading,) = schedule(scene, settings)
    looks = [SETTLING_LOOKS + SAMPLES, SETTLING_LOOKS, SETTLING_LOOKS + SAMPLES]
    asked = [one for _, one in places(scene, settings)]
    assert sum(asked) == 2
    assert len(loading.rows) == SETTLING_LOOKS * len(asked) + SAMPLES * 2
    rng, states = np.random.default_rng(4), []
    for n, level in zip(looks, (1.0, 5.0, 3.0), strict=True):
        values = [*np.full(SETTLING_LOOKS, 99.0), *(level + 0.1 * rng.standard_normal(n - SETTLING_LOOKS))]
        states += [replace(sample(scene, settings, i, 0.0), force=v, smallest_distance=0.2 + 1e-3 * i, depth=1e-3 * i)
                   for i, v in enumerate(values)]  # fmt: skip
    first, between, last = averaged(states, wanted)
    for one, part in ((first, states[: looks[0]]), (last, states[-looks[2] :])):
        forces = [s.force for s in part[SETTLING_LOOKS:]]
        assert one.force == pytest.approx(np.mean(forces))
        assert one.residual * 40 == pytest.approx(2.0 * standard_error(forces))
        told = _means(settings, [one])
        assert told["force_standard_error"] == pytest.approx((standard_error(forces),))
        assert told["force"] == (one.force,)
        assert one.smallest_distance == pytest.approx(0.2 + 1e-3 * SETTLING_LOOKS)
        assert one.depth == pytest.approx(1e-3 * (looks[0] - 1))
    assert between is states[looks[0] + SETTLING_LOOKS - 1]


@pytest.mark.parametrize("drag", [0.013, 0.9, 9.7])
def test_samples_of_a_path_under_heat_are_half_a_decay_apart_or_more(drag: float) -> None:
    scene, settings = scene_of(**HEAT | {"plate": None, "damping": {"coefficient": drag}}, experiment={
        "kind": "path", "displacements": [0.0], "method": "dynamic",
    })  # fmt: skip
    slowest = -float(np.roots([scene.bodies.mass, drag, scene.bulk_stiffness]).real.max())
    (loading,) = schedule(scene, settings)
    (steps,) = {row.steps for row in loading.rows if isinstance(row, DisplaceInTime)}
    assert steps >= chunk_steps(settings)
    assert steps * settings.time_step * slowest >= 0.5 - 1e-9
    assert steps == chunk_steps(settings) or (steps - 2) * settings.time_step * slowest < 1.0


@pytest.mark.parametrize("drag", [0.1, 0.9, 9.0])
def test_a_path_in_time_gives_particles_fourteen_times_what_they_take_to_come_to_rest(drag: float) -> None:
    """m z″ + γ z′ + k z = 0: the slower root of λ² m + λ γ + k, for any damping."""
    scene, settings = scene_of(
        damping={"coefficient": drag}, experiment={"kind": "path", "displacements": [0.0, 0.1], "method": "dynamic"}
    )
    slowest = -float(np.roots([scene.bodies.mass, drag, scene.bulk_stiffness]).real.max())
    (loading,) = schedule(scene, settings)
    times = {row.steps * settings.time_step for row in loading.rows if isinstance(row, DisplaceInTime)}
    longest = 29.0 if drag == 0.9 else 14.6  # near critical 2m/γ and γ/k are twice too long
    assert all(13.9 <= time * slowest <= longest for time in times)


def test_bodies_that_part_over_snaps_go_no_further_at_once_than_pairs_are_wide() -> None:
    way = {"kind": "path", "displacements": [0.2, -0.3]}
    for law in (SMOOTH, SNAPPING):
        scene, settings = scene_of(law, experiment=way)
        rows = places(scene, settings)
        moves = np.diff([0.0, *(d for d, _ in rows)])
        down, up = -moves[moves < 0.0], moves[moves > 0.0]
        assert up.max() <= settings.longest_move * (1.0 + 1e-9)
        assert [d for d, wanted in rows if wanted] == [0.2, -0.3]
        if law is SNAPPING:
            longest = min(settings.longest_move, math.sqrt(8.0 * settings.tolerance) * 0.06)
            assert 0.9 * longest < down.max() <= longest * (1.0 + 1e-9)
        else:
            assert down.size == 1
    scene, settings = scene_of(experiment={"kind": "path", "displacements": [-0.3, 0.2]})
    assert places(scene, settings)[0] == (-0.3, True)  # from far away at once


def test_a_held_row_ends_by_time_place_or_rest() -> None:
    scene, settings = scene_of(**TIMED, experiment=PULL | {"method": "dynamic"})
    pressed, pulled = (hold_row(scene, settings, load, 0.5, Start.KEPT) for load in (0.3, -0.01))
    mass = settings.particles * scene.bodies.mass
    for row in (pressed, pulled):
        assert 10.0 <= row.steps * settings.time_step / settings.settle_time < 10.1
        assert row.rest == pytest.approx(0.1 * settings.tolerance * 0.5 / (1.0 + mass / settings.plate_mass))
        dragged = settings.particles * row.damping + settings.plate_damping
        assert row.drag == pytest.approx(dragged * settings.plate_mass / (settings.plate_mass + mass))
        assert row.through > settings.largest_displacement
    assert pressed.parted == pytest.approx(settings.rest - settings.cutoff - scene.bodies.spacing)
    tension = -settings.estimate.contact_force(pulled.parted)
    assert tension == pytest.approx(0.6 * settings.estimate.pull_off_force(), rel=0.05)
    assert pressed.parted < pulled.parted < 0.0


def test_a_load_comes_to_rest_to_a_share_of_itself_or_of_the_scale_of_forces() -> None:
    for force in (1e-6, 5.0):
        scene, settings = scene_of(**TIMED, experiment={"kind": "load", "force": force, "method": "dynamic"})
        (phase,) = planned(scene, settings)
        (row,) = phase.rows
        assert row == hold_row(scene, settings, force, max(force, settings.force_scale), Start.KEPT)
        assert phase.state


def test_a_sample_is_a_quarter_of_a_settling_time_after_the_one_before() -> None:
    scene, settings = scene_of(**HEAT, experiment={"kind": "load", "force": 0.3, "method": "dynamic"})
    assert 0.25 <= chunk_steps(settings) * settings.time_step / settings.settle_time < 0.27
    settling, sampling = planned(scene, settings)
    assert (len(settling.rows), settling.state, sampling.state) == (SETTLING_LOOKS, False, True)
    assert settling.rows[0] == UnderLoad(0.3, chunk_steps(settings))


@pytest.mark.parametrize("drawn", [{"loading_rate": 1e-3}, {"velocity": 1e-2, "stiffness": 0.3}])
def test_a_plate_has_parted_where_heat_and_attraction_bring_it_back_no_more(drawn: dict[str, float]) -> None:
    scene, settings = scene_of(SNAPPING, **HEAT, experiment=PULL | {"method": "dynamic"} | drawn)
    ramp, estimate = ramp_of(scene, settings), settings.estimate
    barrier, none = estimate.parted(BARRIER), estimate.parted(GONE)
    needed = estimate.pull_off_force() * (barrier - none) + 50.0 * 1e-3
    far = none - 0.5
    enough = next(n for n in range(1, 10 * ramp.most) if ramp.work(n, far, barrier) > needed)
    for number, place, parted in ((enough, far, True), (enough - 1, far, False), (10 * enough, none + 1e-6, False)):
        state = replace(sample(scene, settings, 0, 0.0), displacement=place)
        assert _has_parted(scene, settings, ramp, number, state) == parted
    assert _has_parted(scene, settings, ramp, ramp.most, replace(state, displacement=none - 2.0 * (barrier - none)))


def test_warnings_are_told_from_their_bounds_on() -> None:
    scene, settings = scene_of(experiment=PULL)
    state, share = sample(scene, settings, 0, 0.0), law_share(scene, settings)
    inside = replace(state, profile=replace(state.profile, pressure=np.where(np.abs(state.profile.x) < 9, 1.0, 0.0)))
    for factor, told in ((0.99, True), (1.01, False)):
        assert ("cutoff" in doubts(scene, replace(settings, tolerance=factor * share), (inside,))) == told
        near = replace(inside, smallest_distance=factor * settings.table_from)
        assert ("table_core" in doubts(scene, settings, (inside, near))) == told
    assert "snaps" not in doubts(scene, settings, (inside,))
    assert "snaps" in doubts(*scene_of(SNAPPING, experiment=PULL), (inside,))
    known = Outcome({"critical_radius": Quantity(-4.0, 1.0, LENGTH)}, (), {}, {}, ())
    for part, told in ((0.99, False), (1.01, True)):
        open_ = {"critical_radius": part * scene.accuracy.tolerance * 4.0}
        left = left_open_by_spacing(scene, replace(known, spacing_uncertainty=open_), ["critical_radius"])
        assert left == ({"critical_radius"} if told else set())


def test_what_a_plane_that_gives_way_changes_goes_with_the_springs_beside_it() -> None:
    def share(neighbours: float, stiffer: float) -> tuple[float, float]:
        tables = SCENES["plane"] | {"neighbours": {"stiffness": neighbours}}
        scene = scene_from_dict(tables)
        settings = settings_for(scene)
        state: Any = SimpleNamespace(force=-2.5)
        settings = replace(settings, plane_stiffness=stiffer * 1e6)
        return law_share(scene, settings), law_error(scene, settings, state)

    one, error = share(0.3, 1.0)
    assert error == pytest.approx(2.5 * one)
    assert 0.3e-6 < one < 3e-6  # some of k_n over that of the plane
    assert share(0.6, 1.0)[0] == pytest.approx(2.0 * one)
    assert share(0.3, 2.0)[0] == pytest.approx(0.5 * one)


@pytest.mark.parametrize("factor", [1.5, 2.5, 4.0, 12.0, 1 / 5.0, 1 / 12.0, 1 / 16.0, 1 / 25.0])
def test_a_drag_far_from_critical_is_said_to_take_long(factor: float) -> None:
    """The slowest decay of M x″ + c x′ + K x = 0, in timesteps; near critical a third less than is told."""
    experiment = {"kind": "load", "force": 0.3, "method": "dynamic"}
    _, usual = scene_of(**TIMED, experiment=experiment)
    scene, settings = scene_of(
        damping={"coefficient": factor * usual.damping},
        plate={"mass": usual.plate_mass, "damping": factor * usual.plate_damping}, experiment=experiment,
    )  # fmt: skip
    mass = usual.plate_mass + usual.particles * scene.bodies.mass
    stiffness = mass * (2.0 * math.pi / usual.settle_time) ** 2

    def settling(own: Settings) -> float:
        drag = own.particles * own.damping + own.plate_damping
        return -1.0 / float(np.roots([mass, drag, stiffness]).real.max()) / own.time_step

    steps = settling(settings) / settling(usual)
    told = slowness(scene, settings)
    if abs(math.log(steps / 10.0)) > math.log(1.35):
        assert bool(told) == (steps > 10.0)
    if told:
        assert float(told.split("about ")[1].split(" times")[0]) == pytest.approx(steps, rel=0.35)


def test_times_of_contacts_side_by_side_add_up(tmp_path: Any) -> None:
    scene, settings = scene_of(experiment=PULL)
    one, other = (RunContext(Deck(scene, settings), tmp_path, Silent(), 1.0) for _ in range(2))
    one.lammps_seconds, one.lammps_cpu_seconds, one.rows_seconds, one.steps = 1.0, 2.0, 3.0, 4
    for _ in range(2):
        other.add_time_of(one)
    assert (other.lammps_seconds, other.lammps_cpu_seconds, other.rows_seconds, other.steps) == (2.0, 4.0, 6.0, 8)


def test_the_integrators_bodies_stand_where_the_decks_do() -> None:
    for name in ("slide", "slide of few particles over another spacing"):
        scene = scene_from_dict(SCENES[name])
        settings = settings_for(scene)
        model = slide_model(scene, settings)
        lower, upper = bodies(scene, settings)
        by_name = {body.name: body.particles[:, [0, 2]] for body in (lower, upper)}
        assert model.lower == pytest.approx(by_name["lower"])
        assert model.upper == pytest.approx(by_name["upper"])
        assert slide_model(scene, settings, beyond=2).lower[1:-1] == pytest.approx(model.lower)
