"""Which results of a run miss its tolerance, and which are too uncertain to be reported."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from contact1d.workflow.body.consistency import closed_form, pressure
from contact1d.workflow.body.traction import BodyPressure
from contact1d.workflow.continuation.outcome import LATTICE, LOSSES, MODEL, Outcome, Result, in_words, unmet
from contact1d.workflow.continuation.trust import UntrustedError
from contact1d.workflow.experiments import kind_of
from contact1d.workflow.experiments.experiment import FINER_SPACING
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import FORCE, LENGTH

ROWS = "force in curve.csv"
"""What a warning calls the rows of a curve."""
UNKNOWN = 0.5
"""Uncertainty over a value above which the value is not reported."""


def accuracy_warnings(scene: Scene, outcome: Outcome) -> dict[str, str]:
    """By name: `unknown`, results that are not reported; `lattice` and `tolerance`, those that miss the tolerance.

    `lattice` has those whose discretisation error alone exceeds it. Noise has its own statistics.
    """
    if kind_of(scene).is_statistical:
        return {}
    missing, tolerance, warnings = unknown(scene, outcome), scene.accuracy.tolerance, {}
    every = dict(outcome.results) | _of_the_curve(scene, outcome)
    known = {name: one for name, one in every.items() if name not in missing}
    by_lattice = _by_lattice(known, tolerance)
    others = {name: share for name, share in unmet(known, tolerance, (MODEL,)).items() if name not in by_lattice}
    if missing:
        wide = ", ".join(f"{name} {_less_than(one)}" for name, one in missing.items())
        warnings["unknown"] = (
            f"not reported, because the uncertainty is more than half of the value: {wide}. {_advice(scene, missing)}"
        )
    if by_lattice:
        warnings["lattice"] = _lattice_message(scene, by_lattice, bool(_by_lattice(missing, tolerance)))
    if others:
        ended = f" ({outcome.refinement.ended})" if outcome.refinement and outcome.refinement.ended else ""
        warnings["tolerance"] = (
            f"relative uncertainties above the tolerance of {tolerance:g}: {in_words(others, tolerance)}{ended}. "
            f"{_advice(scene, {name: known[name] for name in others})}"
        )
    return warnings


def unknown(scene: Scene, outcome: Outcome) -> dict[str, Result]:
    """The results whose uncertainty exceeds UNKNOWN of the value and the tolerance of the run's own scale.

    The scale of a force or a displacement is the largest of the run, that of another result the largest one of its
    unit: a number that is 0 beside it is known to be 0. An energy that is lost is compared with itself alone: whether
    there is a loss at all is what is asked. Means are reported whatever their standard errors, and what follows from
    numbers with ± whatever these are.
    """
    if kind_of(scene).is_statistical:
        return {}
    scales = {
        FORCE: max((abs(state.force) for state in outcome.states), default=0.0),
        LENGTH: max((abs(state.displacement) for state in outcome.states), default=0.0),
    }
    for name, one in outcome.results.items():
        kind = _kind(name, one)
        scales[kind] = max(scales.get(kind, 0.0), abs(one.value), one.scale or 0.0)
    tolerance = scene.accuracy.tolerance
    missing = {}
    for name, one in outcome.results.items():
        error = one.uncertainty - one.errors.get("statistics", 0.0) - one.given
        if not one.prescribed and error > max(UNKNOWN * abs(one.value), tolerance * scales[_kind(name, one)]):
            missing[name] = one
    return missing


def main_results(scene: Scene, results: Mapping[str, Result]) -> dict[str, Result]:
    """The main results as far as they are found, and neither prescribed nor the load."""
    load = scene.experiment.load_key if scene.experiment.compression is not None else None
    found = [name for name in kind_of(scene).main_results if name in results and name != load]
    return {name: results[name] for name in found if not results[name].prescribed}


def require_results(scene: Scene, outcome: Outcome) -> None:
    """Raise UntrustedError where a run has main results and none of them can be reported.

    A path that the scene gives has its curve, whatever can be read off it.
    """
    if scene.experiment.history_is_given:
        return
    main = main_results(scene, outcome.results)
    if main and not main.keys() - unknown(scene, outcome).keys():
        raise UntrustedError(accuracy_warnings(scene, outcome)["unknown"])


def with_checks(scene: Scene, outcome: Outcome, pressures: Mapping[str, BodyPressure]) -> Outcome:
    """The outcome with the checks of the body's results."""
    checks = pressure(scene, outcome, pressures) | closed_form(scene, reported(scene, outcome).exact)
    return replace(outcome, consistency={**outcome.consistency, **checks})


