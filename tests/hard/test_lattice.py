"""Claim: where `particles = "auto"` chose the lattice, what another lattice of the same body gives is within the claim.

The other chain has one particle more, so that a particle stands at the contact's centre and not two beside it. Where
the scene gives the number of particles, these are what was asked for and nothing is added.
"""

from typing import Any

import pytest

from contact1d import read_scene, run
from tests.scenes import chains

TOLERANCE = {"tolerance": 1e-4}
CIRCLE = chains(
    1.0, 0.5, interaction=None, accuracy=TOLERANCE, experiment={"kind": "load", "force": 0.5},
    bodies={"lower": "rigid_plane", "profile": {"kind": "circle", "radius": 40.0}},
)  # fmt: skip
PAIRS = chains(10.0, 1.5, law=(0.011, 0.05, 0.01, 0.1), accuracy=TOLERANCE)
SCENES: dict[str, tuple[dict[str, Any], set[str]]] = {
    "on a plane under a force": (CIRCLE, {"displacement", "contact_radius", "mean_pressure"}),
    "pairs under a force": (PAIRS | {"experiment": {"kind": "load", "force": 0.1}}, {"displacement"}),
}


@pytest.mark.parametrize("name", SCENES)
def test_the_other_parity_is_within_the_uncertainty(name: str) -> None:
    tables, differ = SCENES[name]
    scene = read_scene(tables)
    auto = run(scene)
    count = len(next(iter(auto.profiles.values())).x)
    other = run(scene.with_({"bodies.particles": count + 1}))
    for quantity in auto.results.keys() & other.results.keys():
        ours, theirs = auto.results[quantity], other.results[quantity]
        assert abs(ours.value - theirs.value) <= ours.uncertainty + theirs.uncertainty, quantity
        # Else the scene is too blunt to show anything.
        assert quantity not in differ or abs(ours.value - theirs.value) > TOLERANCE["tolerance"] * abs(ours.value)
    assert "lattice" in auto.warnings
    assert auto.document["accuracy"]["refinements"] == 0
    if name == "on a plane under a force":
        given = run(scene.with_({"bodies.particles": count}))
        assert "lattice" not in given.warnings
        assert given.results.displacement.uncertainty < TOLERANCE["tolerance"] * given.results.displacement.value


def test_a_blunt_contact_is_left_as_certain_as_it_was() -> None:
    blunt = PAIRS | {"bodies": PAIRS["bodies"] | {"profile": {"kind": "parabola", "radius": 1000.0}}}
    found = run(blunt | {"experiment": {"kind": "load", "force": 1.0}})
    assert found.results.displacement.uncertainty < TOLERANCE["tolerance"] * abs(found.results.displacement.value)
    assert "lattice" not in found.warnings
