"""Decks of the page "Try it" (docs/try.md): written and run natively when the site is built, then laid beside the page.

A contact of a ball, a cone or a flat punch is one contact up to scales, with F/F_A as the only number of its load. So
each deck has a path over all loads, in model units, and the page scales its states. `decks.json` has for each deck what
the page needs: modulus, size and work of adhesion of its scene, and the uncertainties that the program states.
"""

from __future__ import annotations

import json
import math
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from mkdocs.exceptions import PluginError

import contact1d
from contact1d.analysis.theory.indenters import Contact, PowerLaw

ENGINE = Path(__file__).parents[2] / ".npm" / "node_modules" / "lammps.js"
"""LAMMPS as WebAssembly, where `make docs` installs it."""
MODULUS = 1.0
"""E* [FU/LU²]; the spacing is 1 LU."""
RADIUS = 2000.0
"""Radius of the ball [LU]."""
SLOPE = 0.02
"""Slope of the cone."""
WIDEST = 80.0
"""Contact radius at the largest load, and that of the punch [LU]."""
LARGEST = 8.0
"""Largest force over the pull-off force."""
NEAREST = (-0.94, -0.97, -0.98)
"""Last forces over the pull-off force; the very last one has no state beyond it for a slope, and is not offered."""
STEPS = 72
"""Load steps of an adhesive contact, evenly in the force."""
PRESSED_STEPS = 24
"""Load steps of a contact without adhesion."""

PAPER = {
    "title": "Two chains, R = 1000",
    "bodies": {
        "particles": 120,
        "spacing": 1.0,
        "profile": {"kind": "parabola", "radius": 1000.0},
        "reduction": "geike_popov",
        "bulk_stiffness": 1.0,
    },
    "interaction": {
        "repulsion": {"amplitude": 0.174938, "range": 0.137615},
        "attraction": {"amplitude": 0.087469, "range": 0.275231},
    },
    "neighbours": {"stiffness": 0.3},
    "output": {"states": "all"},
    "experiment": {"kind": "path", "displacements": [round(0.4 - 0.1 * step, 1) for step in range(20)]},
}
"""The first row of Table 1 of Geike and Popov (2007), with a shorter path."""


def power_law(coefficient: float, exponent: float) -> PowerLaw:
    """Return the adhesive contact of a profile c rⁿ whose radius, ∝ W^(1/(2n − 1)), is `WIDEST` at the largest load."""
    unit = PowerLaw(coefficient, exponent, MODULUS, 1.0)
    widest = unit.contact_radius(LARGEST * unit.pull_off_force())
    return PowerLaw(coefficient, exponent, MODULUS, (WIDEST / widest) ** (2.0 * exponent - 1.0))


def scene_of(body: str, law: str) -> tuple[dict[str, Any], float]:
    """Return (the scene of a body under a law over all loads, its work of adhesion [FU/LU])."""
    profile: dict[str, Any]
    shares = np.append(np.linspace(LARGEST, -1.0, STEPS + 1)[:-1], NEAREST)
    if body == "punch":
        profile = {"kind": "flat_punch", "radius": WIDEST}
        work = 1e-3
        deepest = math.sqrt(2.0 * math.pi * work * WIDEST / MODULUS)
        loads = shares * deepest
    else:
        coefficient, exponent = (0.5 / RADIUS, 2.0) if body == "ball" else (SLOPE, 1.0)
        profile = {"kind": "parabola", "radius": RADIUS} if body == "ball" else {"kind": "cone", "slope": SLOPE}
        contact: Contact = power_law(coefficient, exponent)
        work, limit = contact.work_of_adhesion, contact.pull_off_force()
        loads = np.asarray([contact.displacement(contact.contact_radius(share * limit)) for share in shares])
        deepest = PowerLaw(coefficient, exponent, MODULUS, 0.0).displacement(WIDEST)
    if law == "pressed":
        loads, work = np.linspace(deepest / PRESSED_STEPS, deepest, PRESSED_STEPS), 0.0
    tables: dict[str, Any] = {
        "title": f"{body}, {law}",
        "bodies": {
            "particles": "auto", "spacing": 1.0, "reduction": "mdr", "lower": "rigid_plane", "profile": profile,
            "bulk_stiffness": MODULUS,
        },
        "output": {"states": "all"},
        "experiment": {"kind": "path", "displacements": [float(f"{load:.12g}") for load in loads]},
    }  # fmt: skip
    if work:
        tables["adhesion"] = {"work_of_adhesion": work}
    return tables, work


def write_deck(scene: dict[str, Any], folder: Path, run: contact1d.Run) -> dict[str, Any]:
    """Write the deck of a scene with the curve of its native run, and return what the page needs of the run.

    The uncertainties are those of each load step; that of the pressures is the largest that the run states.
    """
    contact1d.write_deck(scene, folder)
    files = sorted(path.name for path in folder.iterdir() if path.name != "scene.toml")
    lines = [line.split() for line in (run.folder / "curve.txt").read_text().splitlines()[1:]]
    shutil.copyfile(run.folder / "curve.txt", folder / "native.txt")
    curve, planned, kept = run.curve, np.asarray([float(line[1]) for line in lines]), []
    for displacement in curve.displacement:
        first = kept[-1] + 1 if kept else 0
        kept.append(first + int(np.argmin(np.abs(planned[first:] - displacement))))
    stated = [one.uncertainty for name, one in run.results.items() if name == "central_pressure"]
    return {
        "files": files,
        "kept": kept,
        "forceErrors": curve.force_uncertainty.tolist(),
        "radiusErrors": curve.contact_radius_uncertainty.tolist(),
        "pressureError": max(stated, default=0.0),
    }


def on_post_build(config: Any) -> None:
    """Lay lammps.js and the decks beside the page when mkdocs has built the site (a hook of mkdocs).

    Raises:
        PluginError: lammps.js is not installed.
    """
    if not ENGINE.exists():
        raise PluginError(f"there is no {ENGINE}: build the site with make docs, which installs it by npm")
    target = Path(config["site_dir"]) / "try"
    shutil.rmtree(target / "decks", ignore_errors=True)
    (target / "lammps").mkdir(parents=True, exist_ok=True)
    for file in (ENGINE / "dist" / "cpp" / "lammps.js", ENGINE / "LICENSE"):
        shutil.copyfile(file, target / "lammps" / file.name)
    decks = {}
    with tempfile.TemporaryDirectory() as runs:
        for name, scene, known in scenes():
            run = contact1d.run(scene, Path(runs) / name, figures=False)
            decks[name] = known | write_deck(scene, target / "decks" / name, run)
    (target / "decks" / "decks.json").write_text(json.dumps(decks))


def scenes() -> Iterator[tuple[str, dict[str, Any], dict[str, float]]]:
    """Yield (name of a deck, its scene, its modulus, size and work of adhesion in model units)."""
    sizes = {"ball": RADIUS, "cone": SLOPE, "punch": WIDEST}
    for body, size in sizes.items():
        for law in ("pressed", "jkr"):
            scene, work = scene_of(body, law)
            yield f"{body}_{law}", scene, {"modulus": MODULUS, "size": size, "work": work, "spacing": 1.0}
    yield "chains", PAPER, {"spacing": 1.0}
