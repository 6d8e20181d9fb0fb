"""Fits of force curves whose approach and retraction differ: is that named, and are both values right?

Elastomers close with a smaller work of adhesion than they open with: both segments are JKR's, of one E*. Bodies that
relax follow Lee, Radok and Ting. Curves are closed forms or quadratures with white noise; a curve that is refused
counts as not covered.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from validation.hard.fits import covers, lines_of
from validation.references.force_curves import Sphere, measured
from validation.references.relaxing import Indentation, Legs, Material, sphere
from validation.row import at_least
from validation.study import Bench, Lines, Study

MODULUS, CLOSING, RADIUS, NOISE = 2e6, 0.04, 1e-5, 2e-9
"""E* [Pa], W on approach [J/m²], R [m], standard deviation of the noise [N]."""
OPENINGS = (0.041, 0.043, 0.05, 0.065, 0.08)
"""W on retraction [J/m²]."""
SOFTNESS = (1e3, 10.0, 3.0, 1.0)
"""Stiffness of the cantilever over E*a₀ at W = 50 mJ/m²; the first one is nearly rigid."""
CURVES, FULL_CURVES = 1, 20
RELAXING, FULL_RELAXING = 3, 50
E, W = "material.contact_modulus", "adhesion.work_of_adhesion"
SHARE, TIME = (f"viscoelasticity.terms[0].{name}" for name in ("share", "time"))
SOURCE = "the parameters that the curves were made with"
BASE = {"bodies": {"profile": {"kind": "parabola", "radius": f"{RADIUS} m"}}, "material": {"contact_modulus": "1 MPa"}}


def fitted(lines: Sequence[str], folder: Path, **plan: Any) -> Iterator[dict[str, str]]:
    """The lines of fits.csv of a map of curves."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "map.csv").write_text("\n".join([*lines, ""]), encoding="utf-8")
    return lines_of({"data": str(folder / "map.csv"), **plan}, folder)


def hysteresis(bench: Bench, softness: float, count: int) -> Iterator[tuple[float, dict[str, str]]]:
    """Yield W on retraction and the line of its fit, for curves of all openings and two steps of positions."""
    stiffness = softness * MODULUS * Sphere(MODULUS, 0.05, RADIUS).zero_load_radius
    lines, openings = ["curve,segment,z [nm],F [nN]"], list[float]()
    for opening in OPENINGS:
        for seed in range(count):
            z = np.arange(-1.5e-6, 1.5e-6, (2e-9, 8e-9)[seed % 2])
            up, down = (measured(Sphere(MODULUS, work, RADIUS), "JKR", stiffness, z) for work in (CLOSING, opening))
            F = np.concatenate([up[: z.size], down[z.size :]])
            F += NOISE * np.random.default_rng(seed).standard_normal(F.size)
            cells = zip(np.repeat(["approach", "retract"], z.size), [*z, *z[::-1]], F, strict=True)
            lines += [f"{len(openings)},{word},{1e9 * x:.3f},{1e9 * y:.3f}" for word, x, y in cells]
            openings.append(opening)
    plan: dict[str, Any] = {"base": BASE | {"adhesion": {"work_of_adhesion": "30 mJ/m²"}}, "parameters": [E, W]}
    plan["instrument"] = {"stiffness": f"{stiffness} N/m"}
    yield from zip(openings, fitted(lines, bench.folder / f"{softness:g}", **plan), strict=True)


def relaxing(bench: Bench, count: int) -> Iterator[tuple[float, dict[str, str]]]:
    """Yield the share of the term and the line of its fit, for curves of bodies that relax, of random terms."""
    lines, shares, t = ["curve,t [s],d [nm],F [nN]"], [], np.linspace(0.0, 2.0, 300)
    legs = Legs(((0.0, -5e-7), (1.0, 1e-6), (2.0, -5e-7)))
    d = [legs(float(x)) for x in t]
    for seed in range(count):
        draw = np.random.default_rng(seed)
        share, time = float(draw.uniform(0.2, 0.8)), float(10.0 ** draw.uniform(-1.0, 1.0))
        contact = Indentation(sphere(RADIUS), Material(((share, time),), MODULUS), legs)
        F = np.array([contact.force(float(x)) for x in t])
        F += 10.0 ** draw.uniform(-2.5, -1.5) * F.max() * draw.standard_normal(t.size)
        lines += [f"{seed},{x:.6f},{1e9 * y:.4f},{1e9 * z:.4f}" for x, y, z in zip(t, d, F, strict=True)]
        shares.append(share)
    base = BASE | {"viscoelasticity": {"terms": [{"share": 0.4, "time": "0.5 s"}]}}
    plan = fitted(lines, bench.folder / "relaxing", base=base, parameters=[E, SHARE, TIME])
    yield from zip(shares, plan, strict=True)


def measure(bench: Bench) -> Lines:
    """Rows of hysteresis by the stiffness of the cantilever, and of bodies that relax."""
    for softness in SOFTNESS:
        table = list(hysteresis(bench, softness, FULL_CURVES if bench.full else CURVES))
        named, inside = [], []
        for opening, row in table:
            named.append(W in row.get("hysteresis", ""))
            held = covers(row, f"{W}_approach", CLOSING) and covers(row, f"{W}_retract", opening)
            inside += [held] if opening > OPENINGS[0] else []
        words = f"cantilever of {softness:g} E*a0: share of"
        yield at_least(f"{words} {len(named)} curves whose hysteresis is named", float(np.mean(named)), 0.98, SOURCE)
        yield at_least(f"{words} {len(inside)} curves with both W inside", float(np.mean(inside)), 0.9, SOURCE)
    table = list(relaxing(bench, FULL_RELAXING if bench.full else RELAXING))
    inside = [covers(row, E, MODULUS) and covers(row, SHARE, share) for share, row in table]
    words = f"share of {len(inside)} relaxing bodies with instantaneous modulus and share inside"
    yield at_least(words, float(np.mean(inside)), 0.9, SOURCE)


SEGMENTS = Study(
    "segments",
    "Force curves whose segments differ",
    "Is it named where a contact closes and opens with different works of adhesion, are both inside their 95 % "
    "intervals, and are modulus and term of a body that relaxes?",
    measure,
)
