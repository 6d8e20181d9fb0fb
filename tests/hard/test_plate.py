"""Plates that are hard for `fix rigid` and for the search: of three particles, nearly a line, with momentum."""

from pathlib import Path

import pytest

from contact1d import RunError, read_scene, run
from tests.scenes import chains
from validation.hard.cases import TENSION, PairCase, reach, shaped
from validation.references.interaction import PairInteraction
from validation.references.model import ChainModel
from validation.references.pull_off import pull_off

LITTLE_DRAG = 0.09626
"""A tenth of the automatic one [FU·TU/LU]."""


def test_a_plate_with_momentum_does_not_break_the_contact_too_early() -> None:
    """A weakly damped plate shoots past its place: the stated bracket still holds the pull-off force."""
    numbers = (0.4, 0.25, 0.2, 0.5)
    tables = chains(
        50.0, law=numbers, damping={"coefficient": 0.02}, plate={"mass": 20.0, "damping": 0.3},
        accuracy={"tolerance": 1e-2}, experiment={"kind": "pull_off", "method": "dynamic", "preload": 0.5},
    )  # fmt: skip
    finished = run(tables)
    law = PairInteraction.of(*numbers)
    model = ChainModel(finished.profiles["zero_load"].x.size, 0.83, law, radius=50.0)
    exact = pull_off(model, 0.5, step=0.06).adhesion_force
    found = finished.results.adhesion_force
    assert abs(found.value - exact) <= found.uncertainty <= 2e-2 * exact


def test_a_plate_that_swings_past_a_maximum_has_no_pull_off_force(tmp_path: Path) -> None:
    """With little drag it loses pairs that it would have held: F_A is uncertain by more than half, and not reported."""
    case = PairCase("maximum", 1.5, shaped("parabola", 9, reach(1.5)), 9, 3.0 * TENSION, 1e-2, dynamic=True)
    tables = {"title": "maximum"} | case.scene() | {"damping": {"coefficient": LITTLE_DRAG}, "plate": {"damping": 0.0}}
    with pytest.raises(RunError, match=r"not reported.*adhesion_force \(± 0\.05"):
        run(read_scene(tables), tmp_path / "run", figures=False)


@pytest.mark.parametrize("mass", [1e-3, 1e3])
def test_a_light_plate_and_a_heavy_one_come_to_rest_where_pairs_say(mass: float) -> None:
    """A light one swings against its particles, whose drag does not stop it; under a heavy one particles lag behind."""
    case = PairCase("mass", 0.3, shaped("flat_punch", 10, 0.0), 10, 0.0, 1e-3, dynamic=True)
    load = 5.0 * TENSION
    tables = case.scene() | {"title": "mass", "plate": {"mass": mass}, "experiment": {"kind": "load", "force": load}}
    found = run(read_scene(tables)).results.displacement
    exact = case.pairs.deepest(load)
    assert abs(found.value - exact) <= found.uncertainty <= 1e-2 * abs(exact)
