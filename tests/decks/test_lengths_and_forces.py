"""Claim: lengths, forces and numbers of particles that a scene leaves open follow from its law, as its deck has them.

The law of a pair and its sum over a straight row are written out; their minima, roots and ranges are scipy's.
"""

import math
import re
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from contact1d import SettingsError, run
from contact1d.potentials import DoubleExponential, Exponential
from tests.decks.written import ANCHORS, FAR, LOWER, UPPER, Written, written
from tests.scenes import LAW, ROOT, chains, read_json

STUDIED = read_json(ROOT / "workflow/model/calibration.json")
SHARES = {name: entry["value"] for name, entry in STUDIED["values"].items()}
RADIUS, SPRING, SPACING, TOLERANCE = 100.0, 0.7, 0.8, 1e-3
LOAD = {"kind": "load", "force": 0.4}
REPULSION = {"repulsion": {"amplitude": LAW[0], "range": LAW[1]}}
ON_PLANE: dict[str, Any] = {"interaction": None, "bodies": {"lower": "rigid_plane"}}
TIMED: dict[str, Any] = {
    "damping": {"coefficient": 0.3},
    "plate": {"mass": 7.0},
    "experiment": LOAD | {"method": "dynamic"},
}
HEAT = TIMED | {"noise": {"temperature": 1e-3, "seed": 1}}
SLIDING = (1.0, 0.5, 0.5, 1.0)
"""The law of bodies that slide."""
EXACT, GRID, DIGITS, HOLDING = 1e-9, 2e-3, 5e-3, 5e-2
"""Relative: round-off; between 2000 distances; three digits of the table's header; between 400 heights."""


def path(*displacements: float) -> dict[str, Any]:
    return {"kind": "path", "displacements": [*displacements]}


def deck(**tables: Any) -> Written:
    bodies = {"spacing": SPACING} | tables.pop("bodies", {})
    return written(chains(RADIUS, SPRING, **{"experiment": LOAD} | tables, bodies=bodies))


def slide(distance: float = 9.0, **bodies: Any) -> dict[str, Any]:
    own = {"mass": 1.0, "upper_offset": 0.5, "spacing": SPACING} | bodies
    return chains(
        30.0, 2.0, law=SLIDING, horizontal={}, damping={"coefficient": "auto"}, plate={"free": ["x", "z"]},
        cantilever={"stiffness": 0.5, "velocity": 0.1}, bodies=own,
        experiment={"kind": "slide", "normal_force": 1.0, "distance": distance},
    )  # fmt: skip


def pair(r: Any, law: tuple[float, ...] = LAW) -> Any:
    return law[0] / law[1] * np.exp(-r / law[1]) - law[2] / law[3] * np.exp(-r / law[3])


FREE = float(brentq(pair, 0.01, 1.0))
TENSION = -float(minimize_scalar(pair, bounds=(FREE, 2.0), method="bounded").fun)


def test_what_is_left_of_forces_is_a_share_of_a_pairs_largest_tension_or_of_the_force_of_the_deepest_particle() -> None:
    for tables, scale in (
        ({}, TENSION),
        ({"interaction": REPULSION, "experiment": path(0.3)}, 0.5 * SPRING * 0.3),
        ({"interaction": REPULSION, "experiment": path(-0.1)}, 0.5 * SPRING * 1e-3 * SPACING),
    ):
        assert deck(**tables).number("force_tolerance") == pytest.approx(
            SHARES["residual"] * TOLERANCE * scale, rel=GRID
        )


@pytest.mark.parametrize("particles", [20, 21])
def test_bodies_begin_at_the_distance_without_force_and_without_attraction_at_the_cutoff(particles: int) -> None:
    """Particle i at (i − (N−1)/2) s, its height that of the profile, opposite bodies in two planes."""
    bodies = {"particles": particles}
    for interaction in ({}, {"interaction": REPULSION}):
        found = deck(bodies=bodies, **interaction)
        rest = FREE if not interaction else found.cutoff
        x = SPACING * (np.arange(particles) - 0.5 * (particles - 1))
        aside = found.claimed(", e = {} LU")
        assert found.atoms[UPPER] == pytest.approx(np.stack([x, 0.0 * x + aside, rest + x**2 / (2.0 * RADIUS)], 1))
        assert found.atoms[LOWER] == pytest.approx(np.stack([x, 0.0 * x, 0.0 * x], 1), abs=EXACT)
        assert np.array_equal(found.atoms[ANCHORS], found.atoms[UPPER])


