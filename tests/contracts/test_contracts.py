"""Claim: whatever profile, law, experiment and method a scene puts together, six contracts and six checks hold.

Units: the same scene in other units has the same numbers. Refinement: with half the spacing every number stays within
both uncertainties. Reference: closed forms and solvers that share no code are within the uncertainty. Cap: it is no
wider than ten times the scatter over eight lattices, or the tolerance. Repeat: the deck gives the same curve.

A member of a registry enters by being there; `members` says what it lacks. A few combinations run at once, which have
every member at least twice; the whole product is slow.
"""

import math
import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from contact1d.workflow.engine.session import Engine
from tests.contracts.members import MODULUS, OTHERS, Combination, allowed, kind_of, sample, scene_of, unknown
from tests.contracts.references import expected
from tests.contracts.runs import Found, Runs

SAME = 1e-6
"""Relative, of a value and of its uncertainty in other units."""
MINIMISED, NOTHING = 0.05, 1e-11
"""Relative, of an uncertainty by residual forces, which are round-off; of a number that is 0, in model units."""
ROUND_OFF = 1e-8
"""Relative: uncertainties below that are left out of what is printed."""
WIDEST = 10.0
"""Uncertainty over the root mean square error over LATTICES."""
LATTICES = [0.93 + 0.02 * i for i in range(8)]
"""Spacings, of which no two have the edge at the same place between particles."""
SAID = ("plan", "pressure", "asked", "balance", "energy", "closed_form")
FORCED = (
    "load", "pull_off", "pull_off twice", "pull_off at a velocity", "tangential", "tangential cycles",
    "history of a force",
)  # fmt: skip
FORMULAS = ("parabola", "circle", "ellipsoid", "cone", "flat_punch", "power")
"""Profiles whose contact has a closed form in the program."""
KNOWN: dict[str, str] = {
    one: reason
    for reason, those in {
        "± depends on the units: points of a table are rounded as decimals": (
            "units table-friction-impact_obliquely-dynamic",
        ),
        "± is 4 to 20 times the errors": (
            "cap power-friction-tangential_cycles-quasistatic",
            "cap blunt_cone-friction-tangential_cycles-quasistatic",
            "cap truncated_cone-friction-tangential_cycles-quasistatic",
            "cap circle-prony-history_of_a_force-quasistatic",
        ),
        "± is too small by 3 to 8 %": (
            "reference cone-jkr-pull_off-dynamic",
            "reference cone-jkr-pull_off_twice-dynamic",
            "reference cone-kelvin_voigt-history-quasistatic",
            "reference power-prony-history-quasistatic",
        ),
        "the energy check allows 0.13 % of 0.22 %": ("circle-kelvin_voigt-history_of_a_force-quasistatic",),
        "± of a radius that the punch has is infinite in time": (
            "reference flat_punch-jkr-pull_off-dynamic",
            "reference flat_punch-jkr-pull_off_twice-dynamic",
        ),
    }.items()
    for one in those
}
"""Faults of the program that are known: a combination, or a contract of one, and why."""
STOPPED = {
    "flat_punch-neighbours-load-dynamic",
    *(
        f"cone-attracting_{law}-{kind}-quasistatic"
        for law in ("alike", "horizontal")
        for kind in ("load", "pull_off", "pull_off_twice")
    ),
}
"""What no particles can do: one under the tip of a cone is pushed through, one at the edge of a punch never rests."""

EVERY = [one for one in allowed() if str(one) not in STOPPED]
LONG = ("maugis", "rate", "kelvin_voigt")
"""Laws whose runs take longest."""
CHOSEN = sample([one for one in EVERY if one.profile != "table" or one.law not in LONG])
HEAVY = dict.fromkeys(("blunt_cone", "hyperboloid", "rounded_punch", "truncated_cone"), (*LONG, "attracting noise"))
"""Laws that are not quick, by profile."""


def cases(contract: str, applies: Callable[[Combination], Any], long: tuple[str, ...] = ()) -> Any:
    """All combinations to which a contract applies, but for the chosen ones and with `long` laws marked slow."""
    found = []
    for one in EVERY:
        if applies(one):
            quick = one in CHOSEN and one.law not in (*long, *HEAVY.get(one.profile, ()))
            marks: list[Any] = [pytest.mark.slow] * (not quick)
            if reason := KNOWN.get(f"{contract} {one}") or KNOWN.get(str(one)):
                marks.append(pytest.mark.xfail(strict=True, reason=reason))
            found.append(pytest.param(one, id=str(one), marks=marks))
    return pytest.mark.parametrize("one", found)


@pytest.fixture(scope="session")
def made(tmp_path_factory: pytest.TempPathFactory) -> Runs:
    return Runs(tmp_path_factory.mktemp("contracts"))


def finished(found: Found) -> Found:
    assert not found.failure, found.failure
    return found


def test_every_member_of_a_registry_is_in_a_scene() -> None:
    assert unknown() == []
    members = set().union(*(one.members for one in EVERY))
    for name in sorted(members):
        of_all = sum(name in one.members for one in EVERY)
        assert sum(name in one.members for one in CHOSEN) >= min(2, of_all) > 0, name


