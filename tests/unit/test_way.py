"""Claims of a slide's room: how far its contact is felt, and that an automatic lower chain has room for the way.

References: the force of a row of opposite particles on a particle between two springs, solved for its distance.
"""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from contact1d import Scene, read_scene
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.model.calibration import CALIBRATION
from contact1d.workflow.model.chain import decay_length
from contact1d.workflow.model.cutoff import largest_holding_force
from contact1d.workflow.model.motion import contact_half_width, require_way, too_fast
from contact1d.workflow.model.settings import settings_for
from tests.scenes import chains

RADIUS, SPRING, SPACING = 30.0, 2.0, 0.8
LAW = (1.0, 0.5, 0.5, 1.0)
GRID = 3e-3
"""Relative: between 4000 distances."""


def slide(distance: float = 9.0, tolerance: float = 1e-3, **bodies: Any) -> Scene:
    own = {"mass": 1.0, "upper_offset": 0.5, "spacing": SPACING} | bodies
    return read_scene(
        chains(
            RADIUS, SPRING, law=LAW, horizontal={}, damping={"coefficient": "auto"}, plate={"free": ["x", "z"]},
            cantilever={"stiffness": 0.5, "velocity": 0.1}, bodies=own, accuracy={"tolerance": tolerance},
            experiment={"kind": "slide", "normal_force": 1.0, "distance": distance},
        )
    )  # fmt: skip


def row(r: float, cutoff: float) -> float:
    """Force of a straight row of opposite particles on one that stands over one of them at the distance r."""
    far = int(cutoff / SPACING) + 1
    distance = np.hypot(r, SPACING * np.arange(-far, far + 1))
    force = LAW[0] / LAW[1] * np.exp(-distance / LAW[1]) - LAW[2] / LAW[3] * np.exp(-distance / LAW[3])
    return float(np.sum(np.where(distance <= cutoff, force, 0.0) * r / distance))


@pytest.mark.parametrize("tolerance", [1e-1, 1e-2, 1e-3])
def test_a_contact_reaches_to_where_the_tolerances_share_of_its_largest_force_is_felt(tolerance: float) -> None:
    of = slide(tolerance=tolerance, particles=200, upper_particles=80)
    settings = settings_for(of)
    cutoff, deepest = settings.forces.cutoff, settings.largest_displacement

    def gap(r: float) -> float:
        return r - 2.0 * row(r, cutoff) / SPRING

    innermost = brentq(lambda r: gap(r) - settings.forces.rest + deepest, 0.05, 3.0)
    places = np.linspace(innermost, cutoff, 4000)
    forces = np.abs([row(r, cutoff) for r in places])
    felt = places[np.flatnonzero(forces > tolerance * forces.max())[-1]]
    half = math.sqrt(2.0 * RADIUS * (gap(float(felt)) - settings.forces.rest + deepest))
    assert half < 0.5 * 79 * SPACING
    assert contact_half_width(of, settings) == pytest.approx(half, rel=GRID)


def test_a_chain_is_no_wider_than_its_particles() -> None:
    of = slide(particles=60, upper_particles=8)
    assert contact_half_width(of, settings_for(of)) == pytest.approx(0.5 * 7 * SPACING)


@pytest.mark.parametrize("distance", [4.0, 9.0, 30.0])
@pytest.mark.parametrize("offset", [0.0, 0.5, -6.0, 6.0])
def test_an_automatic_lower_chain_is_long_enough_and_no_longer_than_the_way_asks_for(
    distance: float, offset: float
) -> None:
    of = slide(distance, upper_offset=offset)
    settings = settings_for(of)
    require_way(of, settings)
    longer = settings.chains.lower - settings.chains.upper
    assert 2.0 * (distance + abs(offset)) / SPACING <= longer < 2.0 * (distance + abs(offset)) / SPACING + 2.0


@pytest.mark.parametrize("spacing", [0.5, 1.3])
def test_a_lower_chain_of_another_spacing_is_as_long_as_the_upper_one_and_the_way(spacing: float) -> None:
    of = slide(upper_spacing=spacing)
    settings = settings_for(of)
    length = settings.chains.upper * spacing + 2.0 * 9.5
    assert length <= settings.chains.lower * SPACING < length + 4.0 * SPACING
    require_way(of, settings)


def test_no_way_needs_no_more_particles_below() -> None:
    of = read_scene(chains(RADIUS, experiment={"kind": "load", "force": 0.05}))
    settings = settings_for(of)
    assert settings.chains.lower == settings.chains.upper
    require_way(of, settings)
    assert too_fast(of) == ""


@pytest.mark.parametrize("offset", [0.5, -3.0])
def test_a_way_that_is_said_to_be_possible_is_and_a_longer_one_is_not(offset: float) -> None:
    def try_out(distance: float) -> None:
        of = slide(distance, particles=60, upper_particles=12, upper_offset=offset)
        require_way(of, settings_for(of))

    with pytest.raises(SettingsError, match="a distance of at most") as caught:
        try_out(60.0)
    told = re.search(r"a distance of at most (\S+) LU", str(caught.value))
    assert told is not None
    room = float(told[1])
    try_out(room * (1.0 - 1e-3))
    with pytest.raises(SettingsError):
        try_out(room * (1.0 + 1e-3))
    needed = caught.value.changes[0].values
    assert needed["bodies.upper_particles"] == 12
    of = slide(60.0, particles=needed["bodies.particles"], upper_particles=12, upper_offset=offset)
    require_way(of, settings_for(of))


