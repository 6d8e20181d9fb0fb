"""Paths of few steps: closed loops of an adhesive contact, and cycles with slip that are small against the sliding one.

An adhesive loop loses −E(a_in) where the bodies touch, at d = 0, and E(a_fg) where they part under fixed grips. Steps
that are as wide as the loop see these jumps at their ends alone, or not at all. A cycle along x of a small amplitude
slips in an annulus that may be narrower than a spacing. In both a 0 is no answer: a loss is stated with what it may be
off by, or is named as not known.
"""

from __future__ import annotations

from itertools import product
from typing import Any

from validation.hard.kinks import Judged, on_plane
from validation.references.axisymmetric import Body, Contact, Slipping, lost_on_path, with_rest_radius
from validation.row import Row, at_most
from validation.study import LONGEST, Bench, Findings, Refused, Study

NAME = "coarse_paths"
RADIUS, SLOPE = 10.0, 0.01
"""a₀ and the slope there of every contact [LU]; E* = 1 FU/LU²."""
SHAPES = {
    "cone": ({"kind": "cone", "slope": SLOPE}, Body(lambda _: SLOPE, lambda _: 0.0)),
    "parabola": (
        {"kind": "parabola", "radius": RADIUS / SLOPE},
        Body(lambda r: r * SLOPE / RADIUS, lambda _: SLOPE / RADIUS),
    ),
    "power": (
        {"kind": "power", "exponent": 3.0, "radius": RADIUS, "height": SLOPE * RADIUS / 3.0},
        Body(lambda r: SLOPE * (r / RADIUS) ** 2, lambda r: 2.0 * SLOPE * r / RADIUS**2),
    ),
}
STEPS, FULL_STEPS = (1, 3, 12), (1, 2, 3, 4, 6, 9, 14, 25, 60)
TURNS, FULL_TURNS = (0.5, 1.3), (0.5, 0.95, 1.05, 1.3, 3.0)
"""The farthest displacement apart over that of fixed grips: below 1 the contact is held."""
LOADS = (2.0, 50.0)
"""Compression at the other end over F_A: beside the work of a large one the loss is small."""
SPACING, TOLERANCE = 0.7, 1e-3
AMPLITUDES, FULL_AMPLITUDES = (0.003, 0.1, 0.7), (1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 0.7, 0.99, 1.2)
"""Of a cycle over the displacement of full sliding."""
FRICTION, RATIO = 0.3, 0.85
SOURCE = "the energies of the jumps by quadrature"


def measure(bench: Bench) -> Findings:
    """Loops of every shape, and cycles."""
    rows: list[Row] = []
    shapes = SHAPES if bench.full else {name: SHAPES[name] for name in ("cone", "parabola")}
    for (name, (profile, body)), turn in product(shapes.items(), FULL_TURNS if bench.full else TURNS):
        contact = with_rest_radius(body, 1.0, RADIUS)
        for words, start, load in product(("out", "in"), ("approach", "contact"), LOADS):
            rows += _loops(bench, f"{name}_{turn:g}_{start}_{words}_{load:g}", profile, contact, turn, load)
    for name, (profile, body) in shapes.items():
        judged = Judged(f"{name}, cycles with slip")
        for amplitude in FULL_AMPLITUDES if bench.full else AMPLITUDES:
            _cycle(bench, judged, f"{name}_cycle_{amplitude:g}", profile, body, amplitude)
        rows += judged.rows()
    return Findings(rows)


def _loops(bench: Bench, name: str, profile: dict[str, Any], contact: Contact, turn: float, load: float) -> list[Row]:
    """Out of the contact and back, or in and out, in different numbers of steps; one row more for losses of 0."""
    shape, _, start, words, _ = name.split("_")
    limit = contact.displacement(contact.fixed_grips(RADIUS))
    deep = contact.displacement(contact.pressed_radius(-load * contact.force(contact.critical(RADIUS)), RADIUS))
    first, last = (deep, turn * limit) if words == "out" else (turn * limit, deep)
    common = f"{shape}, {words} to {turn:g} of fixed grips from {start}, {load:g} F_A"
    judged, none = Judged(common, SOURCE), []
    for steps in FULL_STEPS if bench.full else STEPS:
        there = [first + (last - first) * i / steps for i in range(steps + 1)]
        lost, jumps, held, holds = lost_on_path(contact, there + there[-2::-1], start, RADIUS)
        way = {"from": first, "to": last, "steps": steps, "return": True}
        experiment = {"kind": "path", "displacements": way} | ({"start": start} if start == "contact" else {})
        run = bench.run(
            f"{name}_{steps}", on_plane(profile, SPACING, TOLERANCE, contact.work) | {"experiment": experiment}
        )
        quantity = "dissipated_energy" if held == holds else "instability_energy"
        judged.add(f"{steps} steps", run, {quantity: lost} if jumps or held == holds else {})
        one = None if isinstance(run, Refused) else run.results.get(quantity)
        if jumps and one is not None and abs(one.value) <= one.uncertainty:
            none.append(f"{steps} steps: {one.value:.2g} ± {one.uncertainty:.2g}")
    words = f"{common}: losses reported as less than their uncertainty"
    return [*judged.rows(), at_most(words, len(none), 0.0, SOURCE, ", ".join(none)[:LONGEST] or "–")]


def _cycle(bench: Bench, judged: Judged, name: str, profile: dict[str, Any], body: Body, share: float) -> None:
    """Two cycles of an amplitude over u*."""
    slipping = Slipping(Contact(body), RADIUS, FRICTION, RATIO)
    amplitude = share * slipping.sliding
    loss, stick = slipping.loss(amplitude), slipping.stick(amplitude)
    scene = on_plane(profile, SPACING, TOLERANCE)
    scene["bodies"]["bulk_stiffness_tangential"] = RATIO * SPACING
    cycles = {"amplitude": amplitude, "number": 2, "points": 16}
    experiment = {"kind": "tangential", "normal_force": slipping.contact.force(RADIUS), "cycles": cycles}
    scene |= {"friction": {"coefficient": FRICTION}, "experiment": experiment}
    exact = {
        "dissipated_energy": 9.0 * loss,
        "dissipated_energy_per_cycle": 4.0 * loss,
        "tangential_force": slipping.force(amplitude),
    }
    judged.add(f"{share:g} u*", bench.run(name, scene), exact | ({"stick_radius": stick} if stick > 0.0 else {}))


COARSE_PATHS = Study(
    NAME,
    "Paths of few steps and cycles of small amplitude",
    "Steps as wide as the loop, or a slip narrower than the spacing, see no loss at all. Is what is lost within its "
    "uncertainty, or named as not known?",
    measure,
)
