"""Claim: what a refusal says is possible is possible, and a little more is refused: of chains, profiles and ways."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from contact1d import Scene, read_scene
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.laws.shape import tabulated
from contact1d.workflow.model.chain import in_words, require_reach, require_rows, require_steps
from contact1d.workflow.model.dynamics import drive_steps
from contact1d.workflow.model.motion import require_way, too_fast
from contact1d.workflow.model.settings import Settings, settings_for
from tests.scenes import chains

LOAD = {"kind": "load", "force": 0.05}
CIRCLE = {"kind": "circle", "radius": 30.0}
FEWEST_ROWS, MOST_ROWS, FEWEST_STEPS = 20, 50, 5
"""Rows in a spacing of a drive's way, and timesteps in a row."""
RELAXING = 0.5
"""ω Δt of a relaxation without time."""
ROUND_OFF = 1e-12
FIGURES = 1e-3
"""Relative: four figures of a number in a message."""


def slide(**bodies: Any) -> dict[str, Any]:
    own = {"mass": 1.0, "upper_offset": 0.5, "upper_particles": 12, "spacing": 0.8} | bodies
    return chains(
        30.0, 2.0, law=(1.0, 0.5, 0.5, 1.0), horizontal={}, damping={"coefficient": "auto"}, plate={"free": ["x", "z"]},
        cantilever={"stiffness": 0.5, "velocity": 0.1}, bodies=own,
        experiment={"kind": "slide", "normal_force": 1.0, "distance": 9.0},
    )  # fmt: skip


def wide(particles: float) -> dict[str, Any]:
    return chains(1.0, bodies={"particles": round(particles), "profile": CIRCLE}, experiment=LOAD)


def narrow(spacing: float, particles: Any) -> dict[str, Any]:
    body = {"particles": particles, "profile": {"kind": "circle", "radius": 3.0}, "spacing": spacing}
    return chains(1.0, bodies=body, experiment={"kind": "path", "displacements": [0.01]})


def stiff(stiffness: float) -> dict[str, Any]:
    return chains(100.0, stiffness, bodies={"particles": 40}, experiment={"kind": "pull_off", "preload": 0.3})


def soft(force: float) -> dict[str, Any]:
    return chains(100.0, 1e-9, bodies={"particles": 20}, experiment={"kind": "load", "force": force})


@pytest.mark.parametrize(
    ("tables", "refused", "told", "step"),
    [
        (wide, 80, r"at most (\d+) particles", 2.0),
        (lambda s: narrow(s, "auto"), 2.5, r"a bodies.spacing below (\S+) LU", 1.0 + FIGURES),
        (lambda s: narrow(s, 3), 3.5, r"a bodies.spacing below (\S+) LU", 1.0 + FIGURES),
        (lambda n: slide(particles=round(n)), 20, r"at least (\d+) bodies.particles", -2.0),
    ],
)  # fmt: skip
def test_what_is_said_to_be_possible_is_and_no_more(
    tables: Callable[[float], dict[str, Any]], refused: float, told: str, step: float
) -> None:
    def try_out(value: float) -> None:
        scene = read_scene(tables(value))
        require_way(scene, settings_for(scene))

    with pytest.raises(SettingsError, match=told) as caught:
        try_out(refused)
    found = re.search(told, str(caught.value))
    assert found is not None
    possible = float(found[1].rstrip(":,."))
    near = FIGURES if abs(step) < 2.0 else 0.0
    try_out(possible * (1.0 - near))
    with pytest.raises(SettingsError, match=told):
        try_out(possible * step if near else possible + step)


def test_a_cutoff_reaches_over_five_thousand_particles_at_most() -> None:
    scene = read_scene(slide(spacing=0.5))
    with pytest.raises(SettingsError, match=r"cutoff below 1250 LU"):
        require_reach(scene, 2000.0)
    require_reach(scene, 1249.9)
    with pytest.raises(SettingsError, match="would interact"):
        require_reach(scene, 1250.1)


def test_springs_that_are_said_to_be_possible_are_within_a_factor_of_what_is() -> None:
    with pytest.raises(SettingsError, match=r"(\S+) FU/LU, which") as caught:
        settings_for(read_scene(stiff(1e13)))
    possible = float(str(caught.value).partition(" FU/LU, which")[0].split()[-1])
    settings_for(read_scene(stiff(possible)))
    with pytest.raises(SettingsError, match="practically rigid"):
        settings_for(read_scene(stiff(5.0 * possible)))


