"""Which results of a run miss its tolerance, and which are too uncertain to be reported."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from contact1d.workflow.body.consistency import closed_form, pressure
from contact1d.workflow.body.traction import BodyPressure
from contact1d.workflow.continuation.outcome import LATTICE, LOSSES, MODEL, Outcome, Result, in_words, unmet
from contact1d.workflow.errors import UntrustedError
from contact1d.workflow.experiments import kind_of
from contact1d.workflow.experiments.experiment import finer_spacing
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import FORCE, LENGTH

CURVE_FORCE = "force in curve.csv"
"""Name of the force of a curve in warnings."""


def accuracy_warnings(scene: Scene, outcome: Outcome) -> dict[str, str]:
    """Return the warnings, name and message, of results that are not reported or miss the tolerance of the scene.

    Names are `unknown` (not reported), `lattice` (the discretisation error alone exceeds the tolerance) and `tolerance`
    (all errors together do, without those of numbers with ± and of two formulas that differ). Each has all of its
    results in one message; one is missing where it has none. Empty where all meet the tolerance, and for experiments
    whose results are means under noise, whose standard error is their uncertainty. The forces of a path count as one
    result.
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

    The scale of a force or a displacement is the largest absolute one of the run, that of a radius the largest radius,
    that of another result the largest one of its unit: a number that is 0 within the tolerance of that scale is
    reported as 0. A dissipated energy is its own scale, since the question is whether there is a loss at all. The
    shares of statistics and of numbers with ± do not count. Prescribed results are never among them; empty for means
    under noise, which are reported whatever their standard errors.
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
    """Return the main results of an experiment that a run has, by name, in the order of the experiment.

    Prescribed results are left out, and the load of an experiment under a force. Empty where there are none.

    Args:
        scene: of the run.
        results: all results of the run by name.
    """
    load = scene.experiment.load_key if scene.experiment.compression is not None else None
    names = [name for name in kind_of(scene).main_results if name in results and name != load]
    return {name: results[name] for name in names if not results[name].prescribed}


def require_results(scene: Scene, outcome: Outcome) -> None:
    """Check that at least one main result of a run can be reported; nothing is returned.

    A run without main results passes, and one along a path that the scene gives, whose result is its curve.

    Raises:
        UntrustedError: none can be reported; with their bounds and how to improve them.
    """
    if scene.experiment.history_is_given:
        return
    main = main_results(scene, outcome.results)
    if main and not main.keys() - unreported(scene, outcome).keys():
        raise UntrustedError(accuracy_warnings(scene, outcome)["unknown"])


def with_checks(scene: Scene, outcome: Outcome, pressures: Mapping[str, BodyPressure]) -> Outcome:
    """Return the outcome with further consistency checks: of the pressure on the body, and with exact closed forms.

    Its own checks stay, unless one of these has the same name; all else is unchanged.

    Args:
        scene: of the run.
        outcome: of the run, with the results of the body.
        pressures: on the three-dimensional body, by state.
    """
    checks = pressure(scene, outcome, pressures) | closed_form(scene, reported(scene, outcome).exact)
    return outcome.adding(consistency=checks)


def require_consistency(outcome: Outcome) -> None:
    """Check that each consistency check of a run holds; nothing is returned.

    Raises:
        UntrustedError: one does not, with the first that fails; a difference of NaN fails.
    """
    for name, check in outcome.consistency.items():
        if not check.holds:
            raise UntrustedError(
                f"the run contradicts itself ({name}): {check.words}, a relative difference of {check.difference:.2g} "
                f"where {check.allowed:.2g} is allowed. This is an error of the program: please report the scene"
            )


def reported(scene: Scene, outcome: Outcome) -> Outcome:
    """Return the outcome without the results that are too uncertain to be stated; all else is unchanged.

    These are the results, neither prescribed nor means under noise, whose uncertainty exceeds half of their value and
    the tolerance of the run's largest value of the kind.
    """
    missing = unreported(scene, outcome)
    return replace(outcome, results={name: result for name, result in outcome.results.items() if name not in missing})


def _scale_name(name: str, result: Result) -> str:
    """Return the name of the scale that a result is compared with: "radius" of radii, else its unit, such as "FU".

    A dissipated energy, or energy of instabilities, without a scale of its own has its own name.
    """
    if result.scale is None and name.startswith(LOSSES):
        return name
    return "radius" if name.endswith("radius") else result.unit


def _bound(result: Result) -> str:
    """Return the bound of an uncertain result with its unit: "(less than 2.3 FU)" if it may be 0, else "(± 2.3 FU)".

    The bound of one that may be 0 is |value| + uncertainty, the other one the uncertainty, both in two digits. For an
    infinite uncertainty the text in brackets says that there is no bound.
    """
    bound, words = result.uncertainty, "±"
    if np.isinf(bound):
        return "(not shown to have a bound: give more particles in the contact, or more points of a profile)"
    if result.uncertainty >= abs(result.value):
        bound, words = bound + abs(result.value), "less than"
    return f"({words} {float(f'{bound:.2g}'):g} {result.unit})"


def _curve_force(scene: Scene, outcome: Outcome) -> dict[str, Result]:
    """Return {name of the force in warnings: force with the largest error} of a path, whose forces are results.

    {} for other experiments. It is a result in [FU], compression positive, whose scale is the largest |force| of the
    curve. Numbers with ± count for alternative profiles only.
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
    """Return a sentence, without a full stop, on how to improve results, by the first dominant error that applies.

    In this order: two evaluations that differ, points of a profile, timestep, spacing of a radius; else the advice of
    the experiment.

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
    """Return the relative discretisation errors above the tolerance, dimensionless, by name; empty where none is.

    Prescribed results and those of size 0 are left out, but a radius of size 0 has an infinite error. The share of
    interpolation of radii between particles, and that of numbers with ±, do not count.
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
        shares: relative discretisation errors by name, one at least.
        uncertain: whether there are unreported results with too large a discretisation error.
    """
    tolerance = scene.accuracy.tolerance
    spacing = scene.bodies.spacing * np.sqrt(0.5 * tolerance / min(1.0, max(shares.values())))
    finer = finer_spacing(scene, "" if uncertain else f", about {spacing:.2g} LU")
    return (
        f"relative discretisation errors above the tolerance of {tolerance:g}: {in_words(shares, tolerance)}. "
        f"Use {finer}, or give bodies.particles if this discrete chain is intended"
    )
