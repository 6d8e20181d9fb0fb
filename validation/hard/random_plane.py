"""Random scenes on the rigid plane of every profile: also tables with kinks, adhesive loops, small cycles with slip.

python -m validation.hard.random_plane SEED COUNT FOLDER      a summary, and FOLDER/found.json
"""

from __future__ import annotations

import json
import math
import re
import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from validation.doors import Run, read_run
from validation.hard.plane_bodies import Scene
from validation.hard.plane_draws import Drawn, scene_of
from validation.row import Row, at_most
from validation.study import Bench, Findings, Refused, Study

NAME = "random_plane"
SEED, QUICK, FULL = 20261201, 25, 500
"""The date as the seed."""
DIMENSIONS = {
    "displacement": "L", "contact_radius": "L", "largest_radius": "L", "critical_radius": "L", "zero_load_radius": "L",
    "stick_radius": "L", "cohesive_radius": "L", "fixed_grips_displacement": "L", "adhesion_force": "F",
    "largest_force": "F", "tangential_force": "F", "mean_pressure": "P", "central_pressure": "P", "peak_pressure": "P",
    "contact_stiffness": "S", "adhesion_energy": "E", "dissipated_energy": "E", "dissipated_energy_per_cycle": "E",
    "instability_energy": "E", "work_of_separation": "E", "tabor_parameter": "1", "peak_displacement": "L",
    "unloading_stiffness": "S", "creep_corrected_stiffness": "S", "preload": "F", "normal_force": "F",
    "peak_force": "F", "force": "F", "relaxation": "F", "contact_time": "T", "restitution": "1",
    "peak_contact_radius": "L",
}  # fmt: skip
NAMING, GONE = (
    ("lattice", "tolerance", "kink", "input"),
    ("unknown", "no_peak", "no_zero_load", "no_radius", "no_energy"),
)
"""Warnings that give the relative uncertainty of each number they name; those that say that there is none."""
POINTS = (0.0, 0.3, 0.7, 1.0)
"""Of the radii of a pressure, which are compared."""
INSIDE, FARTHEST = 0.98, 3.0
FOLLOWS = {
    "critical_radius": ("adhesion_force",),
    "work_of_separation": ("adhesion_force", "zero_load_radius"),
    "adhesion_energy": ("zero_load_radius",),
    "fixed_grips_displacement": ("adhesion_force",),
}
"""Numbers that go where another one is not reported."""
OPTIONAL = ("peak_pressure", "central_pressure")
"""Numbers that narrow contacts do not have, as documented."""
SOURCE = "the MDR by quadrature of the body"


@dataclass(frozen=True)
class Number:
    """One number of one scene.

    Attributes:
        over: |value − reference| over the uncertainty; inf where a number stands for one that is infinite.
        far: |value − reference| over |reference| and the tolerance.
        wide: uncertainty over |value| and the tolerance.
        named: whether a warning names it.
    """

    scene: str
    group: str
    words: str
    name: str
    value: float
    uncertainty: float
    reference: float
    over: float
    far: float
    wide: float
    named: bool


@dataclass
class Found:
    """What came of the scenes."""

    numbers: list[Number] = field(default_factory=list)
    absent: dict[str, list[str]] = field(default_factory=dict)
    silent: dict[str, list[str]] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    unjudged: Counter[str] = field(default_factory=Counter)
    scenes: Counter[str] = field(default_factory=Counter)


def judge(found: Found, name: str, one: Drawn, run: Run | Refused) -> None:
    """Take in what a run has of the scene's numbers."""
    found.scenes[one.group] += 1
    if isinstance(run, Refused):
        found.refused[name] = f"{one.words}: {run.words}"
        return
    scene = f"{name} ({one.words})"
    warnings = run.warnings
    results = run.document
    found.unjudged.update(set(run.results) - set(one.exact))
    judge_pressures(found, name, one, run)
    judge_forces(found, name, one, run)
    for quantity, reference in one.exact.items():
        scale = 1.0
        entry = results.get(quantity)
        if one.in_si:
            by_force = quantity == "relaxation" and "force" in one.scene["experiment"]  # of a length, then
            scale = one.scales["L" if by_force else DIMENSIONS[quantity]]
            entry = entry and (entry.get("si") or entry)
        if entry is None or entry["value"] is None:
            if math.isfinite(reference):
                kept = found.silent if unsaid(run, quantity) else found.absent
                kept.setdefault(quantity, []).append(scene)
            continue
        value, uncertainty = entry["value"] / scale, entry["uncertainty"] / scale
        named = any(re.search(rf"\b{quantity}\b", warnings.get(w, "")) for w in NAMING)
        found.numbers.append(number_of(name, one, quantity, value, uncertainty, float(reference), named))


