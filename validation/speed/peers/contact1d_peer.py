"""This program: `experiment path` through the Python API without figures, reduction mdr; LAMMPS, its rows apart."""

from __future__ import annotations

import math
import tempfile
import time
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from validation.speed.clock import spent
from validation.speed.peers.contacts import (
    A_0,
    CHAIN_WAY,
    CONTACT_MODULUS,
    RADIUS,
    WORK_OF_ADHESION,
    Array,
    Curve,
    Setting,
    closed_form,
    displacements,
)  # fmt: skip

if TYPE_CHECKING:
    from validation.doors import Scene
    from validation.references.interaction import PairInteraction

NAME = "contact1d"
SETTINGS = {
    "hertz": (
        Setting("a_0/3", 3, 1e-2), Setting("a_0/6", 6, 1e-2), Setting("a_0/12", 12, 1e-2),
        Setting("a_0/28", 28, 1e-2), Setting("a_0/60", 60, 1e-2),
    ),
    "jkr": (
        *(Setting(f"on the plane, a_0/{n}", n, 1e-2) for n in (5, 7, 10, 20, 40)),
        Setting("a_0/8, tolerance 0.01", 8, 1e-2), Setting("a_0/12, tolerance 0.01", 12, 1e-2),
        Setting("a_0/28, tolerance 0.01", 28, 1e-2), Setting("a_0/28, tolerance 0.001", 28, 1e-3),
    ),
}  # fmt: skip
PLANE = "on the plane"
"""Settings of an adhesive contact that are JKR's own, in place of a law with a range."""
PA, NEWTON, METRE = 1e12, 1e-6, 1e-9
"""µN/nm², µN and nm in SI."""
ROWS = 12
"""Opposite particles to either side that the limit counts."""


def load() -> None:
    """Import the program; LAMMPS is loaded by the worker of the first run."""


def curve(contact: str, setting: Setting) -> Curve:
    """Return the curve of one run."""
    from contact1d import run
    from validation.doors import scene_from_dict

    on_plane = contact == "hertz" or setting.name.startswith(PLANE)
    d = displacements(contact) if on_plane else displacements(contact, CHAIN_WAY)
    began = spent()
    scene, unit, force_unit = (None, 1.0, 1.0) if on_plane else identified(setting)
    start_up = spent() - began
    began, clock = spent(), time.perf_counter()
    data = plane_tables(contact, setting) if scene is None else scene.model_dump(by_alias=True, exclude_none=True)
    data["experiment"] = {"kind": "path", "displacements": [float(value) for value in d / unit]}
    with tempfile.TemporaryDirectory() as folder:
        finished = run(scene_from_dict(data), folder, figures=False)
        columns = np.genfromtxt(finished.folder / "curve.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    seconds, wall = spent() - began, time.perf_counter() - clock
    limit = closed_form(contact, d) if scene is None else own_limit(scene, unit, force_unit, d)
    parts = {"wall": wall} | {name: finished.document["timing"][f"{name}_s"] for name in ("lammps", "rows")}
    return Curve(
        columns["displacement"] * unit, columns["force"] * force_unit, columns["contact_radius"] * unit, seconds,
        start_up, limit, parts,
    )  # fmt: skip


def plane_tables(contact: str, setting: Setting) -> dict[str, object]:
    """The scene of a chain on a rigid plane, in nm and µN; with [adhesion] it is JKR itself."""
    spacing = A_0 / setting.grid
    bodies = {
        "particles": "auto", "spacing": spacing, "profile": {"kind": "parabola", "radius": RADIUS}, "reduction": "mdr",
        "bulk_stiffness": CONTACT_MODULUS * spacing, "lower": "rigid_plane",
    }  # fmt: skip
    adhesion = {"adhesion": {"work_of_adhesion": WORK_OF_ADHESION}} if contact == "jkr" else {}
    tables: dict[str, object] = {"title": "beside other solvers", "bodies": bodies}
    return tables | adhesion | {"accuracy": {"tolerance": setting.tolerance}}


@lru_cache(maxsize=16)
def identified(setting: Setting) -> tuple[Scene, float, float]:
    """Return the scene with which independent pairs have JKR's F_A and a_0, LU [nm] and FU [µN]."""
    from validation.doors import estimated, jkr_target, material_scene

    modulus, energy = CONTACT_MODULUS * PA, 0.5 * WORK_OF_ADHESION * NEWTON / METRE
    unit = A_0 / setting.grid
    target = jkr_target(modulus, energy, RADIUS * METRE)
    scene, wanted = material_scene(modulus, RADIUS * METRE, target, unit * METRE, setting.tolerance or 1e-3)
    assert scene.material is not None
    assert scene.material.force_unit is not None
    return estimated(scene, wanted), unit, scene.material.force_unit / NEWTON


def pair_law(scene: Scene) -> PairInteraction:
    """Return the scene's law as the references write it."""
    from validation.references.interaction import Exponential, PairInteraction

    assert scene.interaction is not None
    assert scene.interaction.attraction is not None
    terms = scene.interaction.repulsion, scene.interaction.attraction
    near, far = (Exponential(term.amplitude, term.range) for term in terms)
    return PairInteraction(near, far)


def own_limit(scene: Scene, unit: float, force_unit: float, displacement: Array) -> tuple[Array, Array]:
    """Return F [µN] and a [nm] of many aligned pairs, each of which feels the whole opposite row.

    As `references.independent_pairs`, with the force of a row, sum_j f(rho_j) r/rho_j, rho_j² = r² + (j s)²,
    in place of one opposite particle's: the ranges are not short against the spacing. G = r - 2 f/k, F = (2/s) int f dx
    over G = G_0 + x²/2R_1, R_1 = R/2, the parabola x²/R of the mdr. The opposite row counts as level, which the runs
    bear out within 2e-4 of F_A.
    """
    law, stiffness, spacing = pair_law(scene), scene.bulk_stiffness, scene.bodies.spacing
    r = np.linspace(0.05, 40.0, 8000) ** 2 * law.longest_range / 16.0
    rho = np.hypot(r[:, None], spacing * np.arange(-ROWS, ROWS + 1))
    row = (law.force(rho) * r[:, None] / rho).sum(axis=1)
    gap = r - 2.0 * row / stiffness
    rising = int(np.argmin(gap))  # below it the pair is pushed through its core
    gap, row = gap[rising:], row[rising:]
    if (np.diff(gap) <= 0.0).any():
        raise ValueError("pairs snap: the limit has no single curve")
    radius, widest = 0.5 * RADIUS / unit, gap[int(np.argmin(row))]
    x = np.linspace(0.0, 3.0 * A_0 / unit, 4000)
    force, edge = [], []
    for d in displacement / unit:
        apex = law.force_free_distance() - d
        places = np.interp(apex + x**2 / (2.0 * radius), gap, row, right=0.0)
        force.append(2.0 / spacing * np.trapezoid(places, x))
        edge.append(math.sqrt(2.0 * radius * max(widest - apex, 0.0)))
    return np.array(force) * force_unit, np.array(edge) * unit
