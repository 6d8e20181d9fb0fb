"""What table and cutoff change in a force: the sum over all pairs, and the claim against runs that leave less out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.law_error import left_out
from contact1d.analysis.pressure import Profile
from contact1d.analysis.reference.interaction import Exponential, PairInteraction
from contact1d.potentials import DoubleExponential
from contact1d.potentials import Exponential as Term
from contact1d.potentials.table import Table
from contact1d.workflow.experiments.running.law_error import COMPLIANCE_FACTOR, law_error, law_share
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import Settings, settings_for
from tests.scenes import LAW, chains

SUM = 1e-9
"""Two sums over the same pairs, relative; the tail beyond its last range is in neither."""
SMALLEST_LOAD, WIDE = 0.1, 3.0
"""Smallest load over the largest tension of which the share that is warned of is to tell the error; at most so many
times as much: it is one for every body and spacing. 1.1 to 2.1 measured, spacings from 0.1 to 1, radii to 1000."""
SHARP = 20.0
"""A claim above the error by more than this would be no estimate."""


def pressed(spacing: float = 1.0, **interaction: Any) -> Scene:
    """Two chains that touch over a width, at a prescribed displacement; the claim is for the force there."""
    bodies = {"particles": 60, "spacing": spacing}
    tables = chains(100.0, bodies=bodies, experiment={"kind": "path", "displacements": [0.2]})
    tables["interaction"] |= interaction
    return scene_from_dict(tables)


def with_points(scene: Scene, points: int) -> Settings:
    settings = settings_for(scene)
    assert settings.law is not None
    return replace(settings, table=Table(settings.law, settings.cutoff, points))


@pytest.mark.parametrize("spacing", [1.0, 0.4])
def test_it_is_the_sum_over_all_pairs(tmp_path: Path, spacing: float) -> None:
    scene = pressed(spacing, cutoff=1.5)
    settings = settings_for(scene)
    state = run(scene, tmp_path / "run", figures=False, settings=settings).outcome.states[-1]
    profile, law, table = state.profile, settings.law, settings.table
    assert law is not None
    assert table is not None
    across = profile.x[:, None] - profile.x[None, :]
    up = profile.z_upper[:, None] - profile.z_lower[None, :]
    r = np.hypot(across, up)
    felt = r < settings.cutoff + 5.0 * law.longest_range
    kept = np.where(r <= settings.cutoff, table.force(np.minimum(r, settings.cutoff)), 0.0)
    error = np.sum((np.abs(kept - law.force(r)) * np.abs(up) / r)[felt])
    assert law_error(scene, settings, state) == pytest.approx(COMPLIANCE_FACTOR * error, rel=SUM)


@pytest.mark.parametrize("spacing", [0.1, 0.4, 1.0, 3.0])
@pytest.mark.parametrize("seed", range(3))
def test_what_is_left_out_is_summed_over_all_pairs_of_any_rows(seed: int, spacing: float) -> None:
    """Rows at any distance, through each other, and of three particles; pairs that coincide are as far as the core."""
    random = np.random.default_rng(seed)
    law = DoubleExponential(Term(2.0, 0.3), Term(1.0, 0.45))
    table = Table(law, random.uniform(0.5, 2.0), 2000)
    reach = table.cutoff + 5.0 * 0.45
    for count, height in ((3, 0.2), (12, 0.0), (12, 0.6), (40, 0.95 * reach), (30, 1.2 * reach)):
        x = spacing * (np.arange(count) - 0.5 * (count - 1))
        lower = np.full(count, random.choice([-9.0, 9.0]))
        upper = lower + height + 0.05 * reach * random.uniform(-1.0, 1.0, count)
        if height == 0.0:
            upper[3] = lower[3]  # where its opposite stands
        found = left_out(law, table, Profile(x, lower, upper, 0.0 * x, 0.0 * x))
        total = 0.0
        for across, up in (
            (xu - xl, zu - zl) for xu, zu in zip(x, upper, strict=True) for xl, zl in zip(x, lower, strict=True)
        ):
            r = max(float(np.hypot(across, up)), table.core)
            if r < reach:
                kept = float(table.force(r)) if r <= table.cutoff else 0.0
                total += abs(kept - float(law.force(r))) * abs(up) / r
        assert found == pytest.approx(total, rel=SUM, abs=1e-300)


@pytest.mark.parametrize(("cutoff", "points"), [(1.5, 8000), (2.0, 8000), (4.0, 300), (4.0, 500)])
def test_it_covers_what_a_cutoff_or_a_table_changes_and_no_more(tmp_path: Path, cutoff: float, points: int) -> None:
    scene, exact = pressed(cutoff=cutoff), pressed(cutoff=6.0)
    settings = with_points(scene, points)
    coarse = run(scene, tmp_path / "coarse", figures=False, settings=settings).outcome.states[-1]
    fine = run(exact, tmp_path / "fine", figures=False, settings=with_points(exact, 100_000)).outcome.states[-1]
    error = abs(coarse.force - fine.force)
    assert error <= law_error(scene, settings, coarse) <= SHARP * error


@pytest.mark.parametrize("spacing", [1.0, 0.5, 0.25])
@pytest.mark.parametrize("cutoff", [1.0, 1.5, 2.0, 2.5])
def test_the_share_that_is_warned_of_covers_what_lies_beyond_the_cutoff(spacing: float, cutoff: float) -> None:
    """Rigid bodies, every pair of particles summed: what the cutoff leaves out, over a tenth of the largest tension."""
    radius = 40.0
    bodies = {"particles": int(30.0 / spacing), "spacing": spacing}
    tables = chains(radius, bodies=bodies, experiment={"kind": "path", "displacements": [0.0]})
    tables["interaction"] |= {"cutoff": cutoff}
    scene = scene_from_dict(tables)
    law = PairInteraction(Exponential(*LAW[:2]), Exponential(*LAW[2:]))
    x = (np.arange(bodies["particles"]) - 0.5 * (bodies["particles"] - 1)) * spacing
    largest = beyond = 0.0
    for apex in law.force_free_distance() + np.linspace(0.0, 1.0, 41):
        up = (apex + x**2 / (2.0 * radius))[:, None]
        r = np.hypot(x[:, None] - x[None, :], up)
        tension = -law.force(r) * up / r
        if tension.sum() > largest:
            largest, beyond = float(tension.sum()), float(tension[r > cutoff].sum())
    share = beyond / (SMALLEST_LOAD * largest)
    assert share <= law_share(scene, settings_for(scene)) <= WIDE * share
