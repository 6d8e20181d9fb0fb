"""What a written deck says: variables of in.lammps, atoms and masses of system.data, the claims of the table."""

import os
import re
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from contact1d import write_deck

LMP = Path(sys.executable).with_name("lmp")
LOWER, UPPER, LOWER_ANCHORS, ANCHORS, LOWER_FAR, FAR, DRIVER = range(1, 8)
"""Atom types: particles and their anchors."""


def lmp(folder: Path) -> str:
    """What `cd folder && lmp -in in.lammps` prints; UCX_TLS leaves no network listener open."""
    environment = os.environ | {"UCX_TLS": "self,sm", "OMP_NUM_THREADS": "1"}
    command = [str(LMP), "-in", "in.lammps"]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout[-2000:]
    return done.stdout


@dataclass(frozen=True)
class Written:
    """The files of a deck, by name."""

    files: Mapping[str, str]

    @property
    def text(self) -> str:
        """in.lammps."""
        return self.files["in.lammps"]

    @cached_property
    def commands(self) -> str:
        """in.lammps without its comments."""
        return "\n".join(line for line in self.text.splitlines() if not line.startswith("#"))

    def numbers(self, name: str) -> list[float]:
        """All values that a LAMMPS variable is given, in order."""
        found = re.findall(rf"^variable +{name} index (.+)$", self.text.replace("&\n", " "), re.MULTILINE)
        return [float(word) for line in found for word in re.findall(r"[^\s,\[\]]+", line)]

    def number(self, name: str) -> float:
        """The only value of a variable."""
        (value,) = self.numbers(name)
        return value

    @cached_property
    def atoms(self) -> dict[int, Any]:
        """Places [LU], (n, 3), by type."""
        style, _, rows = self.files["system.data"].partition("\nAtoms # ")[2].partition("\n\n")
        table = np.array([row.split() for row in rows.partition("\n\n")[0].splitlines()], dtype=float)
        kinds = table[:, 2 if style == "bond" else 1]
        return {int(kind): table[kinds == kind, -3:] for kind in np.unique(kinds)}

    @cached_property
    def masses(self) -> dict[int, float]:
        """By type [MU]."""
        rows = self.files["system.data"].partition("Masses\n\n")[2].partition("\n\n")[0]
        return {int(row.split()[0]): float(row.split()[1]) for row in rows.splitlines()}

    @cached_property
    def box(self) -> Any:
        """Lower and upper corner, (2, 3) [LU]."""
        found = re.findall(r"^(\S+) (\S+) [xyz]lo", self.files["system.data"], re.MULTILINE)
        return np.array(found, dtype=float).T

    @property
    def plate_mass(self) -> float:
        """Of all anchors of the upper body [MU]."""
        return self.masses[ANCHORS] * len(self.atoms[ANCHORS])

    def claimed(self, words: str) -> float:
        """The number that stands in these words of the table's header, {} in its place."""
        found = re.search(re.escape(words).replace(r"\{\}", r"(\S+)"), self.files["interaction.table"])
        assert found is not None
        return float(found[1])

    def after(self, *commands: str) -> list[Any]:
        """Of every atom by its id: type, place and force, (n, 7), after each of these commands that follow the head.

        `lmp` runs them, in this order.
        """
        dumped = "write_dump all custom {} type x y z fx fy fz modify sort id format float %.17g\n"
        steps = [f"{command}\n{dumped.format(number)}" for number, command in enumerate(commands)]
        with TemporaryDirectory() as folder:
            for name, text in self.files.items():
                Path(folder, name).write_text(text, encoding="utf-8")
            Path(folder, "in.lammps").write_text(self.text.partition("\n# phase ")[0] + "\n" + "\n".join(steps))
            lmp(Path(folder))
            return [np.loadtxt(Path(folder, str(number)), skiprows=9) for number in range(len(commands))]

    @property
    def cutoff(self) -> float:
        """Of the interaction, in the plane of motion [LU]."""
        return self.claimed("cut at r = {} and")


def written(scene: Path | Mapping[str, Any]) -> Written:
    """The deck of a scene with its planned schedule."""
    with TemporaryDirectory() as folder:
        path = write_deck(scene, folder)
        return Written({file.name: file.read_text(encoding="utf-8") for file in path.iterdir()})
