"""Claim: an automatic chain is long enough for stiff neighbour springs, and a given one that is not is warned of.

Reference: `validation.references.solver`, Newton's method for a chain of twice the length.
"""

from pathlib import Path
from typing import Any

import pytest
from scipy.optimize import brentq

from contact1d import run, write_deck
from tests.scenes import chains
from validation.references.interaction import PairInteraction
from validation.references.model import ChainModel
from validation.references.solver import ChainSolver

TOLERANCE, FORCE = 1e-2, 0.5
ASKED = chains(200.0, accuracy={"tolerance": TOLERANCE}, experiment={"kind": "load", "force": FORCE})


def scene(neighbours: float, particles: int | str = "auto") -> dict[str, Any]:
    return ASKED | {"neighbours": {"stiffness": neighbours}, "bodies": ASKED["bodies"] | {"particles": particles}}


@pytest.mark.parametrize("ratio", [0.3, 1000.0])
def test_an_automatic_chain_is_long_enough(ratio: float) -> None:
    done = run(scene(0.83 * ratio))
    law = PairInteraction.of(0.18, 0.13, 0.09, 0.26)
    longer = 2 * len(done.profiles["final"].x)
    solver = ChainSolver(ChainModel(longer, 0.83, law, radius=200.0, neighbour_stiffness=0.83 * ratio))
    found = done.results.displacement
    near = (found.value - 0.02, found.value + 0.02)
    start = solver.equilibrium(near[0])
    exact = brentq(lambda d: solver.equilibrium(float(d), start).force - FORCE, *near, xtol=1e-7)
    assert abs(found.value - exact) < TOLERANCE * exact
    assert "chain_end" not in done.warnings


def test_a_given_chain_that_ends_too_soon_is_warned_of() -> None:
    warnings = run(scene(830.0, 60)).warnings
    assert "spread the load over 31.6 LU" in warnings["chain_end"]


def test_soft_neighbours_make_no_chain_longer(tmp_path: Path) -> None:
    alone, soft = (write_deck(tables, tmp_path / name) for name, tables in (("alone", ASKED), ("soft", scene(0.3))))
    atoms = [(folder / "system.data").read_text().partition(" atoms")[0].split()[-1] for folder in (alone, soft)]
    assert atoms[0] == atoms[1]