def number_of(
    name: str, one: Drawn, quantity: str, value: float, uncertainty: float, reference: float, named: bool
) -> Number:
    """A number beside its reference."""
    slack = one.pressure_error if quantity.startswith("p(r)") or quantity.endswith("pressure") else one.reference_error
    tolerance = one.scene["accuracy"]["tolerance"]
    if math.isinf(reference):
        over = far = math.inf
    else:
        whole = abs(reference)
        if quantity == "dissipated_energy":  # the difference of two works
            whole = max(whole, one.exact.get("peak_force", 0.0) * one.exact.get("peak_displacement", 0.0))
        error = max(0.0, abs(value - reference) - slack * whole)
        over = error / uncertainty if uncertainty > 0.0 else (0.0 if error == 0.0 else math.inf)
        far = error / abs(reference) / tolerance if reference else 0.0
    wide = uncertainty / (abs(value) * tolerance) if value and reference else 0.0
    return Number(name, one.group, one.words, quantity, value, uncertainty, reference, over, far, wide, named)


def judge_forces(found: Found, name: str, one: Drawn, run: Run) -> None:
    """F of every load step; without a column of its ± that is 0."""
    if one.force is None:
        return
    columns = read_run(run.folder).curve if one.in_si else run.curve
    length, force = (one.scales["L"], one.scales["F"]) if one.in_si else (1.0, 1.0)
    errors = columns["force_uncertainty"] if "force_uncertainty" in columns else 0.0 * columns["force"]
    for d, value, error in zip(columns["displacement"], columns["force"], errors, strict=True):
        n = number_of(name, one, "F of a load step", float(value) / force, float(error) / force,
                      one.force(float(d) / length), named=True)  # fmt: skip
        found.numbers.append(n)


def judge_pressures(found: Found, name: str, one: Drawn, run: Run) -> None:
    """Some points of p(r) of each state that has one; it must have a ± of its own."""
    columns = (read_run(run.folder) if one.in_si else run).body_pressures
    length, stress = (one.scales["L"], one.scales["P"]) if one.in_si and one.pressures else (1.0, 1.0)
    for state, pressure in one.pressures.items():
        quantity = f"p(r) {state}"
        if state not in columns:
            found.absent.setdefault(quantity, []).append(name)
            continue
        radii, values, errors = (columns[state][key] for key in ("r", "pressure", "pressure_uncertainty"))
        scale = abs(pressure(0.5 * float(radii[-1]) / length))
        for i in sorted({round(part * (radii.size - 1)) for part in POINTS}):
            reference = float(pressure(float(radii[i]) / length))
            if math.isfinite(reference):
                # Where a pressure crosses 0, its reference is as exact as it is in the middle.
                slack = max(0.0, scale - abs(reference)) * one.pressure_error
                value, error = float(values[i]) / stress, float(errors[i]) / stress + slack
                found.numbers.append(number_of(name, one, quantity, value, error, reference, named=True))


def run_of(bench: Bench, name: str, scene: Scene) -> Run | Refused:
    """A run; one that ends in an error that is not for the user is refused, too."""
    try:
        return bench.run(name, scene)
    except Exception as error:
        return Refused(f"ended by {type(error).__name__}: {error}", before=False)


def unsaid(run: Run, name: str) -> bool:
    """Whether a number is missing that neither the documentation nor a warning lets go."""
    names = name, *FOLLOWS.get(name, ())
    told = any(re.search(rf"\b{one}\b", run.warnings.get(gone, "")) for gone in GONE for one in names)
    return name not in run.results and name not in OPTIONAL and not told


def conducted(bench: Bench, seed: int, count: int, tell: Callable[[str], None] = lambda _: None) -> Found:
    """`count` scenes of a seed, those left out that have no single edge."""
    found, number, made = Found(), 0, 0
    while made < count:
        one = scene_of(seed, number)
        if one is not None:
            name = f"plane_{seed}_{number}"
            judge(found, name, one, bench.run(name, one.scene))
            made += 1
            if made % 25 == 0:
                tell(f"{made} scenes, {len(found.numbers)} numbers, {len(outside(found))} outside")
        number += 1
    return found


