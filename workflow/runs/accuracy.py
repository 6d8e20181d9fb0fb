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
from contact1d.workflow.experiments.experiment import finer_spacing
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import FORCE, LENGTH

CURVE_FORCE = "force in curve.csv"
"""Name of the force of a curve in warnings."""


def accuracy_warnings(scene: Scene, outcome: Outcome) -> dict[str, str]:
    """Return the warnings of results that are not reported or miss the tolerance of the scene: name and message.

    Names are `unknown` (not reported), `lattice` (the discretisation error alone exceeds the tolerance) and `tolerance`
    (the others). Empty where all meet it, and of a mean under noise, whose standard error is its uncertainty.
    """
    if kind_of(scene).is_statistical:
        return {}
    missing, tolerance, warnings = unreported(scene, outcome), scene.accuracy.tolerance, {}
    results = dict(outcome.results) | _curve_force(scene, outcome)
    shown = {name: result for name, result in results.items() if name not in missing}
    by_lattice = _by_lattice(shown, tolerance)
    uncertain = {name: share for name, share in unmet(shown, tolerance, (MODEL,)).items() if name not in by_lattice}
    if missing:
        bounds = ", ".join(f"{name} {_bound(result)}" for name, result in missing.items())
        warnings["unknown"] = (
            f"not reported, because the uncertainty is more than half of the value: {bounds}. {_advice(scene, missing)}"
        )
    if by_lattice:
        warnings["lattice"] = _lattice_message(scene, by_lattice, bool(_by_lattice(missing, tolerance)))
    if uncertain:
        ended = f" ({outcome.refinement.ended})" if outcome.refinement and outcome.refinement.ended else ""
        warnings["tolerance"] = (
            f"relative uncertainties above the tolerance of {tolerance:g}: {in_words(uncertain, tolerance)}{ended}. "
            f"{_advice(scene, {name: shown[name] for name in uncertain})}"
        )
    return warnings


def unreported(scene: Scene, outcome: Outcome) -> dict[str, Result]:
    """Return the results whose uncertainty exceeds half of the value, and the tolerance of the run's scale, by name.

    The scale of a force or a displacement is the largest of the run, that of another result the largest one of its
    unit: a number that is 0 within the tolerance of that scale is reported as 0. A dissipated energy is its own scale,
    since the question is whether there is a loss at all. The shares of statistics and of numbers with ± do not count.
    Empty for means under noise, which are reported whatever their standard errors.
    """
    if kind_of(scene).is_statistical:
        return {}
    scales = {
        FORCE: max((abs(state.force) for state in outcome.states), default=0.0),
        LENGTH: max((abs(state.displacement) for state in outcome.states), default=0.0),
    }
    for name, result in outcome.results.items():
        scale = _scale_name(name, result)
        scales[scale] = max(scales.get(scale, 0.0), abs(result.value), result.scale or 0.0)
    tolerance = scene.accuracy.tolerance
    missing = {}
    for name, result in outcome.results.items():
        error = result.uncertainty - result.errors.get("statistics", 0.0) - result.given
        allowed = max(0.5 * abs(result.value), tolerance * scales[_scale_name(name, result)])
        if not result.prescribed and error > allowed:
            missing[name] = result
    return missing


def main_results(scene: Scene, results: Mapping[str, Result]) -> dict[str, Result]:
    """Return the main results of an experiment that a run has, by name, without the load and prescribed ones.

    Args:
        scene: of the run.
        results: all results of the run by name.
    """
    load = scene.experiment.load_key if scene.experiment.compression is not None else None
    names = [name for name in kind_of(scene).main_results if name in results and name != load]
    return {name: results[name] for name in names if not results[name].prescribed}


def require_results(scene: Scene, outcome: Outcome) -> None:
    """Raise UntrustedError where a run has main results and none of them can be reported.

    The result of a path that the scene gives is its curve, so that it passes.
    """
    if scene.experiment.history_is_given:
        return
    main = main_results(scene, outcome.results)
    if main and not main.keys() - unreported(scene, outcome).keys():
        raise UntrustedError(accuracy_warnings(scene, outcome)["unknown"])


def with_checks(scene: Scene, outcome: Outcome, pressures: Mapping[str, BodyPressure]) -> Outcome:
    """Return the outcome with the consistency checks of the body's results added to its own.

    Args:
        scene: of the run.
        outcome: of the run, with the results of the body.
        pressures: on the three-dimensional body, by state.
    """
    checks = pressure(scene, outcome, pressures) | closed_form(scene, reported(scene, outcome).exact)
    return replace(outcome, consistency={**outcome.consistency, **checks})


def require_consistency(outcome: Outcome) -> None:
    """Raise UntrustedError where a consistency check of a run fails, with the first that does; nothing is returned."""
    for name, check in outcome.consistency.items():
        if not check.holds:
            raise UntrustedError(
                f"the run contradicts itself ({name}): {check.words}, a relative difference of {check.difference:.2g} "
                f"where {check.allowed:.2g} is allowed. This is an error of the program: please report the scene"
            )


