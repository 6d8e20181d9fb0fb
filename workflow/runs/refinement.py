"""Refinement: the run is repeated with finer settings until the tolerance is met, or there is no improvement.

A pass has the settings and the checks of a tolerance that is TOLERANCE_RATIO times smaller than that of the one before.
Where two nested passes differ by more than both uncertainties, these are increased.
"""

from __future__ import annotations

import os
from dataclasses import replace

from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.outcome import LATTICE, Outcome, Refinement, Result, in_words, unmet
from contact1d.workflow.continuation.trust import UntrustedError, doubts
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.engine.session import EngineError
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.experiments import kind_of, perform
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.scene import Scene

TOLERANCE_RATIO = 5.0
"""Tolerance of a pass over that of the next one."""
MOST_REFINEMENTS = 2
HELP_RATIO = 0.8
"""Uncertainty of a result over that of the pass before from which on a refinement counts as no help."""


def refined(context: RunContext, outcome: Outcome) -> tuple[Deck, Outcome]:
    """Refine a run that gave `outcome` as long as that helps, at most MOST_REFINEMENTS times: the finest pass.

    Time and steps of all passes are added to those of `context`. A finer pass that fails is no failure of the run: what
    was found before stands, and the refinement says how it ended. A way that the scene gives is not refined: its rows
    limit what is found. With noise a load goes on sampling until it is known well enough, which is its own refinement.
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
        if count == MOST_REFINEMENTS:
            ended = f"{_after(count)}, the limit"
            break
        context.progress.note(f"refining: {in_words(left, wanted)}, tolerance {scene.accuracy.tolerance:g}")
        try:
            finer_deck, finer = _pass(context, tolerance / TOLERANCE_RATIO)
        except (EngineError, UntrustedError, SettingsError) as error:
            ended = f"{_after(count)}, since the next failed: {error.message}"
            break
        tolerance, count = tolerance / TOLERANCE_RATIO, count + 1
        before, deck, outcome = outcome, finer_deck, nested(outcome, finer)
        ended = _after(count)
        if _open(scene, outcome) and not _helped(left, before, outcome):
            ended += ", the last without improvement"
            break
    # What a pass doubts by its own tolerance is no doubt of a run that was asked for less.
    stricter = doubts(deck.scene, deck.settings, outcome.states)
    warnings = {name: text for name, text in outcome.warnings.items() if name not in stricter}
    warnings |= doubts(scene, replace(deck.settings, tolerance=scene.accuracy.tolerance), outcome.states)
    refinement = Refinement(float(f"{tolerance:.6g}"), count, ended)
    return deck, replace(outcome, warnings=warnings, refinement=refinement)


def _open(scene: Scene, outcome: Outcome) -> dict[str, float]:
    """Main results whose uncertainty exceeds the tolerance, without the discretisation error."""
    main = {name: one for name, one in outcome.results.items() if name in kind_of(scene).main_results}
    return unmet(main, scene.accuracy.tolerance, (LATTICE,))


def nested(coarse: Outcome, fine: Outcome) -> Outcome:
    """The finer outcome; where |fine − coarse| exceeds both uncertainties, its own is increased by the same factor.

    What numbers with ± change is the same in both, and no part of this.
    """
    results = {}
    for name, one in fine.results.items():
        before = coarse.results.get(name, one)
        stated = _own(before) + _own(one)
        factor = max(1.0, abs(one.value - before.value) / stated) if stated > 0.0 else 1.0
        errors = {source: factor * error for source, error in one.errors.items()}
        if one.given:
            errors["input"] -= (factor - 1.0) * one.given
        results[name] = replace(one, errors=errors)
    return replace(fine, results=results)


def _own(one: Result) -> float:
    """The uncertainty without what the scene leaves open."""
    return one.uncertainty - one.given


def _after(count: int) -> str:
    return f"after {count} refinement{'' if count == 1 else 's'}"


def _helped(names: dict[str, float], before: Outcome, after: Outcome) -> bool:
    """Whether one of the named results is known clearly better."""
    return any(
        name in after.results and _own(after.results[name]) < HELP_RATIO * _own(before.results[name]) for name in names
    )


def _pass(context: RunContext, tolerance: float) -> tuple[Deck, Outcome]:
    """One pass with the settings of a tolerance; its files replace those in the run folder only when it is done."""
    scene = context.deck.scene
    deck = Deck(scene, settings_for(scene, tolerance))
    with context.aside(deck) as finer:
        outcome = perform(finer)
        for file in finer.folder.iterdir():
            os.replace(file, context.folder / file.name)
    return finer.deck, outcome
