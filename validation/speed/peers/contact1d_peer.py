"""This program: `experiment path` through the Python API without figures, reduction mdr; LAMMPS, its rows apart."""

from __future__ import annotations

import tempfile
import time

from validation.speed.clock import spent
from validation.speed.peers.contacts import (
    A_0,
    CONTACT_MODULUS,
    RADIUS,
    WORK_OF_ADHESION,
    Curve,
    Setting,
    closed_form,
    displacements,
)  # fmt: skip

NAME = "contact1d"
SETTINGS = {
    "hertz": (
        Setting("a_0/3", 3, 1e-2), Setting("a_0/6", 6, 1e-2), Setting("a_0/12", 12, 1e-2),
        Setting("a_0/28", 28, 1e-2), Setting("a_0/60", 60, 1e-2),
    ),
    "jkr": (
        *(Setting(f"on the plane, a_0/{n}", n, 1e-2) for n in (5, 7, 10, 20, 40)),
    ),
}  # fmt: skip


def load() -> None:
    """Import the program; LAMMPS is loaded by the worker of the first run."""


def curve(contact: str, setting: Setting) -> Curve:
    """Return the curve of one run."""
    from contact1d import run
    from validation.doors import read_scene

    d = displacements(contact)
    began, clock = spent(), time.perf_counter()
    data = plane_tables(contact, setting)
    data["experiment"] = {"kind": "path", "displacements": [float(value) for value in d]}
    with tempfile.TemporaryDirectory() as folder:
        table = run(read_scene(data), folder, figures=False).curve
    seconds, wall = spent() - began, time.perf_counter() - clock
    return Curve(table.displacement, table.force, seconds, closed_form(contact, d), wall)


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
