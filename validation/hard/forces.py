"""Forces of a whole deck against its energy: f = −∂U/∂x, by central differences of LAMMPS's own energy."""

from __future__ import annotations

from typing import Any

import numpy as np

from validation.doors import Contact, Displace, contact_of
from validation.hard.cases import BODIES, PAPER_LAW
from validation.references.interaction import Floats
from validation.row import at_most
from validation.study import Bench, Findings, Study

STEP = 1e-4
"""h of the differences [LU]: h²/range² = 6e-7 of a force."""
ALLOWED, EXACT = 1e-4, 1e-6
"""Of the largest force: with a table the tolerance of the scene, which its law may be off by; else the differences."""
PATH: dict[str, Any] = {"kind": "path", "displacements": [0.02]}
PARTICLES: dict[str, Any] = {
    "bodies": BODIES,
    "interaction": PAPER_LAW,
    "experiment": PATH,
    "accuracy": {"tolerance": 1e-4},
}
SHEARED = BODIES | {"bulk_stiffness_tangential": 0.6}
DECKS: dict[str, dict[str, Any]] = {
    "interaction": PARTICLES,
    "interaction and neighbours": PARTICLES | {"neighbours": {"stiffness": 0.3}},
    "interaction, neighbours, horizontal": PARTICLES | {"neighbours": {"stiffness": 0.3}, "horizontal": {}},
    "all of them, and another tangential stiffness": PARTICLES
    | {"neighbours": {"stiffness": 0.3}, "horizontal": {}, "bodies": SHEARED},
    "rigid plane and neighbours": {
        "bodies": BODIES | {"lower": "rigid_plane"},
        "neighbours": {"stiffness": 0.3},
        "experiment": {"kind": "path", "displacements": [0.3]},
    },
}


def measure(bench: Bench) -> Findings:
    """Every particle of each deck in each free direction, and the plate."""
    checks = []
    for words, tables in DECKS.items():
        with contact_of(tables, bench.folder / words.replace(" ", "_").replace(",", "")) as contact:
            contact.begin("loading")
            contact.row(Displace(contact.scene.experiment.places()[0]), trusted=False)
            _stir(contact)
            force, slope, plate = _forces(contact)
        scale = float(np.max(np.abs(force)))
        off = float(np.max(np.abs(force - slope))) / scale
        source = "−∂U/∂x by central differences"
        allowed = ALLOWED if "interaction" in tables else EXACT
        checks.append(
            at_most(
                f"force on a particle off over the largest, worst of {force.size}, {words}",
                off,
                allowed,
                source,
                "table: the tolerance asked for; else step of the differences",
            )
        )
        checks.append(
            at_most(
                f"force on the plate off over the largest, {words}",
                abs(plate[0] - plate[1]) / scale,
                EXACT,
                source,
                "step of the differences; rounding of the energy",
            )
        )
    return Findings(checks)


def _stir(contact: Contact) -> None:
    """Leave the equilibrium, where all forces are 0, by moves of a few hundredths."""
    session, count = contact.session, contact.settings.chains.upper
    bodies = 1 if contact.scene.bodies.lower == "rigid_plane" else 2
    random = np.random.default_rng(7)
    lines = []
    free = contact.scene.horizontal is not None
    for i in range(1, bodies * count + 1):
        dx, dz = random.uniform(-0.03, 0.03, 2)
        lines.append(f"group probe id {i}\ndisplace_atoms probe move {dx if free else 0.0} 0 {dz} units box\n")
        lines.append("group probe delete\n")
    session.execute("".join(lines) + "run 0 post no\n", phase="stirring")


def _forces(contact: Contact) -> tuple[Floats, Floats, tuple[float, float]]:
    """Forces and minus the slopes of the energy on every particle and direction, and the same of the plate along z."""
    session, scene = contact.session, contact.scene
    plane = scene.bodies.lower == "rigid_plane"
    count = contact.settings.chains.upper * (1 if plane else 2)
    energy = ("pe", "f_rigid_plane_wall") if plane else ("pe",)
    session.execute("thermo_style custom step pe\nthermo_modify norm no\nrun 0 post no\n")  # in this order
    reading = session.measure("", ("f_quasistatic_plate[3]",), ("f",))
    axes = (0, 2) if scene.horizontal is not None else (2,)
    force = reading.atoms["f"][:count][:, list(axes)]

    def slope(group: str, axis: int) -> float:
        move = ["0", "0", "0"]
        values = []
        for way in (STEP, -2.0 * STEP):
            move[axis] = repr(way)
            text = f"displace_atoms {group} move {' '.join(move)} units box\nrun 0 post no\n"
            values.append(sum(session.measure(text, energy).values))
        move[axis] = repr(STEP)
        session.execute(f"displace_atoms {group} move {' '.join(move)} units box\nrun 0 post no\n")
        return -(values[0] - values[1]) / (2.0 * STEP)

    slopes = np.empty_like(force)
    for i in range(count):
        session.execute(f"group probe id {i + 1}\n")
        slopes[i] = [slope("probe", axis) for axis in axes]
        session.execute("group probe delete\n")
    return force.ravel(), slopes.ravel(), (reading.values[0], slope("plate", 2))


FORCES = Study(
    "forces",
    "Forces of a whole deck",
    "Fragments that are correct alone may be wrong together: a wrong bond type, an excluded pair, a wrong anchor. Is "
    "the force on every particle of a complete deck the negative gradient of its energy?",
    measure,
)
