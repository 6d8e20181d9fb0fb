"""The units of a deck: those of the scene, or for very small and very large numbers units of its own.

LAMMPS has lengths and energies built in: the step of `hftn`'s differences, 2e-6, the longest move of a minimiser, 0.1,
bins and box. With the lengths of a scene in metres they are far off, so a deck whose lengths or forces are, is written
in units of powers of ten LU and FU:

    x = x_deck · length,  F = F_deck · force,  t = t_deck · √(MU · length/force);   1, 1 for ordinary scenes

What the deck prints and writes (curve.txt, states.lammpstrj) is in LU and FU in any case.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from functools import cache
from typing import TYPE_CHECKING, Any, TypeVar

from contact1d.potentials import DoubleExponential, Exponential
from contact1d.potentials.table import Table as LawTable
from contact1d.workflow.model.dynamics import Motion
from contact1d.workflow.model.forces import Chains, Forces, Increments
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene
from contact1d.workflow.scene.quantities import places
from contact1d.workflow.scene.read import plain_data
from contact1d.workflow.units import SI

if TYPE_CHECKING:
    from numpy.typing import NDArray

Value = TypeVar("Value", float, "NDArray[Any]")

ORDINARY_LENGTHS = (1e-2, 1e2)
"""Range of the repulsion, or the spacing on a plane, for which LAMMPS's own lengths do [LU]: the force's derivative by
steps of 2e-6 is within 1e-4 of the true one at the lower end."""
ORDINARY_FORCES = (1e-4, 1e4)
"""Bulk stiffness times the unit of length [FU]."""


@dataclass(frozen=True)
class DeckUnits:
    """A deck's unit of length [LU] and of force [FU]; that of mass is MU."""

    length: float
    force: float

    @property
    def are_own(self) -> bool:
        """Whether they are other than the scene's."""
        return (self.length, self.force) != (1.0, 1.0)

    def of(self, unit: str) -> float:
        """One deck unit of this kind, "FU·TU/LU" for instance, in the scene's."""
        return _factor(self.length, self.force, unit)

    def to_deck(self, value: float, unit: str) -> float:
        """A number of the scene in deck units; the same where they are the scene's."""
        return value / self.of(unit) if self.are_own else value

    def from_deck(self, value: Value, unit: str) -> Value:
        """A number of the deck, or an array of such, in the scene's units."""
        return value * self.of(unit) if self.are_own else value

    def scene(self, scene: Scene) -> Scene:
        """The scene with its numbers in deck units, and with the values that follow from a material."""
        if not self.are_own:
            return scene
        given = {"bulk_stiffness": scene.bulk_stiffness, "bulk_stiffness_tangential": scene.tangential_stiffness}
        bodies = scene.bodies.model_copy(update=given)
        data = plain_data(scene.model_copy(update={"bodies": bodies, "material": None}))
        for place in places(Scene, data):
            if place.is_number and not place.absent:
                place.put(self.to_deck(place.value, place.unit.name))
        return Scene.model_validate(data)

    def settings(self, settings: Settings) -> Settings:
        """The settings in deck units, but for the predictor, which no deck asks."""
        if not self.are_own:
            return settings
        found: Settings = self._converted(settings)
        if (own := settings.forces.table) is None:
            return found
        table = LawTable(self._law(own.law), found.forces.cutoff, own.points)
        return replace(found, forces=replace(found.forces, table=table))

    def _converted(self, record: Any) -> Any:
        """A record in deck units, and those in it: the fields whose `metadata` has a unit."""
        changed: dict[str, Any] = {}
        for one in fields(record):
            value = getattr(record, one.name)
            if unit := one.metadata.get("unit"):
                changed[one.name] = self.to_deck(value, unit)
            elif isinstance(value, Forces | Chains | Increments | Motion):
                changed[one.name] = self._converted(value)
            elif one.name == "drive":
                changed[one.name] = tuple(self._converted(leg) for leg in value)
        return replace(record, **changed)

    def _law(self, law: DoubleExponential) -> DoubleExponential:
        terms = [
            None if term is None else Exponential(self.to_deck(term.amplitude, "FU·LU"), self.to_deck(term.range, "LU"))
            for term in (law.repulsion, law.attraction)
        ]
        assert terms[0] is not None
        return DoubleExponential(terms[0], terms[1])


@cache
def _factor(length: float, force: float, unit: str) -> float:
    """One unit made of these, kept: every number of every load step asks for it."""
    return float(length ** SI[unit].length * force ** SI[unit].force)


def units_for(scene: Scene) -> DeckUnits:
    """The scene's own units where they suit LAMMPS; else powers of ten that give numbers near 1."""
    terms = scene.interaction
    lengths = scene.bodies.spacing if terms is None else terms.repulsion.range
    # The ranges of ordinary scenes are tenths of a LU, so a repulsion's is made one; a spacing is made a few LU.
    length = force = 1.0
    if not ORDINARY_LENGTHS[0] <= lengths <= ORDINARY_LENGTHS[1]:
        length = 10.0 ** (math.floor(math.log10(lengths)) + (terms is not None))
    stiffness = scene.bulk_stiffness * length
    if not ORDINARY_FORCES[0] <= stiffness <= ORDINARY_FORCES[1]:
        force = 10.0 ** round(math.log10(stiffness))
    return DeckUnits(length, force)