def falling(scene: Scene, from_step: float, to_step: float) -> float:
    """The least `longest_move` with which a path's rows can be counted."""
    for _ in range(60):
        middle = float(np.sqrt(from_step * to_step))
        try:
            require_rows(scene, middle, ())
            to_step = middle
        except SettingsError:
            from_step = middle
    return to_step


def test_a_path_may_take_a_million_rows() -> None:
    """Only ways towards the other body are done in steps: 3 LU here, in 10⁶ of them."""
    scene = read_scene(
        chains(100.0, bodies={"particles": 20}, experiment={"kind": "path", "displacements": [1.0, -1.0, 1.0]})
    )
    assert falling(scene, 1e-9, 1.0) == pytest.approx(3e-6, rel=1e-4)
    require_steps([2**31 - 1, 5])
    with pytest.raises(SettingsError, match="2147483647 can be counted"):
        require_steps([2**31])


def test_a_drive_is_too_fast_above_the_velocity_that_is_told() -> None:
    def told(velocity: float) -> str:
        tables = slide(particles=60)
        return too_fast(read_scene(tables | {"cantilever": {"stiffness": 0.5, "velocity": velocity}}))

    words = told(3.0)
    limit = float(re.findall(r"velocity below (\S+) LU/TU", words)[0])
    assert limit == pytest.approx(0.8 * np.sqrt(2.0) / (2.0 * np.pi), rel=FIGURES)  # s √(k/m)/2π
    assert told(limit * (1.0 - FIGURES)) == ""
    assert told(limit * (1.0 + FIGURES))
    swing, passing = re.findall(r"in (\S+) TU, less than .* springs, (\S+) TU", words)[0]
    assert float(swing) == pytest.approx(0.8 / 3.0, rel=0.01)
    assert float(passing) == pytest.approx(2.0 * np.pi / np.sqrt(2.0), rel=0.01)


@pytest.mark.parametrize("longest", [1e-3, 0.011, 0.07, 0.4, 3.0, 50.0])
def test_rows_and_timesteps_make_the_drives_way_exactly(longest: float) -> None:
    """No timestep is longer than it may be, none needlessly short, and every spacing has its rows."""
    path = [[0.1, 3.7], [0.0, 0.5], [-0.31, 2.0]]
    scene = read_scene(slide(particles=60) | {"experiment": {"kind": "slide", "normal_force": 1.0, "path": path}})
    for leg, (velocity, distance) in zip(drive_steps(scene, longest), path, strict=True):
        time = distance / (abs(velocity) or 0.1)
        assert leg.velocity == velocity
        assert leg.rows * leg.row_time == pytest.approx(time, rel=1e-12)
        assert leg.steps % FEWEST_STEPS == 0
        assert leg.time_step <= longest * (1.0 + 1e-9)
        assert leg.steps == FEWEST_STEPS or time / leg.rows / (leg.steps - FEWEST_STEPS) > longest
        per_spacing = leg.rows / (distance / 0.8)
        assert FEWEST_ROWS <= per_spacing < MOST_ROWS + 0.8 / distance
        # As many rows as measuring is worth: ten timesteps each, where that is possible at all.
        wanted = np.clip(time / (distance / 0.8) / longest / 10.0, FEWEST_ROWS, MOST_ROWS)
        assert per_spacing == pytest.approx(wanted, abs=1.0 + 0.8 / distance)


@pytest.mark.parametrize("share", [0.02, 0.3, 0.9, 1.0, 4.0])
def test_a_light_plate_swings_no_longer_against_its_particles_than_one_of_their_mass(share: float) -> None:
    """Reference: eigenvalues of two masses on a stiff spring, of which the particles have a drag of their own."""
    particles, spring = 40.0, 1e7
    plate = share * particles
    load = LOAD | {"method": "dynamic"}
    tables = chains(100.0, bodies={"particles": 40, "mass": 1.0}, damping={"coefficient": "auto"}, experiment=load)
    chosen = settings_for(read_scene(tables | {"plate": {"mass": plate}})).motion
    rate, drag = chosen.damping, chosen.plate_damping
    motion = np.array([
        [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0],
        [-spring / plate, spring / plate, -drag / plate, 0.0],
        [spring / particles, -spring / particles, 0.0, -rate],
    ])  # fmt: skip
    values = np.linalg.eigvals(motion)
    swing = values[np.abs(values.imag) > 1.0].real
    assert swing == pytest.approx(-0.25 * rate if share <= 1.0 else -0.5 * rate * share / (1.0 + share), rel=1e-4)
    assert (drag < ROUND_OFF * particles * rate) == (share >= 1.0)


