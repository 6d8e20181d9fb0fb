"""How long a chain is that follows from its contact: what is felt, and what comes back from a free end."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tests.unit.test_estimate import RADIUS, REST, estimate, parabola, scene_of

from contact1d.workflow.model.chain import SettingsError, chain_length, decay_length, felt_up_to, reflected
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.scene import Scene, scene_from_dict
from tests.scenes import chains


def linear_chain(particles: int, stiffness: float, neighbours: float, pushed: int) -> Any:
    """Moves of a chain whose particle `pushed` bears a force of 1."""
    matrix = np.diag(np.full(particles, stiffness))
    for i in range(particles - 1):
        matrix[i : i + 2, i : i + 2] += neighbours * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return np.linalg.solve(matrix, np.eye(particles)[pushed])


@pytest.mark.parametrize("neighbours", [0.2, 5.0, 80.0])
def test_a_push_dies_away_over_the_decay_length(neighbours: float) -> None:
    scene = parabola(neighbours={"stiffness": neighbours})
    moves = linear_chain(401, 1.0, neighbours, 200)
    assert moves[203] / moves[202] == pytest.approx(math.exp(-1.0 / decay_length(scene)), rel=1e-6)
    assert decay_length(parabola()) == 0.0


def test_the_softest_direction_reaches_furthest() -> None:
    bodies = {"particles": 60, "bulk_stiffness": 1.0, "bulk_stiffness_tangential": 0.2}
    both = scene_of(RADIUS, neighbours={"stiffness": 5.0}, horizontal={}, bodies=bodies)
    along = linear_chain(401, 0.2, 5.0, 200)
    assert along[203] / along[202] == pytest.approx(math.exp(-1.0 / decay_length(both)), rel=1e-6)


def test_what_comes_back_from_a_free_end_is_what_is_said() -> None:
    neighbours, particles = 40.0, 60
    scene = parabola(neighbours={"stiffness": neighbours})
    found = settings_for(scene)
    edge = found.estimate.half_width(
        found.largest_displacement, float(found.estimate.gap[int(found.estimate.force.argmin())])
    )
    middle = particles // 2 + round(edge - 0.5)
    short, endless = (linear_chain(particles, 1.0, neighbours, middle)[middle], None)
    endless = linear_chain(801, 1.0, neighbours, 400)[400]
    beyond = particles / 2 - (middle + 0.5 - particles / 2)
    there = reflected(scene, found.estimate, found.largest_displacement, particles)
    other = math.exp(-2.0 * (particles - beyond) / decay_length(scene))
    assert short / endless - 1.0 - other == pytest.approx(there, rel=0.2)  # the edge is no particle
    assert reflected(parabola(), found.estimate, found.largest_displacement, particles) == 0.0


@pytest.mark.parametrize(
    ("largest", "share", "place"),
    [(10.0, 0.1, 5.0), (10.0, 0.6, 1.0), (-3.5, 0.2, 6.0), (-7.0, 0.5, 8.0), (-9.0, 0.5, 0.5)],
)
def test_a_contact_is_felt_up_to_the_last_gap_with_more_than_the_share(
    largest: float, share: float, place: float
) -> None:
    """Of the gaps beyond r₀ − d, here 0.5 − d; without a force in any of them it is r₀."""
    force = np.array([4.0, 3.0, 2.0, -2.0, -1.0, 0.5, 0.3, 0.1, 0.01, 0.0, 0.0])
    law: Any = SimpleNamespace(gap=np.arange(11.0), force=force, rest=0.5)
    assert felt_up_to(law, largest, share) == place


@pytest.mark.parametrize("share", [1e-2, 1e-4])
@pytest.mark.parametrize("neighbours", [None, 30.0])
def test_an_automatic_chain_ends_where_nothing_is_felt_and_nothing_comes_back(
    share: float, neighbours: float | None
) -> None:
    scene = parabola() if neighbours is None else parabola(neighbours={"stiffness": neighbours})
    found = estimate(0.5)
    largest = found.displacement_at(0.1)
    particles = chain_length(scene, found, largest, share)
    gap = REST + (0.5 * (particles - 1)) ** 2 / (2.0 * RADIUS) - largest
    there = abs(float(np.interp(gap, found.gap, found.force, right=0.0)))
    assert there <= share * float(np.abs(found.force[found.gap > REST - largest]).max())
    back = reflected(scene, found, largest, particles)
    assert back <= share
    nearer = (0.6 * particles / 2) ** 2 / (2.0 * RADIUS) + REST - largest
    felt = abs(float(np.interp(nearer, found.gap, found.force, right=0.0)))
    tight = felt > share * float(np.abs(found.force[found.gap > REST - largest]).max())
    assert tight or back > share**2  # and it is not much longer than that


CIRCLE = {"kind": "circle", "radius": 6.0}


def on_plane(displacement: float, particles: Any = "auto", spacing: float = 0.8, profile: Any = None) -> Scene:
    body = {"particles": particles, "spacing": spacing, "profile": profile or CIRCLE, "lower": "rigid_plane"}
    body |= {"reduction": "geike_popov"} if profile else {}
    path = {"kind": "path", "displacements": [displacement]}
    return scene_from_dict(chains(1.0, bodies=body, interaction=None, experiment=path))


@pytest.mark.parametrize(("particles", "widest"), [(3, 6.0), ("auto", 4.0)])
def test_a_spacing_is_as_wide_as_the_fewest_particles_have_room_for(particles: Any, widest: float) -> None:
    """Three particles are two spacings wide, four of an automatic chain three, and the circle 12 LU."""
    settings_for(on_plane(1e-3, particles, 0.999 * widest))
    with pytest.raises(SettingsError, match=f"take a bodies.spacing below {widest:.6g} LU"):
        settings_for(on_plane(1e-3, particles, 1.001 * widest))


@pytest.mark.parametrize(("particles", "last"), [("auto", 5.2), (6, 5.2), (14, 5.2), (15, 5.6)])
def test_a_contact_may_go_as_deep_as_the_outermost_place_for_a_particle(particles: Any, last: float) -> None:
    """On a circle of 6 LU an even chain's particles at 0.8 LU stand at 5.2 at most, an odd one's at 5.6; MDR's g(x)."""
    deepest = last * math.atanh(last / 6.0)
    settings_for(on_plane(0.999 * deepest, particles))
    for displacement in (1.001 * deepest, 20.0):
        with pytest.raises(SettingsError, match=f"spread over the whole .* at most {deepest:.4g} LU is possible"):
            settings_for(on_plane(displacement, particles))