def outside(found: Found) -> list[Number]:
    """Numbers that are off by more than their uncertainty."""
    return sorted((n for n in found.numbers if not n.over <= 1.0), key=lambda n: -n.over)


def unnamed(found: Found) -> list[Number]:
    """Numbers that are, or may be, beyond the tolerance, and that no warning names."""
    return [n for n in found.numbers if (n.wide > 1.0 + 1e-6 or n.far > 1.0) and not n.named]


def known(value: float) -> float:
    """NaN, which fails, in place of inf, which no record can hold."""
    return value if math.isfinite(value) else math.nan


def rows(found: Found, seed: int, source: str = SOURCE) -> list[Row]:
    """Shares inside, the farthest, those beyond the tolerance without a name, those gone without a word, refusals."""
    count, off, quiet = len(found.numbers), outside(found), unnamed(found)
    groups = ", ".join(f"{n} {group}" for group, n in sorted(found.scenes.items()))
    first = f"{off[0].name} of {off[0].scene}, {off[0].over:.3g} uncertainties off" if off else "–"
    lost = sum(map(len, found.silent.values()))
    total = max(1, sum(found.scenes.values()))
    return [
        at_most(f"share of {count} numbers of scenes of seed {seed} ({groups}) outside of their uncertainty",
                len(off) / max(1, count), 1.0 - INSIDE, source, first),
        at_most("largest error over the uncertainty", known(off[0].over) if off else 1.0, FARTHEST, source, first),
        at_most("numbers beyond the tolerance that no warning names", len(quiet), 0.0, source,
                ", ".join(f"{n.name} of {n.scene}" for n in quiet[:3]) or "–"),
        at_most("numbers that are missing without a warning", lost, 0.0, source,
                ", ".join(found.silent) or "–"),
        at_most("share of scenes refused", len(found.refused) / total, 1.0 - INSIDE, "what is asked: 98 % must run",
                next(iter(found.refused.values()), "–"), "set bound"),
    ]  # fmt: skip


def measure(bench: Bench) -> Findings:
    """Rows of the random scenes."""
    return Findings(rows(conducted(bench, SEED, FULL if bench.full else QUICK), SEED))


RANDOM_PLANE = Study(
    NAME,
    "Random scenes on the rigid plane, with kinks and loops",
    "Are all numbers within their uncertainties, and those beyond the tolerance named, where a slope jumps inside the "
    "contact, where a table stands for a body, along coarse loops with jumps, and in small cycles with slip?",
    measure,
)


def main(conducted: Callable[[Bench, int, int, Callable[[str], None]], Found] = conducted) -> None:
    """`SEED COUNT FOLDER`: run, print a summary, and write all numbers."""
    seed, count, folder = int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    found = conducted(Bench(folder, folder), seed, count, lambda text: print(text, flush=True))
    (folder / "found.json").write_text(
        json.dumps(vars(found) | {"numbers": [vars(n) for n in found.numbers]}, indent=1), encoding="utf-8"
    )
    off, quiet = outside(found), unnamed(found)
    print(f"{len(found.numbers)} numbers of {sum(found.scenes.values())} scenes {dict(found.scenes)}; "
          f"{len(off)} outside ({100.0 * len(off) / max(1, len(found.numbers)):.2f} %), {len(quiet)} unnamed, "
          f"refused {len(found.refused)}")  # fmt: skip
    for title, listed in (("OUTSIDE", off), ("UNNAMED", quiet)):
        print(title)
        for n in listed:
            number = f"{n.scene} [{n.words}] {n.name}: {n.value:.9g} ± {n.uncertainty:.2g}, reference {n.reference:.9g}"
            print(f"  {number}; {n.over:.3g} u, {n.far:.3g} tol, u/tol {n.wide:.3g}, named {n.named}")
    for title, table in (("not reported, named", found.absent), ("MISSING WITHOUT A WORD", found.silent)):
        print(title, {name: len(scenes) for name, scenes in table.items()})
    for name, scenes in found.silent.items():
        print("  ", name, scenes[:6])
    for name, why in found.refused.items():
        print("REFUSED", name, why[:220])


if __name__ == "__main__":
    main()
