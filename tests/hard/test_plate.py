"""Plates that are hard for `fix rigid` and for the search: of three particles, nearly a line, with momentum."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from contact1d import RunError, Scene, read_scene, run
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.engine.session import Session
from contact1d.workflow.experiments import planned
from contact1d.workflow.model.settings import settings_for
from tests.scenes import chains
from validation.hard.cases import TENSION, PairCase, reach, shaped
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel
from validation.references.pull_off import pull_off

MakeScene = Callable[..., Scene]
OpenDeck = Callable[[Scene], tuple[Deck, Session]]
TIMED: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}}
LOAD = {"kind": "load", "force": 0.1}


@pytest.mark.parametrize("height", [0.05, 5.0])
@pytest.mark.parametrize("particles", [3, 200, 20_000])
def test_a_plate_of_any_length_is_accepted(
    make_scene: MakeScene, open_deck: OpenDeck, particles: int, height: float
) -> None:
    """LAMMPS says "Bad principal moments" where a body is too nearly a line: many particles on a low profile."""
    radius = (0.5 * particles) ** 2 / (2.0 * height)
    bodies = {"particles": particles, "profile": {"kind": "parabola", "radius": radius}}
    _, session = open_deck(make_scene(bodies=bodies, experiment=LOAD, **TIMED))
    session.execute("run 2\n")
    assert session.value("v_plate_velocity") == pytest.approx(0.0, abs=1e-3)


def test_a_long_chain_has_few_bins(make_scene: MakeScene) -> None:
    """LAMMPS bins the whole box, and the plate's anchors widen it with the chain's length."""
    scene = make_scene(experiment=LOAD, **TIMED)
    short = settings_for(scene)
    long = replace(short, chains=replace(short.chains, upper=10**6, lower=10**6))
    texts = [Deck(scene, settings).text(planned(scene, short)) for settings in (short, long)]
    assert "binsize" not in texts[0]
    found = re.search(r"variable\s+wide_bin index (\S+)", texts[1])
    assert found is not None
    assert float(found[1]) == pytest.approx(10.0)


@pytest.mark.parametrize("plate", [{"mass": 20.0, "damping": 0.3}, {"mass": 500.0, "damping": 2.0}])
def test_a_plate_with_momentum_does_not_break_the_contact_too_early(tmp_path: Path, plate: dict[str, float]) -> None:
    """A weakly damped plate shoots past its place: the stated bracket still holds the pull-off force."""
    attraction, repulsion = (0.2, 0.5), (0.4, 0.25)
    tables = chains(
        50.0,
        law=(*repulsion, *attraction),
        damping={"coefficient": 0.02},
        plate=plate,
        accuracy={"tolerance": 1e-2},
        experiment={"kind": "pull_off", "method": "dynamic", "preload": 0.5},
    )
    finished = run(read_scene(tables), tmp_path / "run", figures=False)
    law = PairInteraction(Exponential(*repulsion), Exponential(*attraction))
    model = ChainModel(finished.outcome.states[0].profile.x.size, 0.83, law, radius=50.0)
    exact = pull_off(model, 0.5, step=0.06).adhesion_force
    found = finished.outcome.quantities["adhesion_force"]
    assert abs(found.value - exact) <= found.uncertainty
    assert found.uncertainty <= 2e-2 * exact


def test_a_plate_that_swings_past_a_tooth_has_no_pull_off_force(tmp_path: Path) -> None:
    """With little drag it loses pairs that it would have held: F_A is uncertain by more than half, and not reported."""
    case = PairCase("tooth", 1.5, shaped("parabola", 9, reach(1.5)), 9, 3.0 * TENSION, 1e-2, dynamic=True)
    tables = {"title": "tooth"} | case.scene()
    drag = 0.1 * settings_for(read_scene(tables)).motion.damping
    tables |= {"damping": {"coefficient": drag}, "plate": {"damping": 0.0}}
    with pytest.raises(RunError, match=r"not reported.*adhesion_force \(± 0\.05"):
        run(read_scene(tables), tmp_path / "run", figures=False)


@pytest.mark.parametrize("mass", [1e-3, 0.1, 1e3])
def test_a_light_plate_and_a_heavy_one_come_to_rest_where_pairs_say(mass: float, tmp_path: Path) -> None:
    """A light one swings against its particles, whose drag does not stop it; under a heavy one particles lag behind."""
    case = PairCase("mass", 0.3, shaped("flat_punch", 10, 0.0), 10, 0.0, 1e-3, dynamic=True)
    load = 5.0 * TENSION
    tables = case.scene() | {"title": "mass", "plate": {"mass": mass}, "experiment": {"kind": "load", "force": load}}
    found = run(read_scene(tables), tmp_path / "run", figures=False).results.displacement
    exact = case.exact().deepest(load)
    assert abs(found.value - exact) <= found.uncertainty
    assert found.uncertainty <= 1e-2 * abs(exact)
