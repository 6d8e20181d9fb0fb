"""Claims of the estimate of any body: widths are roots, marks those of a dense scan, folds those of its own grid.

References: scipy's root of the body's height, scans of thousands of displacements, plain loops over a grid.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d import read_scene
from contact1d.potentials import DoubleExponential, Exponential
from contact1d.workflow.laws import Law, Maugis, law_of
from contact1d.workflow.laws.law import NotCarriedError
from contact1d.workflow.laws.pairs import of_pairs, row_force
from contact1d.workflow.laws.shape import Profile
from tests.scenes import LAW, chains

Array = NDArray[np.float64]
WIDTH = 1e-13
"""Relative: a bracket that is cut to the last digits."""
SCAN = 1e-4
"""Relative, of a flat top between places of a scan."""
SLOPE = 0.04
"""Relative: a difference on one side, of a sum of straight lines."""
OFFSET = 2e-8
"""Relative: what makes a grid rise where a pair snaps, 1e-12 of the cutoff for each of its places."""
SHAPES: dict[str, dict[str, Any]] = {
    "parabola": {"kind": "parabola", "radius": 30.0},
    "cone": {"kind": "cone", "slope": 0.2},
    "power": {"kind": "power", "exponent": 3.0, "radius": 5.0, "height": 2.0},
    "circle": {"kind": "circle", "radius": 6.0},
    "punch": {"kind": "flat_punch", "radius": 6.0},
}
PAIR = DoubleExponential(Exponential(LAW[0], LAW[1]), Exponential(LAW[2], LAW[3]))
CUTOFF, REST, ROW = 4.0, PAIR.force_free_distance(), 0.8


def body(shape: str) -> Profile:
    load = {"kind": "load", "force": 0.1}
    return read_scene(chains(1.0, bodies={"profile": SHAPES[shape], "spacing": ROW}, experiment=load)).bodies


def pairs(shape: str, stiffness: float = 0.7, points: int = 4000) -> Law:
    return of_pairs(PAIR, body(shape), ROW, stiffness, CUTOFF, REST, points)


@pytest.mark.parametrize(("shape", "stiffness"), [("parabola", 0.4), ("cone", 5.0), ("circle", 0.7), ("punch", 0.7)])
def test_marks_are_those_of_a_dense_scan(shape: str, stiffness: float) -> None:
    found = pairs(shape, stiffness)
    felt = REST - float(found.gap[-1])
    places = np.linspace(felt, 1.5, 1_501)
    forces = np.concatenate([found.contact_forces(some) for some in np.array_split(places, 4)])
    top = int(np.argmin(forces))
    assert found.pull_off_force() == pytest.approx(-forces[top], rel=SCAN)
    for force in (0.0, 0.1, 0.6):
        after = top + int(np.flatnonzero(forces[top:] < force)[-1])
        place = np.interp(force, forces[after : after + 2], places[after : after + 2])
        assert found.displacement_at(force) == pytest.approx(place, abs=0.1 * (places[1] - places[0]))
        assert found.contact_force(found.displacement_at(force)) == pytest.approx(force, abs=SCAN)
        slope = np.gradient(forces, places)[after]
        assert found.stiffness_under(force) == pytest.approx(slope, rel=SLOPE)
    for share in (0.1, 0.5, 0.9):
        before = int(np.flatnonzero(forces[:top] > share * forces[top])[-1])
        assert found.parted(share) == pytest.approx(places[before], abs=(found.displacement_at(0.0) - felt) / 300.0)
    assert found.parted(0.0) == felt
    edge = found.half_width(0.1, float(found.gap[int(np.argmin(found.force))]))
    together = max(1.0, 2.0 * edge / ROW) * found.stiffness
    assert found.stuck_stiffness(0.1) == pytest.approx(together, rel=0.1 if found.snaps else WIDTH)


@pytest.mark.parametrize("stiffness", [0.03, 0.1])
def test_a_pair_snaps_over_the_fall_of_its_own_grid(stiffness: float) -> None:
    """Undeformed gaps G(r) = r − 2 f(r)/k, one after the other: the first that is not exceeded next, and the return."""
    points = 400
    found = pairs("parabola", stiffness, points)
    r = [CUTOFF * (i + 1) / points for i in range(points)]
    force = [float(f) for f in row_force(PAIR, np.array(r), ROW, CUTOFF)]
    undeformed = [place - 2.0 * f / stiffness for place, f in zip(r, force, strict=True)]
    off = next(i for i in range(points - 1) if undeformed[i + 1] < undeformed[i])
    # Behind the fold the gap comes back to where it was.
    on = next(i for i in range(off + 1, points) if undeformed[i] > undeformed[off]) - 1
    assert found.snaps
    assert found.snap == (pytest.approx(undeformed[off], rel=OFFSET), pytest.approx(force[on] - force[off]))
    second = abs(undeformed[off + 1] - 2.0 * undeformed[off] + undeformed[off - 1]) / (r[1] - r[0]) ** 2
    assert found.bend == pytest.approx(second, rel=1e-6)
    assert found.gap[: off + 1] == pytest.approx(undeformed[: off + 1], abs=OFFSET)
    assert found.gap[on + 1 :] == pytest.approx(undeformed[on + 1 :], abs=OFFSET)
    assert found.stiffness == 0.5 * stiffness


@pytest.mark.parametrize("stiffness", [0.01, 0.5, 100.0])
@pytest.mark.parametrize("shape", ["circle", "punch"])
def test_a_body_carries_no_more_than_all_its_particles_on_the_opposite_ones(shape: str, stiffness: float) -> None:
    found = pairs(shape, stiffness)
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
