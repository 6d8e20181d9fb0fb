"""What a deck has not: a lower body on the plane, a minimiser where nothing relaxes, time at rest; one of each else."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.experiments import planned
from contact1d.workflow.model.settings import settings_for
from tests.decks.test_effect_off import ALL, LOAD, PLANE, TIMED, MakeScene, commands, text_of


@pytest.mark.parametrize("timed", [False, True])
def test_on_a_rigid_plane_no_pair_style_and_no_lower_body(make_scene: MakeScene, tmp_path: Path, timed: bool) -> None:
    more = TIMED | {"experiment": LOAD} if timed else {}
    scene = make_scene(**PLANE, **more)
    text = commands(text_of(scene))
    for word in ("pair_style", "pair_coeff", "neighbor ", "binsize", "lower", "tally", "table", "bond_style"):
        assert word not in text
    assert len(re.findall(r"fix +rigid_plane_wall upper wall/harmonic ", text)) == 1
    write_system(Deck(scene, settings_for(scene)), tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["system.data"]
    rows = (tmp_path / "system.data").read_text().split("Atoms # atomic\n\n")[1].split("\n\n")[0].splitlines()
    assert Counter(row.split()[1] for row in rows) == {"2": 20}


RELAXING = PLANE | {"neighbours": {"stiffness": 0.3}}
"""On a rigid plane particles find their own places only where neighbours pull them."""


@pytest.mark.parametrize("tables", [PLANE, PLANE | {"experiment": LOAD}])
def test_where_nothing_has_to_come_to_rest_nothing_is_minimised(make_scene: MakeScene, tables: dict[str, Any]) -> None:
    """One run for a phase, one step for a row; no bonds, no anchors."""
    scene = make_scene(**tables)
    text = commands(text_of(scene))
    for word in ("minimi", "min_style", "bond_style", "anchors", "jump ", "displace_atoms"):
        assert word not in text
    phases = planned(scene, settings_for(scene))
    assert re.findall(r"^run +(.*)$", text, re.MULTILINE) == [
        "0 post no",
        *["${row_count} pre no post no"] * len(phases),
    ]
    counts = re.findall(r"^variable +row_count index (\d+)$", text, re.MULTILINE)
    assert [int(count) for count in counts] == [len(phase.rows) for phase in phases]


@pytest.mark.parametrize("tables", [{}, RELAXING, {"experiment": LOAD}])
def test_a_quasistatic_deck_has_no_time_in_it(make_scene: MakeScene, tables: dict[str, Any]) -> None:
    text = commands(text_of(make_scene(**tables)))
    for word in (" nve", "viscous", "langevin", "velocity", " rigid "):  # its timestep is that of FIRE, a minimiser
        assert word not in text
    assert re.findall(r"^run +(.*)$", text, re.MULTILINE) == ["0 post no"] * text.count("\nrun ")
    assert "minimize " in text


def test_a_dynamic_deck_minimises_nothing(make_scene: MakeScene) -> None:
    for tables in ({"damping": {"coefficient": 0.3}}, TIMED | {"experiment": LOAD}, ALL):
        text = commands(text_of(make_scene(**tables)))
        assert "minimize" not in text
        assert "min_style" not in text
        assert len(re.findall(r"^timestep ", text, re.MULTILINE)) == 1
