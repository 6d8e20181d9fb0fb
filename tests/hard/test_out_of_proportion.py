"""Numbers out of all proportion: a sentence before anything runs, or the right answer; never LAMMPS's own words."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from contact1d import read_scene, run
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.model.settings import settings_for
from tests.scenes import chains

SHIPPED = Path(__file__).parents[2] / "lammps_inputs" / "scenes"

LOAD = {"kind": "load", "force": 0.5}
CLAIMED = 1e-3
"""Of a displacement, the scenes' own tolerance."""


REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "a radius in metres": (chains(1e-6, experiment=LOAD), r"too sharp .* rises by 1\.25e\+05 LU .* another unit"),
    "a radius in metres on a plane": (
        chains(1e-6, bodies={"lower": "rigid_plane"}, interaction=None, experiment=LOAD),
        r"too sharp for its chain",
    ),
    "an endless attraction": (
        chains(100.0, law=(0.18, 0.13, 0.09, 1e20), experiment=LOAD),
        r"would interact with .* at most 5000 .* another unit",
    ),
    "a spacing far below the ranges": (chains(100.0, bodies={"spacing": 1e-6}, experiment=LOAD), r"would interact"),
    "a spacing far above the radius": (chains(100.0, bodies={"spacing": 1e6}, experiment=LOAD), r"too sharp"),
    "a load that a planet carries": (chains(100.0, experiment={"kind": "load", "force": 1e9}), r"particles per body"),
    "a body sunk a million times deeper than its forces reach": (
        chains(1000.0, neighbours={"stiffness": 0.3}, experiment={"kind": "load", "force": 1e6}),
        r"box of .* LU by .* LU, and their forces reach over .* LU only: use a smaller load",
    ),
    "more pairs than any memory holds": (
        chains(100.0, law=(0.18, 0.13, 0.09, 150.0), bodies={"particles": 10_000_000}, experiment=LOAD),
        r"GB of memory, and this machine has",
    ),
    "a path into the earth": (
        chains(100.0, bodies={"particles": 20}, experiment={"kind": "path", "displacements": [0.0, 1e6]}),
        r"the path would need .* load steps",
    ),
    "springs of nothing": (
        chains(100.0, bodies={"particles": 20, "bulk_stiffness": 1e-300}, experiment=LOAD),
        r"would reach .* another unit",
    ),
    "springs that digits do not resolve": (
        chains(100.0, stiffness=1e12, bodies={"particles": 40}, experiment={"kind": "pull_off", "preload": 0.3}),
        r"too stiff to resolve: .* FU/LU, which is practically rigid",
    ),
    "a repulsion beside which an attraction is nothing": (
        chains(
            100.0,
            law=(1e300, 0.13, 0.09, 0.26),
            bodies={"particles": 20},
            damping={"coefficient": "auto"},
            plate={},
            experiment={"kind": "pull_off", "method": "dynamic", "preload": 1.0},
        ),
        r"a load step would need .* timesteps",
    ),
    "a plate that never moves": (
        chains(100.0, damping={"coefficient": "auto"}, plate={"mass": 1e30}, experiment=LOAD | {"method": "dynamic"}),
        r"a load step would need .* timesteps.* Use masses",
    ),
}


@pytest.mark.parametrize("distance", [1e6, 1e20])
@pytest.mark.parametrize("shipped", ["slide", "prandtl_tomlinson"])
def test_a_slide_around_the_earth_is_refused_at_once(shipped: str, distance: float) -> None:
    scene = read_scene(SHIPPED / f"{shipped}.toml", [f"experiment.distance={distance!r}"])
    with pytest.raises(SettingsError, match=r"the slide would need .* load steps|would need 2e\+20 particles"):
        settings_for(scene)


def test_a_spacing_of_nothing_is_refused_at_once() -> None:
    """It took 10 s to find that no chain fits."""
    scene = read_scene(SHIPPED / "steel_on_glass.toml", ["bodies.spacing='1e-300 µm'"])
    with pytest.raises(SettingsError, match="the spacing is too small compared with the body"):
        settings_for(scene)


@pytest.mark.parametrize("name", REFUSED)
def test_it_is_refused_in_words_before_anything_runs(name: str, tmp_path: Path) -> None:
    tables, words = REFUSED[name]
    with pytest.raises(SettingsError, match=words):
        run(read_scene(tables), tmp_path / "run")
    assert not (tmp_path / "run").exists()


def test_a_single_pair_under_a_steep_body_runs(tmp_path: Path) -> None:
    """Its ends rise to 7e7 LU, beyond all forces: the box has larger bins, and the pair is the closed form's."""
    scene = read_scene(
        chains(1e-4, bodies={"particles": 61, "spacing": 4.0}, experiment={"kind": "load", "force": 0.3})
    )
    deck = Deck(scene, settings_for(scene))
    assert "bin_edge" in deck.head
    done = run(scene, tmp_path / "run", figures=False)
    pair = settings_for(scene).forces.law
    assert pair is not None
    distance = done.outcome.states[-1].smallest_distance
    assert float(pair.force(distance)) == pytest.approx(0.3, rel=CLAIMED)
    gap = distance - 2.0 * 0.3 / scene.bulk_stiffness
    assert done.outcome.quantities["displacement"].value == pytest.approx(pair.force_free_distance() - gap, rel=CLAIMED)


def test_neighbours_a_million_times_stiffer_than_the_bulk_run_sideways(tmp_path: Path) -> None:
    """The anchors lie far beside the chains, so the box needs larger bins; one row comes to rest, that is all."""
    tables = chains(
        100.0,
        bodies={"particles": 24},
        neighbours={"stiffness": 0.83e6},
        horizontal={},
        experiment={"kind": "path", "displacements": [0.0]},
        accuracy={"tolerance": 1e-2},
    )
    scene = read_scene(tables)
    done = run(scene, tmp_path / "run", figures=False)
    assert done.outcome.states[-1].residual < CLAIMED
    assert "bin_edge" in Deck(scene, settings_for(scene)).head


def test_a_range_without_end_is_refused_in_a_slide_too(tmp_path: Path) -> None:
    """Its law is summed over a row of opposite particles before the cutoff is known."""
    scene = read_scene(SHIPPED / "slide.toml", ["interaction.attraction.range=1e300"])
    with pytest.raises(SettingsError, match="opposite ones, at most"):
        run(scene, tmp_path / "run", figures=False)


def test_a_tangential_of_too_many_rows_is_refused(tmp_path: Path) -> None:
    scene = read_scene(SHIPPED / "mindlin.toml", ["experiment.displacements.steps=1000000"])
    with pytest.raises(SettingsError, match="use fewer steps in"):
        run(scene, tmp_path / "run", figures=False)