@pytest.mark.parametrize(("tables", "closest"), [({}, 0.2 * FREE), ({"interaction": REPULSION}, 0.2 * LAW[1])])
def test_bodies_are_never_moved_further_than_particles_stand_in_order(tables: dict[str, Any], closest: float) -> None:
    """By a quarter of the smallest distance at most, towards each other, and in as few moves."""
    rows = deck(**tables, experiment=path(0.05, -1.0, 0.05)).numbers("row_displacement")
    moves = np.diff([0.0, *rows])
    assert moves.max() <= 0.25 * closest * (1.0 + 1e-6)
    assert (moves > 0.0).sum() == math.ceil(0.05 / (0.25 * closest)) + math.ceil(1.05 / (0.25 * closest))


@pytest.mark.parametrize("displacement", [0.0, 0.2])
def test_a_table_follows_the_law_from_where_the_coldest_and_the_hottest_particles_come(displacement: float) -> None:
    """0.8 of the innermost distance of a pair on its springs; with heat five deviations √(2kT/k) nearer, to `closest`.

    Neighbours 5 LU away are out of reach.
    """
    near = brentq(lambda r: r - 2.0 * pair(r) / SPRING - FREE + displacement, 0.01, 3.0)
    wide: dict[str, Any] = {"bodies": {"spacing": 5.0}, "experiment": path(displacement)}
    assert deck(**wide).claimed("for r >= {} LU") == pytest.approx(0.8 * near, rel=DIGITS)
    for temperature, least in ((1e-5, 0.0), (10.0, 0.2 * FREE)):
        warm = deck(**wide, damping={"coefficient": 0.3}, noise={"temperature": temperature, "seed": 1})
        motion = 5.0 * math.sqrt(2.0 * temperature / SPRING)
        assert warm.claimed("for r >= {} LU") == pytest.approx(max(least, 0.8 * (near - motion)), rel=DIGITS)


def test_a_table_goes_to_a_fifth_of_what_moves_are_chosen_for_and_is_as_good_and_as_long_as_asked() -> None:
    assert deck(experiment=path(30.0), accuracy={"tolerance": 1e-1}).claimed("for r >= {} LU") == pytest.approx(
        0.2 * 0.2 * FREE, rel=DIGITS
    )
    for tolerance in (1e-2, 1e-4):
        found = deck(accuracy={"tolerance": tolerance})
        assert found.claimed("force within {} FU") <= SHARES["table"] * tolerance * TENSION * (1.0 + DIGITS)
        assert math.exp(-(found.cutoff - FREE) / LAW[3]) == pytest.approx(SHARES["cutoff"] * tolerance, rel=1e-6)


def holding(height: float, spacing: float, law: tuple[float, ...]) -> float:
    """max |∂U/∂x| of Σ V(r) over a long row, at a height."""
    V = DoubleExponential(Exponential(*law[:2]), Exponential(*law[2:]))
    row, step = spacing * np.arange(-100.0, 101.0), 1e-5 * law[3]
    x = np.linspace(0.0, spacing, 257)[:, None] - row
    slopes = (V.energy(np.hypot(x + step, height)) - V.energy(np.hypot(x - step, height))).sum(axis=1)
    return float(np.abs(slopes).max()) / (2.0 * step)


@pytest.mark.parametrize("law", [SLIDING, (0.4, 0.2, 0.2, 0.4)])
def test_a_pair_at_the_cutoff_of_a_slide_bears_a_tenth_of_the_tolerance_of_what_a_row_holds(
    law: tuple[float, ...],
) -> None:
    """The row is at rest where particles stand between the opposite ones."""
    terms = [{"amplitude": law[i], "range": law[i + 1]} for i in (0, 2)]
    tables = slide() | {"interaction": dict(zip(("repulsion", "attraction"), terms, strict=True))}
    beside = SPACING * (np.arange(-100.0, 100.0) + 0.5)

    def upward(height: float) -> float:
        r = np.hypot(beside, height)
        return float((pair(r, law) * height / r).sum())

    held = 0.1 * holding(brentq(upward, 0.05, 3.0), SPACING, law)
    free = brentq(lambda r: pair(r, law), 0.01, 3.0)
    at_rest = SHARES["cutoff"] * law[2] / law[3] * math.exp(-free / law[3])
    assert (held < at_rest) == (law == SLIDING)  # the cutoff is the longer one of two
    cutoff = written(tables).cutoff
    wanted = TOLERANCE * min(held, at_rest)
    assert law[2] / law[3] * math.exp(-cutoff / law[3]) == pytest.approx(wanted, rel=HOLDING)


