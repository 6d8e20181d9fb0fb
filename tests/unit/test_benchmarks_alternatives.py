"""`validation.speed.alternatives`: its decks are what they say, and its numbers come out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from contact1d.potentials.table import Table
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.scene import Scene, read_scene
from contact1d.workflow.settings.settings import settings_for
from validation.speed.alternatives import SCENES, samplings, table_style


@pytest.mark.parametrize(("style", "size"), [("linear", "8192"), ("bitmap", "13")])
def test_a_table_style_is_in_the_decks_of_the_benchmark_alone(
    style: str, size: str, make_scene: Callable[..., Scene]
) -> None:
    scene = make_scene()
    settings = settings_for(scene)
    assert settings.law is not None
    settings = replace(settings, table=Table(settings.law, settings.cutoff, 8192))
    with table_style(style):
        assert f"table {style} {size}\n" in Deck(scene, settings).head
    assert "table spline 8192\n" in Deck(scene, settings).head


def test_thermostats_are_held_against_equipartition(tmp_path: Path) -> None:
    """A short study; the standard errors are a few times wider than those of a real one."""
    scene = read_scene(SCENES / "thermal_load.toml", ("bodies.particles=40", "accuracy.tolerance=0.05"))
    found = samplings(scene, tmp_path, steps=8_000)
    assert [(one.scheme, one.time_step / found[0].time_step) for one in found] == [
        (scheme, pytest.approx(factor)) for scheme in ("langevin", "gjf") for factor in (1.0, 2.0, 4.0, 8.0)
    ]
    for one in found:
        assert one.us_per_step > 0.0
        assert 0.0 < one.error < 0.1
    # Both at the scene's own time step; at eight times that only gjf is still without bias.
    for one in (found[0], *found[4:]):
        assert abs(one.variance - 1.0) < 5.0 * one.error
