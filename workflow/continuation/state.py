"""A measured state of a contact, and its contact radius."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius
from contact1d.workflow.laws import law_of
from contact1d.workflow.laws.radius import RadiusRule
from contact1d.workflow.model.calibration import CALIBRATION
from contact1d.workflow.scene import Scene


def radius_rule(scene: Scene, tolerance: float) -> RadiusRule:
    """Return the rule for the contact radius of a scene; `tolerance` limits the residual of a pressure."""
    return law_of(scene).rule(scene)(scene.bodies, CALIBRATION.residual * tolerance)


@dataclass(frozen=True)
class State:
    """One state of a contact, measured in LAMMPS or made by the reduced model.

    Attributes:
        phase: name of its phase.
        displacement: [LU].
        force: of the contact on the plate, compression positive [FU]: the sum over the upper particles.
        profile: pressure and shear along x.
        rule: what the contact radius is.
        smallest_distance: between particles of opposite bodies, or of a particle from the plane [LU].
        depth: how far an upper particle lies below the lower surface [LU]; 0 where none does.
        residual: largest unbalanced force of a particle along a direction in which it may move [FU].
        plate_x: position of the plate along x [LU], relative to that in system.data.
        step: LAMMPS timestep.
        pushed: force of other effects that presses the upper body onto the lower one [FU].
        plate_velocity: [LU/TU], 0 where the plate's position is prescribed.
        cantilever_force: [FU].
        missing: force that LAMMPS adds up on the plate beyond those that are known [FU]; None: not available.
        time: of a history [TU].
        motion: of a slide, the quantities of `contact.MOTION` and `contact.HEAT`.
        number: of its load step, over all phases.
    """

    phase: str
    displacement: float
    force: float
    profile: Profile
    rule: RadiusRule = field(repr=False, compare=False)
    smallest_distance: float
    depth: float
    residual: float
    plate_x: float
    step: float
    pushed: float = 0.0
    plate_velocity: float = 0.0
    cantilever_force: float = 0.0
    missing: float | None = None
    time: float = 0.0
    motion: Mapping[str, float] = field(default_factory=dict, compare=False)
    number: int = field(default=0, compare=False)

    @property
    def carried(self) -> float:
        """The load in equilibrium with the state [FU]: the contact force and other forces on the body."""
        return self.force - self.pushed

    @cached_property
    def radius(self) -> ContactRadius | None:
        """The contact radius; None where the bodies do not touch."""
        return self.rule.of(self.profile)

    @property
    def radius_or_spot(self) -> ContactRadius:
        """The contact radius; 0 where no particle is in tension."""
        return self.radius or self.rule.or_spot(self.profile)
