"""Runs of Section 2: spheres and other shapes pressed on a rigid plane, what they measure, and what the lattice costs.

U = Σ f²/2k, with the forces f of the particles. By Euler and Maclaurin a sum over springs h apart is off from the
integral by derivatives at the edge, times polynomials of the place of the edge between two particles. Of a parabola
    F: (3/2) B₂ (h/a)²,  |B₂| ≤ 1/6        U: (5/2) B₃ (h/a)³ + (15/8) B₄ (h/a)⁴,  |B₃| ≤ √3/36, |B₄| ≤ 1/30
and F of any profile g(x): h² B₂ c [g′(a) + g′(0)], with the layer's stiffness c = F′(a)/2a g′(a).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from validation.doors import Reduction, Run, Scene, scene_from_dict
from validation.references import hertz
from validation.study import Scenes, found

MODULUS = 210e9
"""Young's modulus of both bodies [Pa]."""
LENGTH_UNIT, FORCE_UNIT = 1e-9, 1e-6
BASE = {"d": 1.0, "R": 1000.0, "nu": 0.3, "h": 0.25}
"""Displacement, radius, spacing in LU; Poisson's ratio of both bodies."""
SWEEPS = {
    "d": (0.1, 0.3, 1.0, 3.0, 10.0),
    "R": (100.0, 300.0, 1000.0, 3000.0, 10000.0),
    "nu": (0.0, 0.3, 0.49),
    "h": (1.0, 0.5, 0.25, 0.125, 0.0625),
}
WORDS = {
    "d": "displacement from 0.1 to 10 LU",
    "R": "radius from 100 to 10000 LU",
    "nu": "Poisson's ratio from 0 to 0.49",
    "h": "spacing from 0.0625 to 1 LU",
}
EDGE, RATE_SPACINGS = 32.0, (8.0, 4.0, 2.0, 1.0)
"""Half-width of the contact [LU] in the runs that measure the rate, a whole number of each spacing in them [LU]."""
RATE_TOLERANCE, SPARE = 1e-7, 4
"""Of those runs, so that what the minimiser leaves is below the fourth power of the spacing; particles beyond."""
REDUCTIONS: tuple[Reduction, ...] = ("geike_popov", "mdr")
SLOPE, EXPONENT, PUNCH, DEPTH = 0.05, 4.0, 20.0, 3.0
"""Of the other shapes; lengths in LU."""


def reduction_scene(reduction: Reduction, d: float, R: float, nu: float, h: float, tolerance: float = 1e-3) -> Scene:
    """A sphere of two equal materials pressed by d [LU]; R the sphere's radius, h the spacing [LU]."""
    body = {"youngs_modulus": MODULUS, "poisson_ratio": nu}
    return scene_from_dict(
        {
            "title": f"{reduction}: d = {d:g}, R = {R:g}, nu = {nu:g}, h = {h:g}",
            "bodies": {
                "particles": "auto",
                "spacing": h,
                "profile": {"kind": "parabola", "radius": R},
                "reduction": reduction,
                "bulk_stiffness": "auto",
                "lower": "rigid_plane",
            },
            "material": {"upper": body, "lower": body, "length_unit": LENGTH_UNIT, "force_unit": FORCE_UNIT},
            "accuracy": {"tolerance": tolerance},
            "experiment": {"kind": "path", "displacements": [d]},
        }
    )


def shape_scene(kind: str, reduction: Reduction = "mdr") -> Scene:
    """One of the profile kinds, pressed into a plane."""
    profiles = {
        "circle": {"kind": "circle", "radius": 200.0},
        "cone": {"kind": "cone", "slope": SLOPE},
        "flat_punch": {"kind": "flat_punch", "radius": PUNCH},
        "power": {"kind": "power", "exponent": EXPONENT, "radius": 40.0, "height": 2.0},
        "table": {"kind": "table", "r": [float(r) for r in range(81)], "z": [2.0 * (r / 40.0) ** 4 for r in range(81)]},
    }
    sphere = reduction_scene(reduction, DEPTH, 1.0, BASE["nu"], BASE["h"])
    base = sphere.model_dump(by_alias=True, exclude_none=True)
    base["title"] = f"{reduction}: {kind}"
    base["bodies"]["profile"] = profiles[kind]
    if reduction == "geike_popov":  # refused with a material: a shape as drawn is no body's
        del base["material"]
        base["bodies"]["bulk_stiffness"] = sphere.bulk_stiffness
    return scene_from_dict(base)