def reported(scene: Scene, outcome: Outcome) -> Outcome:
    """Return the outcome without the results of `unreported`, those too uncertain to be stated.

    All else is unchanged.
    """
    missing = unreported(scene, outcome)
    return replace(outcome, results={name: result for name, result in outcome.results.items() if name not in missing})


def _scale_name(name: str, result: Result) -> str:
    """Return what a result is compared with: "radius" of radii, a dissipated energy's own name, else the unit.

    A dissipated energy that has a scale of its own is compared by its unit, too.
    """
    if result.scale is None and name.startswith(LOSSES):
        return name
    return "radius" if name.endswith("radius") else result.unit


def _bound(result: Result) -> str:
    """Return the bound of an uncertain result with its unit: "(less than 2.3 FU)" if it may be 0, else "(± 2.3 FU)".

    The bound of one that may be 0 is |value| + uncertainty. Of an infinite uncertainty it says that there is no bound.
    """
    bound, words = result.uncertainty, "±"
    if np.isinf(bound):
        return "(not shown to have a bound: give more particles in the contact, or more points of a profile)"
    if result.uncertainty >= abs(result.value):
        bound, words = bound + abs(result.value), "less than"
    return f"({words} {float(f'{bound:.2g}'):g} {result.unit})"


def _curve_force(scene: Scene, outcome: Outcome) -> dict[str, Result]:
    """Return the force with the largest error of a curve that is a result, by its name in warnings.

    Empty for other curves. It is a result in [FU] whose scale is the largest |force|. Numbers with ± count for
    alternative profiles only.
    """
    if not kind_of(scene).curve_is_result:
        return {}
    forces, errors = [state.force for state in outcome.states], dict(outcome.rows["force"])
    if not scene.bodies.profile.alternatives:
        errors.pop("input", None)
    worst = int(np.argmax(sum(errors.values())))
    at_worst = {source: float(column[worst]) for source, column in errors.items()}
    return {CURVE_FORCE: Result(forces[worst], FORCE, at_worst, scale=float(np.abs(forces).max()))}


def _advice(scene: Scene, results: Mapping[str, Result]) -> str:
    """Return a sentence on how to improve results, by their dominant error, such as a finer spacing to use.

    Args:
        scene: of the run.
        results: those to improve, by name, one at least.
    """
    tolerance = scene.accuracy.tolerance
    if all(MODEL in result.errors for result in results.values()):
        return "Two evaluations of this quantity differ by that much (`formulas` in results.json)"
    if scene.bodies.profile.alternatives and all(map(_is_of_points, results.values())):
        return "They are limited by the profile between its points: give more of them, or more digits"
    if all(max(result.errors, key=result.errors.__getitem__) == "time" for result in results.values()):
        return "They are limited by the timestep, which a smaller accuracy.tolerance shortens"
    if any(result.read > tolerance * result.size for result in results.values()):
        return f"The uncertainty of a radius is limited by the spacing: use {finer_spacing(scene)}"
    return kind_of(scene).advice(scene)


def _is_of_points(result: Result) -> bool:
    """Return whether more than half of the uncertainty is that of a profile by points, without numbers with ±."""
    return result.errors.get("input", 0.0) - result.given > 0.5 * (result.uncertainty - result.given)


def _by_lattice(results: Mapping[str, Result], tolerance: float) -> dict[str, float]:
    """Return relative discretisation errors above the tolerance, by name, dimensionless; empty where there are none.

    The share of interpolation of radii between particles, and that of numbers with ±, do not count.
    """
    of_lattice = {
        name: replace(result, errors={LATTICE: result.errors.get(LATTICE, 0.0) - result.read}, read=0.0, given=0.0)
        for name, result in results.items()
    }
    return unmet(of_lattice, tolerance)


def _lattice_message(scene: Scene, shares: Mapping[str, float], uncertain: bool) -> str:
    """Return the warning of discretisation errors, with a suggested spacing [LU] unless other results are unreported.

    The spacing is by convergence of the second order; of such uncertain results no order of convergence holds.

    Args:
        scene: of the run.
        shares: relative discretisation errors by name.
        uncertain: whether there are unreported results with too large a discretisation error.
    """
    tolerance = scene.accuracy.tolerance
    spacing = scene.bodies.spacing * np.sqrt(0.5 * tolerance / min(1.0, max(shares.values())))
    finer = finer_spacing(scene, "" if uncertain else f", about {spacing:.2g} LU")
    return (
        f"relative discretisation errors above the tolerance of {tolerance:g}: {in_words(shares, tolerance)}. "
        f"Use {finer}, or give bodies.particles if this discrete chain is intended"
    )
