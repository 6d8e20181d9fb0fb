"""The units of a deck: those of the scene, or for very small and very large numbers units of its own.

LAMMPS has lengths and energies built in: the step of `hftn`'s differences, 2e-6, the longest move of a minimiser, 0.1,
bins and box. They do not suit a scene in metres, so a deck with very small or large lengths or forces is written in
units of powers of ten LU and FU:

    x = x_deck · length,  F = F_deck · force,  t = t_deck · √(MU · length/force);   1, 1 for ordinary scenes

The output of the deck (curve.txt, states.lammpstrj) is in LU and FU in any case.
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


@dataclass(frozen=True)
class DeckUnits:
    """A deck's unit of length [LU] and of force [FU]; that of mass is MU."""

    length: float
    force: float

    @property
    def are_rescaled(self) -> bool:
        """Whether the units of the deck differ from those of the scene."""
        return (self.length, self.force) != (1.0, 1.0)

    def of(self, unit: str) -> float:
        """Return the size of one deck unit of this kind, "FU·TU/LU" for instance, in units of the scene (a factor).

        Raises:
            KeyError: there is no such unit of the model.
        """
        return _factor(self.length, self.force, unit)

    def to_deck(self, value: float, unit: str) -> float:
        """Return a number of the scene, whose unit there is `unit`, in deck units; unchanged if nothing is rescaled.

        KeyError for an unknown unit where the deck is rescaled.
        """
        return value / self.of(unit) if self.are_rescaled else value

    def from_deck(self, value: Value, unit: str) -> Value:
        """Return a number of the deck, or an array of such, in the scene's `unit`; unchanged if nothing is rescaled.

        KeyError for an unknown unit where the deck is rescaled.
        """
        return value * self.of(unit) if self.are_rescaled else value

    def scene(self, scene: Scene) -> Scene:
        """Return a new scene with its numbers in deck units, without [material] and uncertainties (±).

        It has the normal and tangential stiffness of a spring as numbers. The scene itself where the units are its own.
        """
        if not self.are_rescaled:
            return scene
        given = {"bulk_stiffness": scene.bulk_stiffness, "bulk_stiffness_tangential": scene.tangential_stiffness}
        bodies = scene.bodies.model_copy(update=given)
        data = plain_data(scene.model_copy(update={"bodies": bodies, "material": None}))
        for place in places(Scene, data):
            if place.is_number and not place.absent:
                place.put(self.to_deck(place.value, place.unit.name))
        return Scene.model_validate(data)

    def settings(self, settings: Settings) -> Settings:
        """Return new settings in deck units, except for `law`, the contact law, which keeps those of the scene.

        The settings themselves where the units are those of the scene.
        """
        if not self.are_rescaled:
            return settings
        converted: Settings = self._converted(settings)
        if (table := settings.forces.table) is None:
            return converted
        table = LawTable(self._law(table.law), converted.forces.cutoff, table.points)
        return replace(converted, forces=replace(converted.forces, table=table))

    def _converted(self, record: Any) -> Any:
        """Return a copy of a record of settings with each field that has a unit in deck units, also in records in it.

        The unit is `metadata["unit"]` of the field; fields without one remain as they are.
        """
        changed: dict[str, Any] = {}
        for field in fields(record):
            value = getattr(record, field.name)
            if unit := field.metadata.get("unit"):
                changed[field.name] = self.to_deck(value, unit)
            elif isinstance(value, Forces | Chains | Increments | Motion):
                changed[field.name] = self._converted(value)
            elif field.name == "drive":
                changed[field.name] = tuple(self._converted(leg) for leg in value)
        return replace(record, **changed)

    def _law(self, law: DoubleExponential) -> DoubleExponential:
        """Return a new interaction, amplitudes and ranges in deck units; without attraction where it has none."""
        terms = [
            None if term is None else Exponential(self.to_deck(term.amplitude, "FU·LU"), self.to_deck(term.range, "LU"))
            for term in (law.repulsion, law.attraction)
        ]
        assert terms[0] is not None
        return DoubleExponential(terms[0], terms[1])


@cache
def _factor(length: float, force: float, unit: str) -> float:
    """Return one deck unit of the kind `unit` in units of the scene; cached for the numbers of all load steps.

    `length` and `force`: one deck unit of these [LU], [FU].

    Raises:
        KeyError: there is no such unit of the model.
    """
    return float(length ** SI[unit].length * force ** SI[unit].force)


def units_for(scene: Scene) -> DeckUnits:
    """Return the units of a deck: the scene's own where these suit LAMMPS, else powers of ten.

    Length: where the spacing, or with an interaction the range of its repulsion, is not 0.01 to 100 LU, the next
    lower power of ten, with an interaction ten times that. Force: where the stiffness of a particle's bulk spring times
    one unit of length is not 1e-4 to 1e4 FU, the nearest power of ten. Else each is 1.
    """
    terms = scene.interaction
    shortest = scene.bodies.spacing if terms is None else terms.repulsion.range
    length = force = 1.0
    # At the lower end the force's derivative by hftn's steps of 2e-6 is within 1e-4 of the true one.
    if not 1e-2 <= shortest <= 1e2:
        # The ranges of ordinary scenes are tenths of a LU, and so is that of a repulsion; a spacing becomes a few LU.
        length = 10.0 ** (math.floor(math.log10(shortest)) + (terms is not None))
    largest = scene.bulk_stiffness * length
    if not 1e-4 <= largest <= 1e4:
        force = 10.0 ** round(math.log10(largest))
    return DeckUnits(length, force)