@pytest.mark.parametrize(
    ("tables", "force", "longest"),
    [(ON_PLANE, 3.0, math.inf), (ON_PLANE, 30.0, 0.1), ({"law": (0.18, 0.03, 0.09, 0.06)}, 0.4, 0.25 * 0.06)],
)
def test_a_search_moves_by_a_twelfth_of_its_way_at_most(tables: dict[str, Any], force: float, longest: float) -> None:
    """And by a tenth of the spacing on a plane, by a quarter of the range where pairs snap."""
    load = {"neighbours": {"stiffness": 0.2}, "experiment": {"kind": "load", "force": force}}
    done = run(chains(RADIUS, SPRING, **tables, **load))
    way = SHARES["loading_increment"] * done.results["displacement"].value
    assert np.diff(done.curve.displacement).max() == pytest.approx(min(longest, way), rel=0.02)


@pytest.mark.parametrize(("neighbours", "timed"), [(0.3, {}), (40.0, TIMED), (0.3, HEAT), (0.0, HEAT)])
def test_plane_and_bond_in_series_are_the_scenes_spring_and_neighbours_and_heat_see_it_but_for_the_tolerance(
    neighbours: float, timed: dict[str, Any]
) -> None:
    found = deck(**ON_PLANE, **timed, neighbours={"stiffness": neighbours} if neighbours else None)
    plane, bond = 2.0 * found.number("plane_half_stiffness"), 2.0 * found.number("bulk_bond_coefficient")
    assert 1.0 / (1.0 / plane + 1.0 / bond) == pytest.approx(SPRING, rel=EXACT)
    assert (SPRING + 4.0 * neighbours) / plane == pytest.approx(TOLERANCE, rel=EXACT)
    assert found.numbers("plane_stiffness") == [pytest.approx(plane)]


@pytest.mark.parametrize("along", [0.4, 1.1])
def test_a_long_bond_is_as_long_as_its_bend_allows_and_only_where_two_stiffnesses_differ(along: float) -> None:
    """A move of a spacing across it bends its force by s/2L, a twentieth of the tolerance."""
    both = {"horizontal": {}, "bodies": {"bulk_stiffness_tangential": along}}
    for tolerance in (1e-2, 1e-4):
        found = deck(**both, accuracy={"tolerance": tolerance})
        length = found.number("far_length")
        assert 0.5 * SPACING / length == pytest.approx(0.05 * tolerance, rel=EXACT)
        away = found.atoms[FAR] - found.atoms[UPPER]
        assert np.abs(away).max(axis=0) == pytest.approx(
            [length, 0, 0] if along > SPRING else [0, 0, length], abs=EXACT
        )
        assert 2.0 * found.number("bulk_bond_coefficient") == min(along, SPRING)
        assert found.masses[FAR] < EXACT * found.masses[ANCHORS]  # it weighs nothing in the plate
        assert 2.0 * found.number("far_bond_coefficient") == pytest.approx(abs(along - SPRING))
    for tables in ({"bodies": both["bodies"]}, {"horizontal": {}, "bodies": {"bulk_stiffness_tangential": SPRING}}):
        assert FAR not in deck(**tables).atoms


def test_a_slide_that_leaves_its_lower_chain_is_refused_by_where_the_run_has_forces_left() -> None:
    """Beyond the half-width that it names no force exceeds the tolerance times the largest one, before it some do."""
    tables = slide(80.0, particles=200, upper_particles=100) | {"accuracy": {"tolerance": 1e-2}}
    with pytest.raises(SettingsError, match="too short for the sliding distance") as caught:
        written(tables)
    half, moved = (float(word) for word in re.findall(r"half-width (\S+) LU moves (\S+) LU", str(caught.value))[0])
    assert moved == 80.5
    timeless = {"experiment": {"kind": "load", "force": 1.0}, "accuracy": {"tolerance": 1e-2}}
    profile = run(chains(30.0, 2.0, law=SLIDING, bodies={"spacing": SPACING}, **timeless)).profiles["final"]
    felt = np.abs(profile.x[np.abs(profile.pressure) > 1e-2 * np.abs(profile.pressure).max()])
    assert felt.max() < half < felt.max() + 2.0 * SPACING


@pytest.mark.parametrize(
    ("distance", "offset", "spacing"), [(4.0, 0.0, 0.8), (9.0, -6.0, 0.8), (9.0, 0.5, 0.5), (9.0, 0.5, 1.3)]
)
def test_an_automatic_lower_chain_is_as_long_as_the_upper_one_and_the_way_and_no_longer(
    distance: float, offset: float, spacing: float
) -> None:
    atoms = written(slide(distance, upper_offset=offset, upper_spacing=spacing)).atoms
    length = len(atoms[UPPER]) * spacing + 2.0 * (distance + abs(offset))
    more = 2.0 if spacing == SPACING else 4.0  # of both ends
    assert length * (1.0 - EXACT) <= len(atoms[LOWER]) * SPACING < length + more * SPACING
    assert atoms[UPPER][:, 0].mean() == pytest.approx(offset, abs=EXACT)


