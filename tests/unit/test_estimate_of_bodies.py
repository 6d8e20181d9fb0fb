"""Claims of the estimate of any body: what it carries at most, and whether a cone jumps, against closed forms."""

from __future__ import annotations

import math
from typing import Any

import pytest

from contact1d import read_scene
from contact1d.potentials import DoubleExponential, Exponential
from contact1d.workflow.laws import Maugis, law_of
from contact1d.workflow.laws.law import NotCarriedError
from contact1d.workflow.laws.pairs import of_pairs
from contact1d.workflow.laws.shape import Profile
from tests.scenes import LAW, chains

SHAPES: dict[str, dict[str, Any]] = {
    "cone": {"kind": "cone", "slope": 0.2},
    "circle": {"kind": "circle", "radius": 6.0},
    "punch": {"kind": "flat_punch", "radius": 6.0},
}
PAIR = DoubleExponential(Exponential(LAW[0], LAW[1]), Exponential(LAW[2], LAW[3]))
CUTOFF, REST, ROW = 4.0, PAIR.force_free_distance(), 0.8


def body(shape: str) -> Profile:
    load = {"kind": "load", "force": 0.1}
    return read_scene(chains(1.0, bodies={"profile": SHAPES[shape], "spacing": ROW}, experiment=load)).bodies


@pytest.mark.parametrize("stiffness", [0.01, 0.5, 100.0])
@pytest.mark.parametrize("shape", ["circle", "punch"])
def test_a_body_carries_no_more_than_all_its_particles_on_the_opposite_ones(shape: str, stiffness: float) -> None:
    found = of_pairs(PAIR, body(shape), ROW, stiffness, CUTOFF, REST, 4000)
    with pytest.raises(NotCarriedError) as caught:
        found.displacement_at(1e9)
    assert caught.value.most == pytest.approx(12.0 / ROW * float(found.force[0]), rel=1e-9)


@pytest.mark.parametrize(("work", "reach", "jumps"), [(1e-3, 1.0, False), (2e-2, 0.1, True)])
def test_a_cone_lets_go_of_a_weak_attraction_without_a_jump(work: float, reach: float, jumps: bool) -> None:
    """Before contact d = f(c) − (4σ₀/πE*) c − h₀: it rises from c = 0 on where the slope is more than 4σ₀/πE*."""
    bodies = {"profile": SHAPES["cone"], "spacing": 0.2, "bulk_stiffness": 0.2, "lower": "rigid_plane"}
    adhesion = {"work_of_adhesion": work, "range": reach}
    pull = {"kind": "pull_off", "preload": 0.2}
    scene = read_scene(chains(1.0, bodies=bodies, adhesion=adhesion, interaction=None, experiment=pull))
    estimate = law_of(scene).of(scene, scene.bodies)
    assert isinstance(estimate, Maugis)
    assert (4.0 * work / reach / math.pi > 0.2) == jumps
    assert len(estimate.limits) == jumps
    first = float(estimate.held.displacement[0])
    assert first == pytest.approx(estimate.limits[0]) if jumps else first == -reach
    assert (float(estimate.held.force[0]) < -1e-3) == jumps
    early = estimate.curve.edge == 0.0
    c, stress = estimate.curve.reach[early], work / reach
    assert estimate.curve.force[early] == pytest.approx(-math.pi * stress * c**2, rel=1e-12)
    assert estimate.curve.displacement[early] == pytest.approx(0.2 * c - 4.0 * stress / math.pi * c - reach, rel=1e-12)
