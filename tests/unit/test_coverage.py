"""Claim: what a run says of its uncertainty covers its error, over many contacts whose curve is known exactly.

Reference: independent pairs (`tests.exact`), each solved for itself; no LAMMPS, so that many contacts take seconds.
The share that is covered is counted. Uncertainties three times smaller would fail each of these tests: they cover 60 to
90 % of the same cases.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.reference.interaction import Exponential, PairInteraction
from contact1d.analysis.reference.pair_lattice import PairLattice
from contact1d.workflow.experiments.load.dynamic import load_dynamic
from contact1d.workflow.experiments.load.quasistatic import load_quasistatic
from contact1d.workflow.experiments.path.path import path
from contact1d.workflow.experiments.pull_off.dynamic import pull_off_dynamic
from contact1d.workflow.experiments.pull_off.quasistatic import pull_off_quasistatic
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.trust import UntrustedError
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import settings_for
from tests.exact import ExactContext, Pairs, exact_context
from tests.scenes import chains

Rng = np.random.Generator
COVERED = 0.95
"""Share of cases that an uncertainty is to cover; measured 0.97 to 1, of some 60 cases each."""
COVERED_AT_SNAPS = 0.9
"""The same of the largest tension of a sawtooth, 0.95 measured: two teeth may be as high as each other."""
CASES, SNAPPING_CASES = 60, 12
OPPOSITE = 12.0
"""Spacing over the longest range: no particle feels another but its opposite."""
ROUND_OFF = 1e-9


def random_case(rng: Rng, ratio: float, size: float, tolerance: float, **tables: Any) -> Scene:
    """A contact whose greatest negative pair stiffness is `ratio` of its springs'; some √(8 size) particles wide."""
    long = float(np.exp(rng.uniform(np.log(0.3), np.log(1.2))))
    short, amplitude = long / rng.uniform(1.6, 3.5), rng.uniform(0.05, 0.3)
    law = PairInteraction(Exponential(amplitude * rng.uniform(1.5, 3.0), short), Exponential(amplitude, long))
    stiffness = 2.0 * float(law.force_slope(np.asarray(law.extremum_distance(2)))) / ratio
    spacing = OPPOSITE * long
    numbers = (law.repulsion.amplitude, short, amplitude, long)
    scene = chains(
        size * spacing**2 / long, stiffness, numbers, bodies={"spacing": spacing}, accuracy={"tolerance": tolerance}
    )
    return scene_from_dict(scene | {"experiment": {"kind": "path", "displacements": [0.0, long]}} | tables)


def with_experiment(scene: Scene, experiment: dict[str, Any]) -> Scene:
    return scene_from_dict(scene.model_dump(by_alias=True, exclude_none=True) | {"experiment": experiment})


def exact(scene: Scene, lowest: float, deepest: float, points: int) -> tuple[Pairs, float, float]:
    """The pairs, and displacement and size of their largest tension."""
    pairs = Pairs.of(scene, settings_for(scene))
    return pairs, *pairs.largest_tension(lowest, deepest, points)


