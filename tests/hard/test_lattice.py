"""Claim: where `particles = "auto"` chose the lattice, what another lattice of the same body gives is within the claim.

The other chains have one particle more or less, so that a particle stands at the contact's centre and not two beside
it. Where the scene gives the number of particles, these are what was asked for and nothing is added.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from contact1d import Run, Scene, read_scene, run
from contact1d.workflow.continuation.outcome import Outcome

TOLERANCE = 1e-4
PLANE: dict[str, Any] = {
    "title": "plane",
    "bodies": {
        "particles": "auto", "spacing": 1.0, "profile": {"kind": "circle", "radius": 40.0},
        "bulk_stiffness": 0.5, "lower": "rigid_plane",
    },
    "accuracy": {"tolerance": TOLERANCE},
}  # fmt: skip
PAIRS: dict[str, Any] = {
    "title": "pairs",
    "bodies": {
        "particles": "auto", "spacing": 1.0, "profile": {"kind": "parabola", "radius": 10.0}, "bulk_stiffness": 1.5,
    },
    "interaction": {
        "repulsion": {"amplitude": 0.011, "range": 0.05}, "attraction": {"amplitude": 0.01, "range": 0.1},
    },
    "accuracy": {"tolerance": TOLERANCE},
}  # fmt: skip
SCENES: dict[str, tuple[dict[str, Any], set[str]]] = {
    "circle on a plane under a force": (
        PLANE | {"experiment": {"kind": "load", "force": 0.5}}, {"displacement", "contact_radius", "mean_pressure"},
    ),
    "circle on a plane, pressed in": (
        PLANE | {"experiment": {"kind": "path", "displacements": {"from": 0.0, "to": 0.2, "steps": 4}}},
        {"largest_force"},
    ),
    "pairs under a force": (PAIRS | {"experiment": {"kind": "load", "force": 0.1}}, {"displacement"}),
    "pairs pulled off": (PAIRS | {"experiment": {"kind": "pull_off", "preload": 0.1}}, {"adhesion_force"}),
    "pairs, there and back": (
        PAIRS
        | {"experiment": {"kind": "path", "displacements": {"from": 0.02, "to": -0.2, "steps": 11}}},
        {"adhesion_force"},
    ),
}  # fmt: skip


def done(tables: dict[str, Any], folder: Path, more: int | None = None) -> tuple[Scene, Run]:
    """The scene, with a given number of particles if `more` is one: that of the automatic chain and so many more."""
    scene = read_scene(tables)
    found = run(scene, folder / "auto", figures=False)
    if more is None:
        return scene, found
    count = len(found.outcome.states[0].profile.x) + more
    scene = read_scene(tables | {"bodies": tables["bodies"] | {"particles": count}})
    return scene, run(scene, folder / "given", figures=False)


def lattice_error(outcome: Outcome, name: str) -> float:
    """Discretisation error of a result."""
    return outcome.results[name].errors.get("discretisation", 0.0)


@pytest.mark.parametrize("name", SCENES)
def test_the_other_parity_is_within_the_uncertainty(tmp_path: Path, name: str) -> None:
    tables, differ = SCENES[name]
    runs = [done(tables, tmp_path, more)[1] for more in (None, 1)]
    even, odd = (found.outcome for found in runs)
    assert all(lattice_error(even, quantity) > 0.0 for quantity in differ)
    for quantity in set(even.quantities) & set(odd.quantities):
        ours, other = even.quantities[quantity], odd.quantities[quantity]
        assert abs(ours.value - other.value) <= ours.uncertainty + other.uncertainty, quantity
    for quantity in differ:
        ours, other = even.quantities[quantity], odd.quantities[quantity]
        assert abs(ours.value - other.value) > TOLERANCE * abs(ours.value), "the scene is too blunt to show anything"
    assert "lattice" in runs[0].warnings
    assert even.refinement is None or even.refinement.count == 0


def test_given_particles_are_the_body_that_was_asked_for(tmp_path: Path) -> None:
    tables, _ = SCENES["circle on a plane under a force"]
    given = done(tables, tmp_path, 0)[1]
    assert not lattice_error(given.outcome, "displacement")
    assert "lattice" not in given.warnings
    assert given.results.displacement.uncertainty < TOLERANCE * given.results.displacement.value


def test_a_blunt_contact_is_left_as_certain_as_it_was(tmp_path: Path) -> None:
    blunt = PAIRS | {
        "bodies": PAIRS["bodies"] | {"profile": {"kind": "parabola", "radius": 1000.0}},
        "experiment": {"kind": "load", "force": 1.0},
    }
    found = done(blunt, tmp_path)[1].outcome
    assert lattice_error(found, "displacement") < 0.01 * TOLERANCE * abs(found.quantities["displacement"].value)
    assert "lattice" not in found.warnings
