"""Numbers out of all proportion: a sentence before anything runs, or the right answer; never LAMMPS's own words."""

import math
from pathlib import Path

import pytest
from scipy.optimize import brentq

from contact1d import SettingsError, read_scene, run, write_deck
from tests.scenes import LAW, SCENES, chains
from validation.references.interaction import PairInteraction

CLAIMED = 1e-3
"""Of a displacement, the scenes' own tolerance."""


def test_a_body_sunk_a_million_times_deeper_than_its_forces_reach_is_refused_before_anything_is_written(
    tmp_path: Path,
) -> None:
    tables = chains(100.0, neighbours={"stiffness": 0.3}, experiment={"kind": "load", "force": 1e5})
    with pytest.raises(SettingsError, match=r"box of .* LU by .* LU, and .* reach over .* LU only: use a smaller load"):
        write_deck(tables, tmp_path / "run")
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize(
    ("shipped", "change", "words"),
    [
        ("slide", "experiment.distance=1e20", "would need 2e\\+20 particles"),
        ("slide", "interaction.attraction.range=1e300", "opposite ones, at most"),
        ("steel_on_glass", "bodies.spacing='1e-300 µm'", "the spacing is too small compared with the body"),
    ],
)
def test_a_shipped_scene_with_such_a_number_is_refused_at_once(
    shipped: str, change: str, words: str, tmp_path: Path
) -> None:
    with pytest.raises(SettingsError, match=words):
        write_deck(read_scene(SCENES / f"{shipped}.toml", [change]), tmp_path / "run")


def test_a_single_pair_under_a_steep_body_is_the_closed_forms() -> None:
    """Its ends rise to 7e5 LU, beyond all forces: the box has larger bins."""
    tables = chains(1e-3, bodies={"particles": 7, "spacing": 10.0}, experiment={"kind": "load", "force": 0.3})
    found = run(tables)
    assert "bin_edge" in (found.folder / "in.lammps").read_text()
    pair = PairInteraction.of(*LAW)

    def off(r: float) -> float:
        return LAW[0] / LAW[1] * math.exp(-r / LAW[1]) - LAW[2] / LAW[3] * math.exp(-r / LAW[3]) - 0.3

    gap = brentq(off, 0.0, 1.0) - 2.0 * 0.3 / 0.83
    assert found.results.displacement.value == pytest.approx(pair.force_free_distance() - gap, rel=CLAIMED)


def test_neighbours_a_million_times_stiffer_than_the_bulk_come_to_rest_sideways() -> None:
    """The anchors lie far beside the chains, so the box needs larger bins."""
    tables = chains(
        100.0, bodies={"particles": 24}, neighbours={"stiffness": 0.83e6}, horizontal={}, accuracy={"tolerance": 1e-2},
        experiment={"kind": "path", "displacements": [0.0]},
    )  # fmt: skip
    found = run(tables)
    assert found.curve.force_uncertainty[-1] < CLAIMED
    assert "bin_edge" in (found.folder / "in.lammps").read_text()
