"""LAMMPS's granular models by the decks beside this module, each a run that `lmp -in` repeats."""

import os
import shlex
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from validation.doors import load_lammps

DECKS = Path(__file__).parent / "decks"
QUANTITIES = ("restitution", "contact_time", "peak_force", "peak_overlap")
"""What impact.lmp measures, as in `validation.references.grains.Impact`."""
STEP, SLOW_STEP = 5e-5, 4e-5
"""Timesteps at velocity 1, and of adhesive spheres, which are slower; each run is made once more in half of it."""
INCREMENT = 4e-7
"""Of the overlap that is prescribed, in units of R*."""


class Found(NamedTuple):
    """A value, what half the timestep changed of it, and the command of its run."""

    value: float
    change: float
    run: str

    def over(self, unit: float) -> "Found":
        """The same in units of another quantity."""
        return Found(self.value / unit, abs(self.change / unit), self.run)


@cache
def _lammps() -> Any:
    os.environ.setdefault("UCX_TLS", "self,sm")
    return load_lammps()[0]


@contextmanager
def ran(deck: str, **variables: str | float) -> Iterator[Any]:
    """A LAMMPS that has run a deck with index variables in place of the deck's own."""
    words = [word for name, value in variables.items() for word in ("-var", name, str(value))]
    lammps = _lammps()(cmdargs=["-log", "none", "-screen", "none", "-nocite", *words])
    try:
        lammps.file(str(DECKS / f"{deck}.lmp"))
        yield lammps
    finally:
        lammps.close()


def measured(deck: str, names: Sequence[str], **variables: str | float) -> dict[str, Found]:
    """Variables at the end of a deck."""
    command = shlex.join([f"{deck}.lmp", *(f"{name}={value}" for name, value in variables.items())])
    with ran(deck, **variables) as lammps:
        return {name: Found(float(lammps.extract_variable(name)), 0.0, command) for name in names}


def refined(deck: str, names: Sequence[str], dt: float, **variables: str | float) -> dict[str, Found]:
    """The same in half the timestep, with what that changed."""
    coarse, fine = (measured(deck, names, dt=step, **variables) for step in (dt, 0.5 * dt))
    return {name: one._replace(change=abs(one.value - coarse[name].value)) for name, one in fine.items()}


def impact(model: str, v: float = 1.0, dt: float = STEP) -> dict[str, Found]:
    """An impact, by quantity; model: the words of `pair_coeff`."""
    return refined("impact", QUANTITIES, dt, model=model, v=v)


def force_at(overlap: float, deepest: float, model: str) -> Found:
    """Force of spheres that were pressed to the overlap `deepest` and are drawn apart to another one."""
    with ran("pulled", model=model, deepest=deepest, dt=INCREMENT) as lammps:
        step = 2 * round(deepest / INCREMENT) - round(overlap / INCREMENT)
        there, force = (lammps.extract_fix("curve", 0, 2, step, column) for column in (0, 1))
    if abs(there - overlap) > INCREMENT:
        raise ValueError(f"at step {step} the overlap is {there}, and should be {overlap}")
    return Found(float(force), 0.0, "")