def require_consistency(outcome: Outcome) -> None:
    """Raise UntrustedError where a run contradicts itself."""
    for name, check in outcome.consistency.items():
        if not check.holds:
            raise UntrustedError(
                f"the run contradicts itself ({name}): {check.words}, a relative difference of {check.difference:.2g} "
                f"where {check.allowed:.2g} is allowed. This is an error of the program: please report the scene"
            )


def reported(scene: Scene, outcome: Outcome) -> Outcome:
    """The outcome without results that are not reported."""
    missing = unknown(scene, outcome)
    return replace(outcome, results={name: one for name, one in outcome.results.items() if name not in missing})


def _kind(name: str, one: Result) -> str:
    """Radii are compared with radii, a loss with itself, others by their unit."""
    if one.scale is None and name.startswith(LOSSES):
        return name
    return "radius" if name.endswith("radius") else one.unit


def _less_than(one: Result) -> str:
    """How large a result may be: "(less than 2.3 FU)" of one that may be 0, else "(± 2.3 FU)"."""
    bound, words = one.uncertainty, "±"
    if np.isinf(bound):
        return "(not shown to have a bound: give more particles in the contact, or more points of a profile)"
    if one.uncertainty >= abs(one.value):
        bound, words = bound + abs(one.value), "less than"
    return f"({words} {float(f'{bound:.2g}'):g} {one.unit})"


def _of_the_curve(scene: Scene, outcome: Outcome) -> dict[str, Result]:
    """The force of a curve that is asked for with the largest error of its own, which is compared with the largest one.

    What numbers with ± change is none.
    """
    if not kind_of(scene).curve_is_result:
        return {}
    forces, errors = [state.force for state in outcome.states], dict(outcome.rows["force"])
    if not scene.bodies.profile.alternatives:
        errors.pop("input", None)
    worst = int(np.argmax(sum(errors.values())))
    own = {source: float(one[worst]) for source, one in errors.items()}
    return {ROWS: Result(forces[worst], FORCE, own, scale=float(np.abs(forces).max()))}


def _advice(scene: Scene, results: Mapping[str, Result]) -> str:
    """How to improve these results, by their dominant error."""
    tolerance = scene.accuracy.tolerance
    if all(MODEL in one.errors for one in results.values()):
        return "Two evaluations of this quantity differ by that much (`formulas` in results.json)"
    if scene.bodies.profile.alternatives and all(map(_is_of_points, results.values())):
        return "They are limited by what lies between the points of the profile: give more of them, or more digits"
    if all(max(one.errors, key=one.errors.__getitem__) == "time" for one in results.values()):
        return "They are limited by the timestep, which a smaller accuracy.tolerance shortens"
    if any(one.read > tolerance * one.size for one in results.values()):
        return f"The uncertainty of a radius is limited by the spacing: use {FINER_SPACING}"
    return kind_of(scene).advice(scene)


def _is_of_points(one: Result) -> bool:
    """Whether the largest error is that of a table."""
    return one.errors.get("input", 0.0) - one.given > 0.5 * (one.uncertainty - one.given)


def _by_lattice(results: Mapping[str, Result], tolerance: float) -> dict[str, float]:
    """Relative discretisation errors above the tolerance, without those of interpolation between particles, by name."""
    of_lattice = {
        name: replace(one, errors={LATTICE: one.errors.get(LATTICE, 0.0) - one.read}, read=0.0, given=0.0)
        for name, one in results.items()
    }
    return unmet(of_lattice, tolerance)


def _lattice_message(scene: Scene, shares: Mapping[str, float], others_unknown: bool) -> str:
    """A spacing is named, by the second order, unless other results are so uncertain that no order holds."""
    tolerance = scene.accuracy.tolerance
    spacing = scene.bodies.spacing * np.sqrt(0.5 * tolerance / min(1.0, max(shares.values())))
    return (
        f"relative discretisation errors above the tolerance of {tolerance:g}: {in_words(shares, tolerance)}. "
        f"Use a smaller bodies.spacing{'' if others_unknown else f', about {spacing:.2g} LU'}, at the same stiffness "
        "and energy per length, or give bodies.particles if this discrete chain is intended"
    )