def applying(one: Combination) -> set[str]:
    """The checks that docs/results.md says a run has."""
    timed, statistics = one.method == "dynamic", "noise" in one.tables
    if statistics or one.experiment == "slide":
        return set()
    found = {"asked"} if one.experiment in FORCED else set()
    if one.law == "elastic" and one.experiment == "load" and not timed and one.profile in FORMULAS:
        found.add("closed_form")
    if not one.on_plane or "neighbours" in one.tables:
        return found | ({"balance"} if not timed else set())
    if scene_of(one).is_modelled:
        found |= {"plan", "energy"} if not timed else {"energy"} if kind_of(one.experiment) == "impact" else set()
    return found | ({"balance"} if kind_of(one.experiment) == "impact" else {"pressure"})


@cases("checks", lambda one: True)
def test_the_checks_are_there_and_hold(made: Runs, one: Combination) -> None:
    run = finished(made(one))
    found = run.consistency
    assert set(found) == set(SAID)
    for name, check in found.items():
        assert check is not None or name not in applying(one), name
        assert check is None or 0.0 <= check["difference"] <= check["allowed"], name
    assert run.done is not None
    missing = " ".join(text for name, text in run.done.warnings.items() if name.startswith("no_"))
    told = [*run.done.results, *re.findall(r"(\w+) \(", run.done.warnings.get("unknown", ""))]
    assert not [name for name in told if "_" in name and name in missing]
    outcome = run.done.outcome
    if outcome is not None and "critical" in outcome.marked and one.method == "quasistatic":
        least = min(state.force for state in outcome.states)
        assert outcome.marked["critical"].force <= (1.0 - run.done.scene.accuracy.tolerance) * least


@cases("units", lambda one: True, long=("rate", "attracting alike"))
def test_units_change_nothing(made: Runs, one: Combination) -> None:
    here = finished(made(one)).numbers
    names = sorted(OTHERS)
    name = names[EVERY.index(one) % len(names)]
    there = finished(made(one, OTHERS[name])).numbers
    assert here.keys() == there.keys()
    for key, (value, doubt) in here.items():
        other, told = there[key]
        least = ROUND_OFF * abs(value) + NOTHING
        assert abs(other - value) <= SAME * max(abs(value), doubt) + least, f"{key} in {name}"
        assert abs(told - doubt) <= (SAME if one.refines else MINIMISED) * doubt + 10.0 * least, f"± of {key} in {name}"


@cases("refinement", lambda one: one.refines, long=LONG[:2])
def test_half_the_spacing_stays_within_both(made: Runs, one: Combination) -> None:
    here, finer = (finished(made(each)).numbers for each in (one, replace(one, spacing=0.5 * one.spacing)))
    for name in here.keys() & finer.keys():
        (value, doubt), (other, less) = here[name], finer[name]
        assert abs(value - other) <= doubt + less + ROUND_OFF * abs(value), name


@cases("reference", expected)
def test_references_are_within_the_uncertainty(made: Runs, one: Combination) -> None:
    found, wanted = finished(made(one)).numbers, expected(one)
    for name, exact in wanted.items():
        assert (name in found) == math.isfinite(exact), name
        value, doubt = found.get(name, (exact, 0.0))
        assert value == exact or abs(value - exact) <= doubt + ROUND_OFF * (abs(exact) or MODULUS), name


def has_lattices(one: Combination) -> bool:
    """A punch has only those that it is a multiple of."""
    return one.refines and one.method == "quasistatic" and one.profile not in ("flat_punch", "capped_punch")


@cases("cap", has_lattices, long=(*LONG, "prony"))
def test_no_uncertainty_is_far_too_wide(made: Runs, one: Combination) -> None:
    """Of what is no reference's, the errors are those from the mean."""
    exact = replace(one, tolerance=1e-3)
    runs = [finished(made(replace(exact, spacing=spacing))).numbers for spacing in LATTICES]
    for name in set.intersection(*(set(each) for each in runs)):
        values, doubts = zip(*(each[name] for each in runs), strict=True)
        wanted = expected(one).get(name, math.fsum(values) / len(values))
        scatter = math.sqrt(math.fsum((value - wanted) ** 2 for value in values) / len(values))
        allowed_one = max(WIDEST * scatter, exact.tolerance * max(map(abs, values)), NOTHING)
        assert math.fsum(doubts) / len(doubts) <= allowed_one, name


@cases("repeat", lambda one: True)
def test_the_deck_repeats_the_run(made: Runs, one: Combination, tmp_path: Path) -> None:
    done = finished(made(one)).done
    assert done is not None
    for path in done.folder.iterdir():
        if path.name == "in.lammps" or path.suffix in (".data", ".table", ".cells", ".moves"):
            shutil.copy(path, tmp_path)
    with Engine.session(tmp_path) as session:
        session.execute("include in.lammps")
    assert (tmp_path / "curve.txt").read_bytes() == (done.folder / "curve.txt").read_bytes()
