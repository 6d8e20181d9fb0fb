"""Times near the fold of F(d): how long a contact settles just below F_A, and how long it takes to part just above it.

Pairs follow the plate at once where it is slow. A pair of the distance r has s = dr/dG = 1/(1 − 2f′(r)/k), its upper
particle moves at (1 + s)/2 of the plate's velocity and its lower one at (1 − s)/2, so that plate and particles move as
    (M + m Σ(1 + s²)/2) d″ + (c + γ Σ(1 + s²)/2) d′ = W − F(d) − m Σ s s′ d′²/2
under the load W. Near the fold both times go as |1 − W/F_A|^(−1/2).
"""

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from validation.doors import Settings, UnderLoad, contact_of
from validation.hard.cases import ATTRACTION, LAW, PairCase, reach, shaped
from validation.references.folded_pairs import FoldedPairs
from validation.references.interaction import Floats
from validation.row import Reference, Row, at_most, relative
from validation.study import Bench, Lines, Study

RATIO, PARTICLES, TOLERANCE = 0.5, 41, 1e-5
SHARES, FULL_SHARES = (1e-2, 1e-3, 1e-4), (1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5)
"""|1 − W/F_A|"""
START = 0.9
"""Tension over F_A that the contact is held at before."""
LEFT = 0.1
"""Distance from where it comes to rest, over that from there to the fold, at which a contact counts as settled."""
DRAG = 0.05
"""Of a particle over √(k m): so little that particles follow at once; the plate has what is needed, √(k m) for each."""
PARTED = 0.5
"""Range of the attraction beyond the fold at which a contact counts as parted."""
TIMES = 0.005
"""Relative: the reduced motion leaves out that particles lag behind; at 1e-5 what the table adds to F_A."""
EXPONENT = 0.03
"""The next term of the fold, at 1e-3."""
NEAR = 1e-3
"""From which share down the exponent is read off."""
LOOKS = 300
SOURCE = "motion of plate and pairs in closed form, by scipy"


def measure(bench: Bench) -> Lines:
    """Both times at each share against the reduced motion, and their exponents."""
    case = PairCase("settling", RATIO, shaped("parabola", PARTICLES, reach(RATIO)), PARTICLES, 0.0, TOLERANCE, True)
    each = math.sqrt(case.stiffness)
    scene = case.scene() | {"damping": {"coefficient": DRAG * each}, "plate": {"damping": PARTICLES * each}}
    pairs, shares = case.pairs, np.array(FULL_SHARES if bench.full else SHARES)
    largest, fold = pairs.adhesion(0.0)
    near, begin = shares <= NEAR, _place(pairs, -START * largest, fold)
    for words, sign in (("settle", -1.0), ("part", 1.0)):
        found = []
        for share in shares.tolist():
            load = -largest * (1.0 + sign * share)
            end = fold - PARTED * ATTRACTION[1]
            if sign < 0.0:
                rest = _place(pairs, load, fold)
                end = rest + LEFT * (rest - fold)
            timed = scene | {"experiment": {"kind": "load", "force": load}}
            with contact_of(timed, bench.folder / f"{words}_{share:g}") as contact:
                settings = contact.settings
                expected = reduced_time(pairs, settings, contact.scene.bodies.mass, load, begin, end)
                stride = max(1, round(expected / settings.motion.time_step / LOOKS))
                slow = round(20.0 * settings.motion.settle_time / settings.motion.time_step)
                contact.begin("held")
                contact.row(UnderLoad(0.0, slow))
                last = contact.row(UnderLoad(-START * largest, 2 * slow)).displacement
                contact.begin("released")
                taken = 0.0
                for i in range(2 * LOOKS):
                    place = contact.row(UnderLoad(load, stride)).displacement
                    if place <= end:
                        taken = (i + (last - end) / (last - place)) * stride * settings.motion.time_step
                        break
                    last = place
            found.append(taken)
            yield Row(f"time to {words} under (1 {'+−'[sign < 0]} {share:g}) F_A", taken, Reference(expected, SOURCE),
                      relative(TIMES, "particles that lag behind; the table's share of F_A"), unit="TU")  # fmt: skip
        slope = np.polyfit(np.log(shares[near]), np.log(np.maximum(found, 1e-300)[near]), 1)[0]
        name = f"exponent of the time to {words} over |1 − W/F_A|, from −1/2"
        source, limit = "the fold: inverse square root", "next term of the fold"
        yield at_most(name, abs(slope + 0.5), EXPONENT, source, limit)


def _place(pairs: FoldedPairs, load: float, fold: float) -> float:
    return float(brentq(lambda d: pairs.loading(d) - load, fold, 0.05, xtol=1e-15))


def reduced_time(pairs: FoldedPairs, settings: Settings, mass: float, load: float, begin: float, end: float) -> float:
    """Time [TU] that the plate needs from rest at `begin` to `end` [LU] under `load` [FU]; pairs that do not snap."""
    places = np.linspace(end - 0.1 * abs(begin - end), begin + 0.1 * abs(begin - end), 4001)
    force, moved = pairs.loading(places), _moved(pairs, places)
    net = CubicSpline(places, load - force)
    inertia = CubicSpline(places, settings.motion.plate_mass + mass * moved)
    drag = CubicSpline(places, settings.motion.plate_damping + settings.motion.damping * moved)
    slope = inertia.derivative()

    def motion(_: float, y: Floats) -> list[float]:
        d, v = y
        return [v, float((net(d) - drag(d) * v - 0.5 * slope(d) * v * v) / inertia(d))]

    def there(_: float, y: Floats) -> float:
        return float(y[0] - end)

    there.terminal = True  # type: ignore[attr-defined]  # scipy reads it off the function
    found = solve_ivp(motion, (0.0, 1e9), [begin, 0.0], "LSODA", events=there, rtol=1e-8, atol=1e-12)
    return float(found.t[-1])


def _moved(pairs: FoldedPairs, places: Floats) -> Floats:
    """Σ (1 + s²)/2 over the pairs at each displacement."""
    gap = LAW.force_free_distance() + pairs.heights[None, :] - places[:, None]
    r = pairs.distance(gap, np.zeros(gap.shape, dtype=bool))
    s = 1.0 / (1.0 - 2.0 * LAW.force_slope(r) / pairs.bulk_stiffness)
    return np.asarray(np.sum(0.5 * (1.0 + s**2), axis=1))


SETTLING = Study(
    "settling",
    "Relaxation times just below and just above F_A",
    "Under loads close to F_A, the time to equilibrium below it and the time to separation above it scale with the "
    "inverse square root of the distance from F_A; a run that stops too early confuses the two.",
    measure,
)
