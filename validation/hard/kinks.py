"""Kinks: bodies whose slope jumps up inside the contact, given as tables, and tables of bodies whose shape is known.

A worn tip is flat out to b and a cone beyond; under tension it parts where its edge has come back to b, for a whole
range of the work of adhesion, F_A = √(8πE*Wb³). At b the pressure has no bound. A table is points of a body: what it
gives is to be within its uncertainty of the body's, whatever the distance of the points and wherever the kink is
between them.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from validation.doors import Run
from validation.hard.plane_bodies import KINKED, kinked_body, sampled
from validation.hard.random_plane import NAMING, known, unsaid
from validation.references.axisymmetric import Body, Contact, with_rest_radius
from validation.row import Row, at_most
from validation.study import LONGEST, Bench, Findings, Refused, Study, over_claim

NAME, TABLES = "kinks", "tables"
SOURCE = "the MDR by quadrature of the body"
LAND, REACH, SLOPE = 10.0, 60.0, 0.02
"""b and where the table ends [LU], slope of the cone; E* = 1 FU/LU²."""
WORKS, FULL_WORKS = (5e-4,), (8e-4, 5e-4, 5e-5)
"""W of the worn tip [FU/LU]."""
COUNTS, FULL_COUNTS = (201, 1001), (201, 351, 1001, 4001)
"""Points of the table."""
PER_LAND, FULL_PER_LAND = (13.7, 55.5), (5.0, 8.3, 13.7, 21.0, 34.0, 55.5)
"""Spacings in b."""
INSIDE, FULL_INSIDE = (27.3,), (10.0, 27.3, 60.0)
"""Points from the axis to the kink."""
REFERENCE = 1e-8
"""Relative error of the quadratures."""
BALL, WORN, MODULUS, LENGTH = 0.01, 200e-6, 115e9, 1e-6
"""R and radius of the worn land [m], E* [Pa]; unit of length in the table [m]."""
PITCHES, FULL_PITCHES = (1.0, 2.0), (1.0, 2.0, 5.0, 8.7)
"""Distances of the points [µm]."""
LOADS = (50.0, 200.0)
"""[N]"""
ROUNDINGS = (None, 6, 5)
"""Digits of the largest height in a table of a paraboloid."""


def on_plane(profile: dict[str, Any], spacing: float, tolerance: float, work: float = 0.0) -> dict[str, Any]:
    """A scene of model units without its experiment, E* = 1 FU/LU²."""
    bodies = {"particles": "auto", "spacing": spacing, "bulk_stiffness": spacing, "reduction": "mdr",
              "lower": "rigid_plane", "profile": profile}  # fmt: skip
    tables: dict[str, Any] = {"bodies": bodies, "accuracy": {"tolerance": tolerance}}
    return tables | ({"adhesion": {"work_of_adhesion": work}} if work > 0.0 else {})


@dataclass
class Judged:
    """Numbers of several runs beside their references; four rows.

    Attributes:
        words: what the runs have in common.
        source: of the references.
    """

    words: str
    source: str = SOURCE
    off: dict[str, float] = field(default_factory=dict)
    quiet: list[str] = field(default_factory=list)
    wrong: list[str] = field(default_factory=list)
    failed: list[str] = field(default_factory=list)

    def add(self, label: str, run: Run | Refused, exact: dict[str, float], slack: float = REFERENCE) -> None:
        """Take in a run; a reference of inf: there must be no number; one of 0: the loss is known to be 0."""
        if isinstance(run, Refused):
            self.failed.append(f"{label}: {run.words[:LONGEST]}")
            return
        for name, value in exact.items():
            there = name in run.results
            if (math.isinf(value) and there) or (math.isfinite(value) and unsaid(run, name)):
                self.wrong.append(f"{label}: {name}")
            if math.isinf(value) or not there:
                continue
            self.off[f"{name}, {label}"] = over_claim(run, name, value, slack)
            if value and beyond(run, name, value) and not any(named(run, name)):
                self.quiet.append(f"{label}: {name}")

    def rows(self) -> list[Row]:
        """Errors over uncertainties; unnamed, missing or impossible numbers; refusals."""
        first = max(self.off, key=lambda name: self.off[name], default="–")
        found = [
            at_most(f"{self.words}: worst of {len(self.off)} errors over the uncertainty",
                    known(max(self.off.values(), default=math.nan)), 1.0, self.source, first),
            at_most(f"{self.words}: numbers beyond the tolerance that no warning names", len(self.quiet), 0.0,
                    self.source, ", ".join(self.quiet)[:LONGEST] or "–"),
            at_most(f"{self.words}: numbers without a bound that are reported, or missing without a word",
                    len(self.wrong), 0.0, self.source, ", ".join(self.wrong)[:LONGEST] or "–"),
        ]  # fmt: skip
        refused = at_most(
            f"{self.words}: scenes refused", len(self.failed), 0.0, self.source, "".join(self.failed[:1]) or "–"
        )
        return [*found[not self.off :], refused]


def named(run: Run, name: str) -> list[str]:
    """The warnings that name a number with its uncertainty."""
    return [one for one in NAMING if re.search(rf"\b{name}\b", run.warnings.get(one, ""))]


def beyond(run: Run, name: str, exact: float) -> bool:
    """Whether a number is, or may be, off by more than the tolerance."""
    tolerance, one = run.scene.accuracy.tolerance, run.results[name]
    wide = one.uncertainty > (1.0 + 1e-6) * tolerance * abs(one.value)
    return bool(wide or abs(one.value - exact) > tolerance * abs(exact))


def worn_tip() -> Body:
    """Flat to LAND, then a cone."""
    return Body(lambda r: SLOPE if r >= LAND else 0.0, lambda _: 0.0, (LAND,), (SLOPE,))


def measure(bench: Bench) -> Findings:
    """Pull-offs and loads of the worn tip, and of each other shape with a kink."""
    return Findings([*_worn_tips(bench), *_shapes(bench)])


def _worn_tips(bench: Bench) -> list[Row]:
    """At several distances of the points and of the particles."""
    body, a, rows = worn_tip(), 1.7 * LAND, list[Row]()
    load = {"kind": "load", "force": Contact(body).force(a)}
    for count in FULL_COUNTS if bench.full else COUNTS:
        profile = sampled(body, REACH / (count - 1), REACH, None)
        loads = Judged(f"worn tip of {count} points, load")
        spacings = FULL_PER_LAND if bench.full else PER_LAND
        for share in spacings:
            free = on_plane(profile, LAND / share, 1e-3) | {"experiment": load}
            loads.add(f"spacing b/{share:g}", bench.run(f"tip_load_{count}_{share:g}", free), pressed(body, a))
        rows += loads.rows()
        for work in FULL_WORKS if bench.full else WORKS:
            exact, pulls = marks(Contact(body, 1.0, work), LAND), Judged(f"worn tip of {count} points, W = {work:g}")
            pull = {"kind": "pull_off", "preload": 2.0 * exact["adhesion_force"]}
            for share in spacings:
                held = on_plane(profile, LAND / share, 1e-3, work) | {"experiment": pull}
                run = bench.run(f"tip_{count}_{work:g}_{share:g}", held)
                pulls.add(f"spacing b/{share:g}", run, exact | {"peak_pressure": math.inf})
            rows += pulls.rows()
    return rows


def _shapes(bench: Bench) -> list[Row]:
    """Other bodies with kinks, the kink at a point of the table or between two."""
    rng, rows, a = np.random.default_rng(11), list[Row](), 2.0 * LAND
    for kind in KINKED[1:]:
        body = kinked_body(kind, LAND, SLOPE, rng)
        held = with_rest_radius(body, 1.0, 1.4 * LAND)
        exact = marks(held, LAND)
        pulls, loads = (Judged(f"{kind}, {words}") for words in ("pull-off", "load"))
        for inside in FULL_INSIDE if bench.full else INSIDE:
            profile, label = sampled(body, LAND / inside, REACH, None), f"{inside:g} points to the kink"
            pull = {"kind": "pull_off", "preload": 2.0 * exact["adhesion_force"]}
            scene = on_plane(profile, LAND / 17.0, 1e-3, held.work) | {"experiment": pull}
            pulls.add(label, bench.run(f"{kind}_{inside:g}", scene), exact)
            load = {"kind": "load", "force": Contact(body).force(a)}
            free = on_plane(profile, LAND / 17.0, 1e-3) | {"experiment": load}
            loads.add(label, bench.run(f"{kind}_load_{inside:g}", free), pressed(body, a))
        rows += [*pulls.rows(), *loads.rows()]
    return rows


def marks(contact: Contact, guess: float) -> dict[str, float]:
    """What a pull-off has."""
    critical, rest = contact.critical(guess), contact.pressed_radius(0.0, guess)
    return {
        "adhesion_force": -contact.force(critical),
        "critical_radius": critical,
        "zero_load_radius": rest,
        "work_of_separation": contact.energy(contact.fixed_grips(guess)) - contact.energy(rest),
    }


def pressed(body: Body, a: float) -> dict[str, float]:
    """What a load without adhesion has."""
    contact = Contact(body)
    force = contact.force(a)
    found = {"displacement": contact.displacement(a), "contact_radius": a, "mean_pressure": force / (math.pi * a * a)}
    middle, peak = contact.central_pressure(a), contact.peak_pressure(a)
    found |= {"peak_pressure": peak} if math.isinf(peak) else {}
    return found | ({"central_pressure": middle} if math.isfinite(middle) else {"central_pressure": math.inf})


def measure_tables(bench: Bench) -> Findings:
    """Worn balls in SI at several distances of the points, and paraboloids with few digits."""
    rows: list[Row] = []
    land, end = WORN / LENGTH, BALL / LENGTH
    worn = Body(lambda r: r / end if r >= land else 0.0, lambda r: float(r >= land) / end, (land,), (land / end,))
    contact, force_unit = Contact(worn), MODULUS * LENGTH**2
    for pitch in FULL_PITCHES if bench.full else PITCHES:
        table, judged = sampled(worn, pitch, 3.0 * land, None), Judged(f"worn ball, points every {pitch:g} µm")
        profile = {"kind": "table", **{key: [f"{value!r} µm" for value in table[key]] for key in ("r", "z")}}
        for newtons in LOADS:
            bodies = {"particles": "auto", "spacing": "auto", "reduction": "mdr", "lower": "rigid_plane",
                      "profile": profile}  # fmt: skip
            scene = {"bodies": bodies, "material": {"contact_modulus": f"{MODULUS!r} Pa"},
                     "experiment": {"kind": "load", "force": f"{newtons!r} N"}}  # fmt: skip
            a = contact.pressed_radius(newtons / force_unit, land)
            exact = {"displacement": contact.displacement(a) * LENGTH, "contact_radius": a * LENGTH}
            judged.add(f"{newtons:g} N", bench.run(f"worn_{pitch:g}_{newtons:g}", scene), exact)
        rows += judged.rows()
    body = Body(lambda r: r / 1000.0, lambda _: 1e-3)
    held = with_rest_radius(body, 1.0, 20.0)
    for digits in ROUNDINGS:
        judged = Judged(f"paraboloid of 61 points with {digits or 'all'} digits")
        profile = sampled(body, 1.0, 60.0, digits)
        load = on_plane(profile, 0.5, 1e-3) | {"experiment": {"kind": "load", "force": Contact(body).force(20.0)}}
        judged.add("load", bench.run(f"rounded_{digits}", load), pressed(body, 20.0))
        pull = on_plane(profile, 0.5, 1e-3, held.work) | {"experiment": {"kind": "pull_off", "preload": 1.0}}
        judged.add("pull-off", bench.run(f"rounded_pull_{digits}", pull), marks(held, 20.0))
        rows += judged.rows()
    return Findings(rows)


_KINKS = Study(
    NAME,
    "Slopes that jump inside the contact",
    "At a kink every lattice has the force maximum at the same corner, and the pressure has no bound. Are numbers "
    "within their uncertainties, and is there none for what is infinite?",
    measure,
)
_TABLES = Study(
    TABLES,
    "Tables of known bodies",
    "A table has the body at its points only, with some digits. Are displacement, radius and pull-off within their "
    "uncertainties of the body's own?",
    measure_tables,
)

CLASSES = (_KINKS, _TABLES)