def sampled_stiffness(settings: Settings) -> float:
    """Stiffness [FU/LU] of the motion that the time step of a relaxation is made for, of particles of 1 MU."""
    return (RELAXING / settings.motion.time_step) ** 2


def between(count: int) -> Any:
    """Neighbours on each other, over the stiffness of a spring."""
    return 2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1)


@pytest.mark.parametrize("neighbours", [None, 0.3, 20.0])
def test_the_stiffest_motion_of_two_chains_is_no_stiffer_than_what_the_timestep_is_made_for(
    neighbours: float | None,
) -> None:
    """Reference: the eigenvalues of two straight chains face to face at the closest distance, pairs in line alone."""
    tables = chains(100.0, bodies={"particles": 30, "bulk_stiffness_tangential": 1.1}, experiment=LOAD)
    if neighbours is not None:
        tables["neighbours"] = {"stiffness": neighbours}
    scene = read_scene(tables | {"horizontal": {}})
    settings = settings_for(scene)
    assert settings.forces.law is not None
    pair = float(settings.forces.law.stiffness(settings.forces.closest))
    chain = 1.1 * np.eye(30) + (neighbours or 0.0) * between(30)
    matrix = np.block(
        [[chain + pair * np.eye(30), -pair * np.eye(30)], [-pair * np.eye(30), chain + pair * np.eye(30)]]
    )
    stiffest = float(np.linalg.eigvalsh(matrix).max())
    assert stiffest <= sampled_stiffness(settings) <= 1.3 * stiffest


@pytest.mark.parametrize("neighbours", [0.3, 20.0])
def test_so_is_the_stiffest_motion_of_a_chain_on_a_plane(neighbours: float) -> None:
    tables = chains(100.0, bodies={"particles": 30, "lower": "rigid_plane"}, interaction=None, experiment=LOAD)
    settings = settings_for(read_scene(tables | {"neighbours": {"stiffness": neighbours}}))
    each = settings.forces.bulk_stiffness + settings.forces.plane_stiffness
    stiffest = float(np.linalg.eigvalsh(each * np.eye(30) + neighbours * between(30)).max())
    assert stiffest <= sampled_stiffness(settings) <= 1.3 * stiffest


def test_a_large_system_is_told_with_how_many_each_particle_feels() -> None:
    scene = read_scene(slide(spacing=0.5))
    assert in_words(scene, 19_000, 2.0) == ""
    assert "20000 particles per body, each within reach of 10 opposite ones" in in_words(scene, 20_000, 2.0)
    assert "each within reach of 162 opposite ones" in in_words(scene, 2_000, 40.0)


def test_a_rigid_plane_has_neither_snaps_nor_teeth() -> None:
    plane = {"bodies": {"particles": 20, "lower": "rigid_plane"}, "interaction": None}
    for tables, snaps in (
        (chains(100.0, **plane, experiment=LOAD), False),
        (chains(100.0, law=(0.018, 0.03, 0.009, 0.06), bodies={"particles": 40}, experiment=LOAD), False),
        (chains(100.0, law=(0.18, 0.03, 0.09, 0.06), bodies={"particles": 40}, experiment=LOAD), True),
    ):
        settings = settings_for(read_scene(tables))
        assert settings.snaps == snaps
        if snaps or settings.forces.law is None:
            assert settings.has_several_maxima == snaps


@pytest.mark.parametrize("spacing", [0.01, 1.0, 8.0])
def test_a_tabulated_body_is_the_body_down_to_a_fraction_of_its_first_spacing(spacing: float) -> None:
    body = read_scene(wide(20)).bodies.model_copy(update={"spacing": spacing})
    x = np.geomspace(0.0101 * spacing, 20.0, 500)
    assert tabulated(body, spacing).height(x) == pytest.approx(body.height(x), rel=5e-4)
    assert tabulated(body, spacing).reach == pytest.approx(body.reach, rel=1e-12)
