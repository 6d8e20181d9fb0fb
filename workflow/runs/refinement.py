"""Refinement: the run is repeated with finer settings until the tolerance is met, or there is no improvement.

A pass has the settings and the checks of a smaller tolerance than the one before. Where two nested passes differ by
more than both uncertainties, these are increased.
"""

from __future__ import annotations

import os
from dataclasses import replace

from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.outcome import LATTICE, Outcome, Refinement, Result, in_words, unmet
from contact1d.workflow.continuation.trust import doubts
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.engine.session import EngineError
from contact1d.workflow.errors import SettingsError, UntrustedError
from contact1d.workflow.experiments import kind_of, perform
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.scene import Scene


def refined(context: RunContext, outcome: Outcome, ratio: float = 5.0, most: int = 2) -> tuple[Deck, Outcome]:
    """Return (deck, outcome) of the finest of up to `most` repeats with finer settings, made while these help.

    They help while a main result misses the tolerance, and not just a radius by its interpolation between particles,
    and the uncertainty of one of these fell by more than a fifth in the last repeat. A path that the scene gives is not
    refined, since its load steps limit the results, nor are means under noise, which are sampled until their standard
    errors are small: deck and outcome are then those that were given, without a record of refinement. Else the outcome
    has one, with 0 repeats where none was needed. If a finer pass fails, the pass before is returned, and the record
    says how it ended. Time and steps of all passes are added to those of `context`, and files of a finer pass replace
    those in its folder.

    Args:
        context: of the run, with its deck.
        outcome: of the first pass.
        ratio: tolerance of a pass over that of the next one.
        most: number of refinements at most.
    """
    scene, deck = context.deck.scene, context.deck
    if kind_of(scene).is_statistical or scene.experiment.history_is_given:
        return deck, outcome
    wanted, count, ended = scene.accuracy.tolerance, 0, ""
    tolerance = wanted
    while open_ := _open(scene, outcome):
        results = outcome.results
        left = {name: share for name, share in open_.items() if results[name].read <= wanted * abs(results[name].value)}
        if not left:
            ended = "; ".join(filter(None, (ended, "the spacing limits these")))
            break
        if count == most:
            ended = f"{_after(count)}, the limit"
            break
        context.progress.note(f"refining: {in_words(left, wanted)}, tolerance {scene.accuracy.tolerance:g}")
        try:
            finer_deck, finer = _pass(context, tolerance / ratio)
        except (EngineError, UntrustedError, SettingsError) as error:
            ended = f"{_after(count)}, since the next failed: {error.message}"
            break
        tolerance, count = tolerance / ratio, count + 1
        before, deck, outcome = outcome, finer_deck, nested(outcome, finer)
        ended = _after(count)
        if _open(scene, outcome) and not _helped(left, before, outcome):
            ended += ", the last without improvement"
            break
    # Warnings by the stricter tolerance of a pass are replaced by those of the scene's tolerance.
    stricter = doubts(deck.scene, deck.settings, outcome.states)
    warnings = {name: text for name, text in outcome.warnings.items() if name not in stricter}
    warnings |= doubts(scene, replace(deck.settings, tolerance=scene.accuracy.tolerance), outcome.states)
    refinement = Refinement(float(f"{tolerance:.6g}"), count, ended)
    return deck, replace(outcome, warnings=warnings, refinement=refinement)


def _open(scene: Scene, outcome: Outcome) -> dict[str, float]:
    """Return main results that miss the tolerance of the scene, with their relative uncertainties, by name; else {}.

    The share of numbers with ± is left out, and discretisation errors, but for that of a radius that is read between
    particles. A radius of size 0 has an infinite one.
    """
    main = {name: result for name, result in outcome.results.items() if name in kind_of(scene).main_results}
    return unmet(main, scene.accuracy.tolerance, (LATTICE,))


def nested(coarse: Outcome, fine: Outcome) -> Outcome:
    """Return the finer outcome with larger uncertainties where the results of both differ by more than both.

    Each error grows by the factor |fine − coarse| over the sum of both uncertainties, where that exceeds 1. The
    contribution of numbers with ± is the same in both outcomes, and stays. A result that the coarse outcome lacks, or
    without uncertainty in both, stays as it is.
    """
    results = {}
    for name, result in fine.results.items():
        before = coarse.results.get(name, result)
        stated = _without_input(before) + _without_input(result)
        factor = max(1.0, abs(result.value - before.value) / stated) if stated > 0.0 else 1.0
        errors = {source: factor * error for source, error in result.errors.items()}
        if result.given:
            errors["input"] -= (factor - 1.0) * result.given
        results[name] = replace(result, errors=errors)
    return replace(fine, results=results)


def _without_input(result: Result) -> float:
    """Return the uncertainty of a result without the contribution of numbers with ±, in the unit of the result."""
    return result.uncertainty - result.given


def _after(count: int) -> str:
    """Return "after 1 refinement", or "after 2 refinements" and so on."""
    return f"after {count} refinement{'' if count == 1 else 's'}"


def _helped(names: dict[str, float], before: Outcome, after: Outcome) -> bool:
    """Return whether the uncertainty of one of the named results, without numbers with ±, fell by more than a fifth.

    A result that the later outcome lacks does not count.
    """
    return any(
        name in after.results and _without_input(after.results[name]) < 0.8 * _without_input(before.results[name])
        for name in names
    )


def _pass(context: RunContext, tolerance: float) -> tuple[Deck, Outcome]:
    """Return (deck, outcome) of a run with the settings of a tolerance (relative).

    The files of the pass replace those in the run folder only when it is done; an error leaves these as they are.

    Raises:
        SettingsError: no settings meet the tolerance.
        EngineError: LAMMPS failed.
        UntrustedError: the result can't be trusted.
    """
    scene = context.deck.scene
    deck = Deck(scene, settings_for(scene, tolerance))
    with context.aside(deck) as finer:
        outcome = perform(finer)
        for file in finer.folder.iterdir():
            os.replace(file, context.folder / file.name)
    return finer.deck, outcome
