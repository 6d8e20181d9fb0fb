"""This program: `experiment path` through the Python API without figures, reduction mdr; LAMMPS, its rows apart."""

import tempfile

from validation.doors import on_plane
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
    "hertz": tuple(Setting(f"a_0/{n}", n, 1e-2) for n in (3, 6, 12, 28, 60)),
    "jkr": tuple(Setting(f"on the plane, a_0/{n}", n, 1e-2) for n in (5, 7, 10, 20, 40)),
}


def load() -> None:
    """Import the program; LAMMPS is loaded by the worker of the first run."""


def curve(contact: str, setting: Setting) -> Curve:
    """Return the curve of one run."""
    from contact1d import run
    from validation.doors import read_scene

    d = displacements(contact)
    began = spent()
    data = plane_tables(contact, setting) | {"experiment": {"kind": "path", "displacements": d.tolist()}}
    with tempfile.TemporaryDirectory() as folder:
        table = run(read_scene(data), folder, figures=False).curve
    return Curve(table.displacement, table.force, spent() - began, closed_form(contact, d))


def plane_tables(contact: str, setting: Setting) -> dict[str, object]:
    """The scene of a chain on a rigid plane, in nm and µN; with [adhesion] it is JKR itself."""
    tables = on_plane({"kind": "parabola", "radius": RADIUS}, A_0 / setting.grid, setting.tolerance)
    tables["bodies"]["bulk_stiffness"] *= CONTACT_MODULUS
    adhesion = {"adhesion": {"work_of_adhesion": WORK_OF_ADHESION}} if contact == "jkr" else {}
    return {"title": "beside other solvers", **tables, **adhesion}