def test_a_body_may_be_as_wide_as_its_own_spacing_lets_it() -> None:
    atoms = deck(bodies={"profile": {"kind": "circle", "radius": 30.0}, "particles": 100, "upper_spacing": 0.5}).atoms
    assert np.ptp(atoms[UPPER][:, 0]) == pytest.approx(99 * 0.5)


@pytest.mark.parametrize(("own", "particles"), [(None, 30), (None, 31), (0.5, 30), (1.3, 20)])
def test_a_slide_begins_with_the_first_particle_half_way_between_two_opposite_ones(
    own: float | None, particles: int
) -> None:
    atoms = written(slide(upper_offset=None, upper_spacing=own, particles=60, upper_particles=particles)).atoms
    phase = (atoms[UPPER][:, 0].min() - atoms[LOWER][0, 0]) / SPACING
    assert phase % 1.0 == pytest.approx(0.5)


@pytest.mark.parametrize("displacement", [-0.5, 0.3])
def test_an_automatic_chain_of_bodies_that_only_repel_ends_a_tenth_and_two_particles_beyond_what_is_felt(
    displacement: float,
) -> None:
    felt = max(math.sqrt(2.0 * RADIUS * max(0.0, displacement)), SPACING)
    atoms = deck(interaction=REPULSION, experiment=path(displacement)).atoms
    half = 0.5 * len(atoms[UPPER]) * SPACING
    assert 1.1 * felt + 2.0 * SPACING <= half * (1.0 + 1e-6) < 1.1 * felt + 3.0 * SPACING


def test_an_automatic_chain_with_neighbours_is_longer_by_what_its_end_would_reflect() -> None:
    """exp(−2L/ℓ) is the share of forces at its end, cosh(s/ℓ) = 1 + k/2k_n."""
    halves, decays = [], []
    for neighbours in (100.0, 300.0):
        halves.append(0.5 * len(deck(neighbours={"stiffness": neighbours}).atoms[UPPER]) * SPACING)
        decays.append(SPACING / math.acosh(1.0 + 0.5 * SPRING / neighbours))
    wanted = -0.5 * math.log(SHARES["chain"] * TOLERANCE) * (decays[1] - decays[0])
    assert halves[1] - halves[0] == pytest.approx(wanted, abs=SPACING)


@pytest.mark.parametrize(
    ("profile", "spacing", "particles"), [("circle", 0.5, 8), ("circle", 0.1, 42), ("flat_punch", 0.35, 12)]
)
def test_an_automatic_chain_is_no_longer_than_its_body(profile: str, spacing: float, particles: int) -> None:
    """Of a circle of 2.1 LU the outermost particles are on it, and one more on each side would not be."""
    body = {"spacing": spacing, "profile": {"kind": profile, "radius": 2.1}}
    atoms = written(chains(1.0, law=SLIDING, bodies=body, experiment=path(0.3))).atoms
    assert len(atoms[UPPER]) == particles


@pytest.mark.parametrize("share", [0.5, 0.7])
def test_where_pairs_snap_a_plate_is_drawn_away_alone(share: float) -> None:
    """f′ of the attraction exceeds the two springs of a pair in series, k/2."""
    law = (0.18 * share, 0.03, 0.09 * share, 0.06)
    r = np.linspace(0.01, 1.0, 10_000)
    softest = float(np.gradient(pair(r, law), r).max())
    found = written(chains(10.0, law=law, bodies={"particles": 12}, experiment=path(0.05)))
    assert ("displace_atoms plate move" in found.commands) == (softest > 0.5 * 0.83)


def test_bodies_carry_any_load_below_the_one_that_is_named() -> None:
    def load(force: float, **bodies: Any) -> Written:
        body = bodies or {"profile": {"kind": "flat_punch", "radius": 4.0}}
        return deck(bodies=body, experiment={"kind": "load", "force": force}, accuracy={"tolerance": 1e-1})

    with pytest.raises(SettingsError, match="can carry, about") as caught:
        load(1e9)
    most = float(re.findall(r"about (\S+) FU", str(caught.value))[0])
    load(0.999 * most)
    with pytest.raises(SettingsError, match="can carry"):
        load(1.001 * most)
    assert most == pytest.approx(10 * pair(0.0), rel=0.15)
    with pytest.raises(SettingsError, match=f"can carry, about {7 * LAW[0] / LAW[1]:.4g} FU"):
        load(10.0, particles=7)