@pytest.mark.parametrize("top", [2.5, 4.0])
def test_a_profile_that_falls_is_refused_with_the_place(top: float) -> None:
    table = {"kind": "table", "r": [0.0, 1.0, top, 6.0], "z": [0.0, 0.1, 1.0, 0.9]}
    with pytest.raises(SettingsError, match=r"falls beyond x = (\S+) LU") as caught:
        settings_for(on_plane(0.01, 15, profile=table))
    told = float(str(caught.value).partition("x = ")[2].split()[0])
    assert told == pytest.approx(highest(table), abs=0.01)  # some of 2001 places beyond a flat top
    rising = table | {"z": [0.0, 0.1, 1.0, 1.2]}
    settings_for(on_plane(0.01, 15, profile=rising))


def highest(table: dict[str, Any]) -> float:
    """The place of the top of a profile as its reduction has it."""
    body = on_plane(0.01, 15, profile=table).bodies
    x = np.linspace(0.0, 5.6, 200_001)
    return float(x[int(np.argmax(body.height(x)))])


@pytest.mark.parametrize("share", [1e-2, 1e-4])
@pytest.mark.parametrize("neighbours", [None, 30.0])
@pytest.mark.parametrize("largest", [-0.1, 0.02])
def test_an_automatic_chain_is_a_tenth_longer_than_what_is_felt_and_two_particles_on_each_side(
    share: float, neighbours: float | None, largest: float
) -> None:
    """And where a free end sends back that share of what its neighbours carry, exp(−2L/ℓ), that far from the edge."""
    spacing = 0.7
    springs = {} if neighbours is None else {"neighbours": {"stiffness": neighbours}}
    of = parabola(**springs)
    of = of.with_({"bodies.spacing": spacing, "bodies.particles": "auto"})
    found = estimate(0.5)
    deepest = max(largest, 0.0)
    strongest = float(np.abs(found.force[found.gap > REST - largest]).max())
    felt = [g for g, f in zip(found.gap.tolist(), np.abs(found.force).tolist(), strict=True)
            if f > share * strongest]  # fmt: skip
    half = 1.1 * math.sqrt(2.0 * RADIUS * (felt[-1] - REST + deepest))
    edge = math.sqrt(2.0 * RADIUS * (float(found.gap[int(np.argmin(found.force))]) - REST + deepest))
    if neighbours is not None:
        decay = spacing / math.acosh(1.0 + 0.5 / neighbours)
        half = max(half, edge + 0.5 * decay * math.log(1.0 / share))
    particles = chain_length(of, found, largest, share)
    assert particles % 2 == 0
    assert half + 2.0 * spacing <= 0.5 * particles * spacing * (1.0 + 1e-9) < half + 3.0 * spacing
    if neighbours is not None:
        back = math.exp(-2.0 * (0.5 * particles * spacing - edge) / decay)
        assert reflected(of, found, largest, particles) == pytest.approx(back, rel=1e-6)
        assert reflected(of, found, largest, 3) == 1.0  # a chain that is narrower than its contact