SHAPES = ("circle", "cone", "flat_punch", "power", "table")


@dataclass(frozen=True)
class Case:
    """One run of a sweep: name of the run, reduction, and its values."""

    name: str
    reduction: Reduction
    values: dict[str, float]
    tolerance: float = 1e-3
    particles: int | None = None

    def scene(self) -> Scene:
        """What is run."""
        scene = reduction_scene(self.reduction, **self.values, tolerance=self.tolerance)
        return scene if self.particles is None else scene.with_({"bodies.particles": self.particles})

    @property
    def force(self) -> float:
        """F in 3D [N]."""
        R, modulus = self.sphere()
        return float(hertz.hertz_force(self.values["d"] * LENGTH_UNIT, R, modulus))

    @property
    def energy(self) -> float:
        """U in 3D [J]: Eq. (1) for two equal spheres, (8/15) E* √(R d⁵) with the effective R and E*."""
        R, modulus = self.sphere()
        return 8.0 / 15.0 * modulus * math.sqrt(R * (self.values["d"] * LENGTH_UNIT) ** 5)

    @property
    def half_width(self) -> float:
        """a of the springs [LU]: √(2Rd) as drawn, √(Rd) transformed."""
        return math.sqrt((2.0 if self.reduction == "geike_popov" else 1.0) * self.values["R"] * self.values["d"])

    def off(self, what: str) -> float:
        """Most by which the lattice lets "force" or "energy" be off, relative."""
        fineness = self.values["h"] / self.half_width
        if what == "force":
            return 0.25 * fineness**2
        return 2.5 * math.sqrt(3.0) / 36.0 * fineness**3 + fineness**4 / 16.0

    def sphere(self) -> tuple[float, float]:
        """Effective radius [m] and contact modulus [Pa]: R/2 and G/(1 − ν) for two equal spheres."""
        radius = self.values["R"] * LENGTH_UNIT * (0.5 if self.reduction == "geike_popov" else 1.0)
        return radius, MODULUS / (2.0 * (1.0 - self.values["nu"] ** 2))


def sweep(reduction: Reduction, name: str) -> list[Case]:
    """The runs in which one value changes."""
    cases = [BASE | {name: value} for value in SWEEPS[name]]
    return [Case(f"eq3_{reduction}_{_label(values)}", reduction, values) for values in cases]


def rate_cases(reduction: Reduction) -> list[Case]:
    """Runs of falling spacing whose contact ends midway between two of these very particles, at the half-width EDGE."""
    depth = EDGE**2 / BASE["R"] * (0.5 if reduction == "geike_popov" else 1.0)
    cases = [BASE | {"d": depth, "h": h} for h in RATE_SPACINGS]
    return [
        Case(f"eq3_{reduction}_rate_{_label(v)}", reduction, v, RATE_TOLERANCE, 2 * round(EDGE / v["h"]) + SPARE)
        for v in cases
    ]


def _label(values: dict[str, float]) -> str:
    return "_".join(f"{name}{value:g}" for name, value in values.items())


def _cases() -> Iterable[Case]:
    for reduction in REDUCTIONS:
        for name in SWEEPS:
            yield from sweep(reduction, name)
        yield from rate_cases(reduction)


def scenes(_: Scene) -> Scenes:
    """All runs."""
    shapes = {f"eq3_shape_{kind}": shape_scene(kind) for kind in SHAPES}
    drawn = {"eq3_shape_cone_as_drawn": shape_scene("cone", "geike_popov")}
    return {case.name: case.scene() for case in _cases()} | shapes | drawn


def ratio(case: Case, run: Run, what: str) -> tuple[float, float]:
    """The run's "force" or "energy" over the sphere's, and its claim."""
    force = run.document["largest_force"]["si"]
    claim = float(force["uncertainty"] / force["value"])
    if what == "force":
        return float(force["value"]) / case.force, claim
    return energy(case, run) / case.energy, 2.0 * claim


def energy(case: Case, run: Run) -> float:
    """U = Σ f²/2k [J]."""
    scene = case.scene()
    forces = run.profiles["deepest"].pressure * scene.bodies.spacing
    return float(np.sum(forces**2)) / (2.0 * scene.bulk_stiffness) * LENGTH_UNIT * FORCE_UNIT


def claimed(run: Run, quantity: str) -> float:
    """Relative uncertainty of a result."""
    one = found(run, quantity)
    return one.uncertainty / one.value
