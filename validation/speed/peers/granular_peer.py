"""LAMMPS `pair_style granular` (hertz/material, jkr): the pair law itself, no discretisation; one run of 50 steps.

Two spheres of radius 2R and modulus E = 2 E*, nu = 0, have the effective R and E*; its gamma is half of W. One of them
is moved by `fix move`, and F is printed at every step. It has F(d) and nothing under it: no pressure, no other shape.
Its contact ends at F_A, where a fixed load lets go, though the displacement is prescribed: points beyond are left out.
"""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

import numpy as np

from validation.speed.clock import spent
from validation.speed.peers.contacts import (
    CONTACT_MODULUS,
    POINTS,
    RADIUS,
    WORK_OF_ADHESION,
    Curve,
    Setting,
    closed_form,
    displacements,
)  # fmt: skip

NAME = "granular (pair law)"
SETTINGS = {"hertz": (Setting("hertz/material"),), "jkr": (Setting("jkr"),)}
HEAD = """
units lj
atom_style sphere
atom_modify map array
boundary f f f
newton off
comm_modify vel yes
region box block -{box} {box} -{box} {box} -{box} {box}
create_box 1 box
create_atoms 1 single 0 0 0
create_atoms 1 single 0 0 {apart!r}
set group all diameter {diameter!r} density 1
pair_style granular
pair_coeff * * {law} tangential linear_nohistory 0 0 damping velocity
neighbor 100.0 bin
group moved id 2
fix move moved move linear 0 0 {step!r}
timestep 1
variable force equal -fz[1]
thermo {points}
run 0
fix curve all print 1 "${{force}}" file force.txt screen no title ""
"""


def load() -> None:
    """Import the engine; LAMMPS is loaded by the worker of the first session."""
    import contact1d.workflow.engine.session  # noqa: F401 (loading it is the point)


def curve(contact: str, setting: Setting) -> Curve:
    """Return the curve; `seconds` is LAMMPS's own loop time, the rest of the session is start-up."""
    from validation.doors import Engine

    d = displacements(contact)
    modulus, energy = 2.0 * CONTACT_MODULUS, 0.5 * WORK_OF_ADHESION
    law = f"hertz/material {modulus!r} 0 0" if contact == "hertz" else f"jkr {modulus!r} 0 0 {energy!r}"
    text = HEAD.format(
        box=100_000, apart=4.0 * RADIUS - float(d[0]), diameter=4.0 * RADIUS, law=law, step=-float(d[1] - d[0]),
        points=POINTS,
    )  # fmt: skip
    began = spent()
    with tempfile.TemporaryDirectory() as name, Engine.session(Path(name)) as session:
        session.execute(text)
        session.execute(f"run {POINTS - 1}\nunfix curve")
        force = np.loadtxt(Path(name) / "force.txt", ndmin=1)
        session.execute("log none")
        loops = re.findall(r"Loop time of (\S+)", (Path(name) / "log.lammps").read_text())
    seconds = float(loops[-1])
    d, force = d[force != 0.0], force[force != 0.0]
    limit = closed_form(contact, d)
    return Curve(d, force, np.full(len(d), np.nan), seconds, spent() - began - seconds, limit)
