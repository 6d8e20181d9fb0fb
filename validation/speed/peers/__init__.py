"""The same Hertz and the same JKR contact with other people's solvers, at equal error (the extra `peers`)."""

import importlib
import importlib.util
import math
import os
import statistics
import time
import warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from validation.row import Row, at_most
from validation.speed.peers.contacts import errors
from validation.study import Bench, Lines, Study

MODULES = ("contact1d_peer", "tamaas_peer", "contact_mechanics_peer")
NEEDS = {"tamaas_peer": "tamaas", "contact_mechanics_peer": "ContactMechanics"}
OURS, ELEMENTS = "contact1d", ("tamaas", "ContactMechanics")
ROUNDS, LONG = 5, 20.0
"""Turns; a setting that took LONG seconds altogether does not run again."""
ENOUGH, BESIDE_JKR = 0.01, 0.0125
"""Errors at which solvers are compared; beside JKR itself no range that boundary elements follow within minutes is
short enough for the first."""
ASKED = {"Hertz": 10.0, "adhesive": 100.0, "JKR": 1000.0}
"""Asked of the other solvers' time over ours."""
WHOLE = 0.025
"""Asked of the whole run of the quickest Hertz curve, through Python, by the clock [s]."""
Result = Mapping[str, Any]
"""Solver, contact, setting, median times [s] and errors of one setting."""


def measure(bench: Bench) -> Lines:
    """Every setting in turn, round after round; one thread each."""
    os.environ |= dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    warnings.filterwarnings("ignore", category=DeprecationWarning)
    jobs = []
    for name in MODULES:
        if importlib.util.find_spec(NEEDS.get(name, "numpy")) is None:
            continue
        module = importlib.import_module(f"validation.speed.peers.{name}")
        module.load()
        for contact, settings in module.SETTINGS.items():
            for setting in settings:
                result: dict[str, Any] = {"solver": module.NAME, "contact": contact, "setting": setting.name}
                jobs.append((module, setting, result | {"times": [], "clock": []}))
    for turn in range(ROUNDS):
        for module, setting, result in jobs:
            if sum(result["times"]) > LONG:
                continue
            began = time.perf_counter()
            curve = module.curve(result["contact"], setting)
            result["clock"].append(time.perf_counter() - began)
            result["times"].append(curve.seconds)
            if turn == 0:
                result["errors"] = errors(result["contact"], curve)
    results = [result | {key: statistics.median(result[of]) for key, of in (("seconds", "times"), ("wall", "clock"))}
               for _, _, result in jobs]  # fmt: skip
    return rows_of(results)


def error_of(result: Result) -> float:
    """Against the solver's own limit: Hertz, the rms of F/F_ref − 1; JKR, that of F over F_A, or of F_A itself."""
    found = result["errors"]
    if result["contact"] == "hertz":
        return float(found["limit_relative"])
    return max(float(found["limit_force"]), abs(float(found["limit_pull_off"])))


def quickest(results: Iterable[Result], key: str | None = None, most: float = ENOUGH) -> Result | None:
    """The quickest with an error of at most `most`, by `error_of` or by the error `key`; None: none."""
    good = [one for one in results if (error_of(one) if key is None else abs(one["errors"][key])) <= most]
    return min(good, key=lambda one: float(one["seconds"])) if good else None


def by_solver(results: Sequence[Result], solver: str, contact: str) -> list[Result]:
    """The settings of a solver."""
    return [one for one in results if (one["solver"], one["contact"]) == (solver, contact)]


def rows_of(results: Sequence[Result]) -> list[Row]:
    """Our time over that of each boundary-element code at equal error, and the whole run by the clock."""
    rows = []
    for contact, key, what in (
        ("hertz", "limit_force", "Hertz, rms error of 1 % of the largest force"),
        ("hertz", "limit_relative", "Hertz, rms error of 1 % of each force"),
        ("jkr", None, "adhesive, error of 1 % of the solver's own continuum limit"),
        ("jkr", "theory_force", "JKR, the same error with respect to the closed form"),
    ):
        for name in ELEMENTS:
            if peers := by_solver(results, name, contact):
                words, asked = f"CPU time of {OURS} over that of {name}: {what}", ASKED[what.split()[0].strip(",")]
                rows.append(_compared(words, by_solver(results, OURS, contact), peers, key, asked))
    hertz = quickest(by_solver(results, OURS, "hertz"), "limit_force")
    wall = math.nan if hertz is None else float(hertz["wall"])
    words = f"wall time of {OURS} [s]: Hertz's curve of 50 states, the whole run through Python"
    return [*rows, at_most(words, wall, WHOLE, "asked for", "–", "set bound")]


def _compared(words: str, mine: Sequence[Result], peers: Sequence[Result], key: str | None, asked: float) -> Row:
    """Times at equal error: of the peer's best, where it does not come as near as ENOUGH."""
    most = ENOUGH
    if key == "theory_force":
        most = max(BESIDE_JKR, min(abs(one["errors"][key]) for one in peers))
    theirs = quickest(peers, key, most)
    own = quickest(mine, key, most if theirs is None or key is None else max(ENOUGH, abs(theirs["errors"][key])))
    share = math.nan if own is None or theirs is None else own["seconds"] / theirs["seconds"]
    settings = "; ".join(f"{one['solver']} {one['setting']}, {one['seconds']:.3g} s" for one in (own, theirs) if one)
    return at_most(words, share, 1.0 / asked, "asked for", settings, "set bound")


PEERS = Study("peers", "Other people's solvers", "Who is quicker at equal error?", measure)
