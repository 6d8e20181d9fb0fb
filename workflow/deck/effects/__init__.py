"""Effects: each is a scene table, a fragment of LAMMPS text, a row of the cost table; an absent one adds nothing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum
from importlib import import_module

from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import EFFECTS as NAMES
from contact1d.workflow.scene import Scene

LEAST_SLENDERNESS = 0.02
"""Least edge of the box over that of a bin: LAMMPS wants no bin above 100 times the box."""
MOST_BINS_ACROSS = 100
"""Bins of LAMMPS's neighbour search across a box that atoms without pair forces make wide: each bin takes memory."""


class Stage(IntEnum):
    """Order of the fragments in a deck: a force precedes the fixes that modify or integrate it."""

    BODIES = 0
    SPRINGS = 1
    CONTACT = 2
    """what the opposite body does to particles"""
    MEASURED = 3
    DRAG = 4
    GUIDE = 5
    PULL = 6
    PLATE = 7
    MOTION = 8


@dataclass(frozen=True)
class Contribution:
    """The part of one effect in a deck.

    Attributes:
        name: the effect, the scene's table.
        stage: order of its fragments among those of all parts.
        fragments: names in `lammps_inputs/fragments`, in order.
        variables: LAMMPS variables that the fragments need, name to value.
        pair_style: its part of the shared slot `pair_style`, or "".
        atom_style: its part of the shared slot `atom_style`, where atoms have more than bonds, or "".
        springs: names of the fragments of its springs, behind `fragments`; and in every measurement without springs.
        step_begin, step_end: names of fragments before and after every measurement.
        integrates: the atom group whose motion its fragment integrates, or "": a group has one integrator at most.
        pushes: the LAMMPS variable of a force [FU] other than contact and load that presses the upper body onto the
            lower one, or "".
    """

    name: str
    stage: Stage
    fragments: tuple[str, ...]
    variables: dict[str, str] = field(default_factory=dict)
    pair_style: str = ""
    atom_style: str = ""
    springs: tuple[str, ...] = ()
    step_begin: tuple[str, ...] = ()
    step_end: tuple[str, ...] = ()
    integrates: str = ""
    pushes: str = ""


def number(value: float) -> str:
    """Return a number as LAMMPS text that reads back to the same double: "0.1", "1e-09"; a whole one as "2.0"."""
    return repr(float(value))


def sphere_radius(scene: Scene, settings: Settings) -> float:
    """Return the radius [LU] of particles that are spheres, which friction needs; 0 where they are points.

    It is four times the larger one of the largest displacement and the spacing of the lower body.
    """
    deepest = max(settings.largest_displacement, scene.bodies.spacing)
    return 4.0 * deepest if scene.friction else 0.0  # a wall loses a sphere that overlaps it further


def skin(scene: Scene) -> float:
    """Return the skin of LAMMPS's neighbour lists [LU], half a spacing of the lower body.

    A load step of a path moves a body by less, so that a list lasts for a relaxation.
    """
    return 0.5 * scene.bodies.spacing


def first_upper_anchor(scene: Scene, settings: Settings) -> int:
    """Return the atom ID, counted from 1, of the first upper anchor.

    It comes after the particles of both bodies and the lower anchors; a rigid chain has no anchors, a rigid plane no
    atoms. Where particles are fixed in the upper body there is no atom of this ID.
    """
    below = {"particles": 2, "rigid_chain": 1, "rigid_plane": 0}[scene.bodies.lower]
    return settings.chains.upper + below * settings.chains.lower + 1


EFFECTS: dict[str, Callable[[Scene, Settings], Contribution]] = {
    name: getattr(import_module(f"{__name__}.{name}"), name) for name in NAMES
}
"""The function of each effect, in the module of the same name, which imports what is defined above."""


def contributions(scene: Scene, settings: Settings) -> tuple[Contribution, ...]:
    """Return the deck parts (fragments, variables) of all effects of a scene, in their order; () without effects.

    Numbers are in the units of `scene` and `settings`.
    """
    return tuple(EFFECTS[name](scene, settings) for name in scene.effects)