def log_uniform(rng: Rng, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def covered(found: list[tuple[Outcome, dict[str, float]]], name: str) -> float:
    """Share of the outcomes whose quantity is within its uncertainty of the exact one."""
    pairs = [(outcome.quantities[name], exact[name]) for outcome, exact in found if name in outcome.quantities]
    assert len(pairs) > 0.8 * len(found)
    return float(np.mean([abs(ours.value - value) <= ours.uncertainty + ROUND_OFF for ours, value in pairs]))


def pulled(
    rng: Rng, run: Callable[[ExactContext], Outcome], cases: int, tables: dict[str, Any], lets_go: float = 1.0
) -> list[tuple[Scene, Outcome, dict[str, float]]]:
    """Random pull-offs, and the exact numbers; held loads are lost at this part `lets_go` of the largest tension."""
    found = []
    for _ in range(cases):
        scene = random_case(rng, rng.uniform(0.05, 0.5), log_uniform(rng, 4.0, 200.0), log_uniform(rng, 1e-3, 5e-2))
        long, largest = scene.interaction.attraction.range, settings_for(scene).estimate.pull_off_force()
        experiment = {"kind": "pull_off", "preload": rng.uniform(0.2, 2.0) * largest} | tables.get("experiment", {})
        scene = scene_from_dict(
            scene.model_dump(by_alias=True, exclude_none=True) | tables | {"experiment": experiment}
        )
        settings = settings_for(scene)
        pairs, top, tension = exact(scene, -8.0 * long, settings.largest_displacement + 0.1, 200)
        zero = pairs.displacement(0.0, top, 1.5 * settings.largest_displacement + 0.1)
        context = exact_context(scene, settings)
        tension *= lets_go
        context.largest_tension = top, tension
        numbers = {
            "adhesion_force": tension,
            "critical_radius": pairs.contact_radius(top),
            "zero_load_radius": pairs.contact_radius(zero),
        }
        found.append((scene, run(context), numbers))
    return found


def test_a_pull_off_at_rest_claims_no_more_than_it_knows() -> None:
    found = [entry[1:] for entry in pulled(np.random.default_rng(5), pull_off_quasistatic, CASES, {})]
    assert covered(found, "adhesion_force") >= COVERED
    assert covered(found, "critical_radius") >= COVERED


def test_a_pull_off_over_snaps_claims_no_more_than_it_knows_and_meets_its_tolerance() -> None:
    """Reference: the pairs with their folds, to round-off."""
    rng, found = np.random.default_rng(9), []
    while len(found) < SNAPPING_CASES:
        tolerance = log_uniform(rng, 1e-3, 1e-2)
        scene = random_case(rng, rng.uniform(1.1, 2.5), rng.uniform(0.15, 1.5), tolerance)
        settings = settings_for(scene)
        pairs = Pairs.of(scene, settings)
        lattice = PairLattice(pairs.law, pairs.stiffness, pairs.places**2 / (2.0 * pairs.radius))
        preload = rng.uniform(0.3, 3.0) * settings.estimate.pull_off_force()
        tension, place = lattice.pull_off(lattice.preloaded(preload))
        outcome = pull_off_quasistatic(exact_context(with_experiment(scene, {"kind": "pull_off", "preload": preload})))
        force = outcome.quantities["adhesion_force"]
        assert force.uncertainty <= tolerance * force.value
        assert outcome.quantities["preload"].value == pytest.approx(preload, abs=tolerance * tension)
        numbers = {"adhesion_force": tension, "critical_radius": pairs.contact_radius(place)}
        found.append((outcome, numbers))
    assert covered(found, "adhesion_force") >= COVERED_AT_SNAPS
    assert covered(found, "critical_radius") >= COVERED_AT_SNAPS


@pytest.mark.parametrize("lets_go", [1.0, 0.93])
def test_a_pull_off_in_time_is_bracketed_as_narrowly_as_was_asked_for(lets_go: float) -> None:
    """Also where the contact lets go before the estimate expects it to, so that no first guess is good enough."""
    timed = {"damping": {"coefficient": "auto"}, "plate": {}, "experiment": {"method": "dynamic"}}
    for scene, outcome, numbers in pulled(np.random.default_rng(6), pull_off_dynamic, 6, timed, lets_go):
        force = outcome.quantities["adhesion_force"]
        assert abs(force.value - numbers["adhesion_force"]) <= force.uncertainty
        assert force.uncertainty <= scene.accuracy.tolerance * force.value


@pytest.mark.parametrize(("method", "cases"), [("quasistatic", 40), ("dynamic", 12)])
def test_a_load_claims_no_more_than_it_knows_up_to_its_largest_tension(method: str, cases: int) -> None:
    rng, found = np.random.default_rng(10), []
    timed = {"damping": {"coefficient": "auto"}, "plate": {}} if method == "dynamic" else {}
    timed |= {"experiment": {"kind": "load", "method": method, "force": 0.0}}
    for _ in range(cases):
        tolerance = log_uniform(rng, 1e-3, 1e-2)
        scene = random_case(rng, rng.uniform(0.05, 0.5), log_uniform(rng, 4.0, 200.0), tolerance, **timed)
        largest, long = settings_for(scene).estimate.pull_off_force(), scene.interaction.attraction.range
        force = rng.choice([-0.98, -0.8, -0.3, 0.2, 2.0]) * largest
        scene = with_experiment(scene, {"kind": "load", "method": method, "force": force})
        settings = settings_for(scene)
        pairs, top, tension = exact(scene, -8.0 * long, settings.largest_displacement + 0.1, 200)
        context = exact_context(scene, settings)
        context.largest_tension = top, tension
        outcome = (load_dynamic if method == "dynamic" else load_quasistatic)(context)
        place = pairs.displacement(force, top, 1.5 * settings.largest_displacement + 0.1)
        radius = pairs.contact_radius(place)
        found.append((outcome, {
            "displacement": place, "force": force, "contact_radius": radius,
            "mean_pressure": force / (np.pi * radius**2),
        }))  # fmt: skip
        assert "near_pull_off" not in outcome.warnings
        known = outcome.quantities
        assert known["force"].uncertainty <= tolerance * max(abs(force), settings.force_scale)
        # d goes with √(F_A + F): near the largest tension an error of the force counts more.
        near = known["force"].uncertainty / (largest * np.sqrt(1.0 + min(force / largest, 0.0)))
        assert known["displacement"].uncertainty <= 8.0 * near * (place - top)
    for name in ("displacement", "force", "contact_radius", "mean_pressure"):
        assert covered(found, name) >= COVERED, name


def test_a_load_beyond_the_largest_tension_is_refused_and_one_by_a_hair_is_doubted() -> None:
    for method, load in (("quasistatic", load_quasistatic), ("dynamic", load_dynamic)):
        tables = {"damping": {"coefficient": "auto"}, "plate": {}} if method == "dynamic" else {}
        held = {"kind": "load", "method": method, "force": 0.0}
        scene = random_case(np.random.default_rng(11), 0.3, 40.0, 1e-3, **tables, experiment=held)
        long = scene.interaction.attraction.range
        _, top, tension = exact(scene, -8.0 * long, long, 400)
        for share, told in ((0.97, "held"), (0.9995, "doubted"), (1.003, "refused")):
            context = exact_context(
                with_experiment(scene, {"kind": "load", "method": method, "force": -share * tension})
            )
            context.largest_tension = top, tension
            if told == "refused":
                with pytest.raises(UntrustedError, match=r"cannot hold|never reached"):
                    load(context)
            else:
                doubted = "near_pull_off" in load(context).warnings
                assert doubted == (told == "doubted" and method == "dynamic")


@cache
def paths() -> list[tuple[Scene, Outcome, dict[str, float]]]:
    """Random paths down and apart in coarse rows, and the exact numbers."""
    rng, found = np.random.default_rng(5), []
    for _ in range(CASES):
        scene = random_case(rng, rng.uniform(0.05, 0.5), log_uniform(rng, 4.0, 200.0), 1e-3)
        long = scene.interaction.attraction.range
        pairs, top, tension = exact(scene, -10.0 * long, long, 200)
        zero = pairs.displacement(0.0, top, 4.0 * long)
        deepest = max(rng.uniform(0.3, 1.0) * long, zero + 0.3 * long)
        way = np.linspace(deepest, top - 2.0 * long, int(rng.integers(8, 60))).tolist()
        scene = with_experiment(scene, {"kind": "path", "displacements": [0.0, *way]})
        known = {
            "zero_load_radius": pairs.contact_radius(zero), "adhesion_force": tension,
            "critical_radius": pairs.contact_radius(top),
        }  # fmt: skip
        found.append((scene, path(exact_context(scene)), known))
    return found


def test_a_path_claims_no_more_than_its_rows_tell() -> None:
    """The radius at F = 0 between coarse rows."""
    found = [(outcome, known) for _, outcome, known in paths()]
    assert covered(found, "zero_load_radius") >= COVERED


def test_a_path_over_snaps_may_miss_the_top_of_a_tooth_and_says_so() -> None:
    rng, found = np.random.default_rng(7), []
    while len(found) < CASES:
        scene = random_case(rng, rng.uniform(1.2, 2.5), rng.uniform(0.15, 1.5), 1e-2)
        long = scene.interaction.attraction.range
        pairs = Pairs.of(scene, settings_for(scene))
        lowest = pairs.law.force_free_distance() - pairs.dip - long
        way = np.linspace(long, lowest, int(rng.integers(40, 120))).tolist()
        scene = with_experiment(scene, {"kind": "path", "displacements": [0.0, *way]})
        _, _, tension = exact(scene, lowest, long, 600)
        found.append((path(exact_context(scene)), {"adhesion_force": tension}))
    assert covered(found, "adhesion_force") >= COVERED_AT_SNAPS
