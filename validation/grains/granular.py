"""LAMMPS's granular models by the decks beside this module, each a run that `lmp -in` repeats."""

import os
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
    """A value in the finer of two runs, and what half the timestep changed of it."""

    value: float
    change: float


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


def variables_of(deck: str, names: Sequence[str], **variables: str | float) -> dict[str, float]:
    """Variables at the end of a deck."""
    with ran(deck, **variables) as lammps:
        return {name: float(lammps.extract_variable(name)) for name in names}


def impact(model: str, v: float = 1.0, dt: float = STEP) -> dict[str, Found]:
    """An impact, by quantity; model: the words of `pair_coeff`."""
    coarse, fine = (variables_of("impact", QUANTITIES, model=model, v=v, dt=step) for step in (dt, 0.5 * dt))
    return {name: Found(fine[name], abs(fine[name] - coarse[name])) for name in QUANTITIES}


def force_at(overlap: float, deepest: float, model: str) -> float:
    """Force of spheres that were pressed to the overlap `deepest` and are drawn apart to another one."""
    with ran("pulled", model=model, deepest=deepest, increment=INCREMENT) as lammps:
        step = 2 * round(deepest / INCREMENT) - round(overlap / INCREMENT)
        there, force = (lammps.extract_fix("curve", 0, 2, step, column) for column in (0, 1))
    if abs(there - overlap) > INCREMENT:
        raise ValueError(f"at step {step} the overlap is {there}, and should be {overlap}")
    return float(force)