def test_a_way_too_short_for_a_mean_is_not_advised() -> None:
    """Four spacings: a run-in and three periods."""
    rooms, silent = [], 0
    for particles in range(18, 42, 2):
        of = slide(60.0, particles=particles, upper_particles=12)
        with pytest.raises(SettingsError, match="too short for the sliding distance") as caught:
            require_way(of, settings_for(of))
        told = re.search(r"a distance of at most (\S+) LU", str(caught.value))
        silent += told is None
        rooms += [float(told[1])] if told else []
    assert silent > 0
    assert 4.0 * SPACING <= min(rooms) < 4.0 / SPACING


@pytest.mark.parametrize("displacement", [-0.5, 0.3])
def test_an_automatic_chain_of_bodies_that_only_repel_ends_where_nothing_is_felt(displacement: float) -> None:
    """A tenth further, and two particles on each side."""
    of = read_scene(
        chains(
            RADIUS, SPRING, bodies={"spacing": SPACING}, interaction={"repulsion": {"amplitude": 0.2, "range": 0.3}},
            experiment={"kind": "path", "displacements": [displacement]},
        )
    )  # fmt: skip
    settings = settings_for(of)
    felt = math.sqrt(2.0 * RADIUS * max(0.0, displacement)) if displacement > 0.0 else 0.0  # rest is the cutoff
    half = 0.5 * settings.chains.upper * SPACING
    assert 1.1 * max(felt, SPACING) + 2.0 * SPACING <= half * (1.0 + 1e-6) < 1.1 * max(felt, SPACING) + 3.0 * SPACING
    assert settings.chains.upper % 2 == 0


@pytest.mark.parametrize(("spacing", "particles"), [(0.5, 8), (0.9, 4), (0.7, 6), (0.1, 42)])
def test_an_automatic_chain_is_no_longer_than_its_body(spacing: float, particles: int) -> None:
    """Of a circle of 2.1 LU: the outermost particles are on it still, and one more on each side would not be."""
    body = {"spacing": spacing, "profile": {"kind": "circle", "radius": 2.1}}
    of = read_scene(chains(1.0, law=LAW, bodies=body, experiment={"kind": "path", "displacements": [0.3]}))
    found = settings_for(of).chains.upper
    assert found == particles
    assert 0.5 * (found - 1) * spacing <= 2.1 < 0.5 * (found + 1) * spacing


@pytest.mark.parametrize("spacing", [0.5, 0.8])
def test_a_punch_is_as_many_particles_wide_as_it_is(spacing: float) -> None:
    body = {"spacing": spacing, "profile": {"kind": "flat_punch", "radius": 4.0}}
    of = read_scene(chains(1.0, law=LAW, bodies=body, experiment={"kind": "path", "displacements": [0.3]}))
    assert settings_for(of).chains.upper == round(8.0 / spacing)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
@pytest.mark.parametrize("law", [LAW, (0.4, 0.2, 0.2, 0.4), (1.0, 0.3, 0.001, 1.0)])
def test_a_pair_that_comes_within_reach_changes_neither_the_force_on_it_nor_that_along_x(
    law: tuple[float, ...], tolerance: float
) -> None:
    """At an automatic cutoff it is a tenth of the tolerance of the largest force along x, and no more than at rest."""
    of = slide(tolerance=tolerance)
    terms = [{"amplitude": law[i], "range": law[i + 1]} for i in (0, 2)]
    of = of.with_({"interaction.repulsion": terms[0], "interaction.attraction": terms[1]})
    settings = settings_for(of)
    assert settings.forces.law is not None
    at_cutoff = abs(float(settings.forces.law.force(np.asarray([settings.forces.cutoff]))[0]))
    along = largest_holding_force(settings.forces.law, SPACING, 0.0)
    far = law[2] / law[3] * math.exp(-settings.forces.cutoff / law[3])
    at_rest = law[2] / law[3] * math.exp(-settings.forces.law.force_free_distance() / law[3])
    share = CALIBRATION.cutoff * tolerance
    assert at_cutoff <= far <= min(0.1 * tolerance * along, share * at_rest) * (1.0 + 1e-9)
    assert settings.forces.cutoff == 40.0 * law[3] or far == pytest.approx(
        min(0.1 * tolerance * along, share * at_rest)
    )


def test_without_motion_along_x_only_the_springs_across_hold_a_chain() -> None:
    """ℓ = s/arcosh(1 + k/2k_n)."""
    body = {"bulk_stiffness_tangential": 0.1, "spacing": SPACING}
    of = read_scene(
        chains(RADIUS, SPRING, bodies=body, neighbours={"stiffness": 3.0}, experiment={"kind": "load", "force": 0.05})
    )
    assert decay_length(of) == pytest.approx(SPACING / math.acosh(1.0 + 0.5 * SPRING / 3.0), rel=1e-12)
